#pragma once

#include "bake/bake.hpp"
#include "options.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace surfgrad::cli {

/// The options that say what a map holds and how: UV set, space, encoding, samples, padding.
class BakeJob {
 public:
  void add_options(CLI::App& verb);
  /// What they say together of a map of this size, which goes to a file. Throws CLI::ValidationError for
  /// those that contradict each other.
  [[nodiscard]] bake::Options options(Size size, image::Depth depth,
                                      const std::filesystem::path& output) const;

 private:
  void add_encoding_options(CLI::App& verb);

  bake::Options job_{};
  std::string padding_ = "16"; // mip levels down to a sixteenth stay within the island
  std::optional<double> range_;
  std::optional<stack::NeutralCode> neutral_;
  std::optional<bool> dither_;
};

} // namespace surfgrad::cli
