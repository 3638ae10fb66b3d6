#pragma once

#include "bake/roughness.hpp"
#include "console.hpp"
#include "maps/form.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace surfgrad::cli {

// What the verbs that work on maps have in common.

void add_green_option(CLI::App& verb, const std::string& name, stack::Green& green, const std::string& what);
void add_channels_option(CLI::App& verb, const std::string& name, maps::Channels& channels,
                         const std::string& what);
/// --range and --neutral behind a prefix: "--" or "--from-".
void add_derivative_options(CLI::App& verb, const std::string& prefix, maps::Form& form);

/// A number within [0, 1], else a map.
[[nodiscard]] bake::BaseRoughness base_roughness_of(const std::string& text);

/// Refuses to write over one of the maps that are read.
void refuse_to_replace(const std::vector<std::string>& maps, const std::filesystem::path& output);

/// --dither; `when` says when it is on unless told.
void add_dither_option(CLI::App& verb, std::optional<bool>& dither, const std::string& when);

/// What is said of a job for each of several maps.
struct Telling {
  std::string doing; ///< "converting"
  bool quiet = false;
  bool json = false;
};

/// Runs the job of each map, which returns its summary for machines, with a bar of how many are done. What
/// fails is told at the end; for machines so is one line, of an object for one map and of a list `maps` for
/// several.
void for_each_map(const std::vector<std::string>& maps, const Telling& telling,
                  const std::function<nlohmann::json(const std::string& map, Console& console)>& job);

} // namespace surfgrad::cli
