#pragma once

#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "console.hpp"

#include <nlohmann/json.hpp>

namespace surfgrad::cli {

// What `surfgrad bake` says of a map that is done.

void warn_about(const bake::Counts& baked, const bake::Options& job, Console& console);
[[nodiscard]] nlohmann::json summary_of(const bake::Counts& baked, const bake::Options& job);

void say_verified(const bake::Verification& verified, const bake::Options& job, Console& console);
[[nodiscard]] nlohmann::json summary_of(const bake::Verification& verified, const bake::Options& job);

} // namespace surfgrad::cli
