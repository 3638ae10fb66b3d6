#pragma once

#include "bake/bake.hpp"
#include "bake/roughness.hpp"
#include "image/image.hpp"
#include "io/image_file.hpp"
#include "output_names.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace surfgrad::cli {

/// What `bake --roughness`, `--anisotropy` and `--mips` write: the detail that a texel or a mip level cannot
/// show. Does nothing where none is asked for.
class LostDetailOutput {
 public:
  void add_options(CLI::App& verb);

  [[nodiscard]] bool is_wanted() const { return !roughness_.empty() || is_mips_wanted_; }

  /// Refuses names that do not tell the scenes apart.
  void check(const OutputNames& names, const std::vector<std::string>& scenes) const;
  /// The names become what they mean for one scene.
  void rename(const std::function<std::filesystem::path(const std::string&)>& file_for);

  /// Before long work. Throws CLI::ValidationError where the options contradict each other or the job's,
  /// InputError where a file cannot be written.
  void check(const bake::Options& job, const std::filesystem::path& map) const;
  /// Calls claim(option, file) for each file that will be written beside a map with this longer side.
  void
  claim(const std::filesystem::path& map, int side,
        const std::function<void(const std::string& option, const std::filesystem::path& file)>& claim) const;
  /// Once all is checked.
  void read_base();
  /// After the map was written; it names the files of its levels.
  void write(const scene::Scene& scene, const bake::Options& job, const std::filesystem::path& map,
             io::Compression compression, bool quiet);

  /// Of level 0; null where no roughness is asked for.
  [[nodiscard]] const image::Image* roughness() const { return written_ ? &*written_ : nullptr; }
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  std::filesystem::path roughness_{};
  std::filesystem::path anisotropy_{};
  std::string base_ = "0.5";
  bool is_mips_wanted_ = false;
  std::optional<bake::BaseRoughness> base_read_{};
  std::optional<image::Image> written_{};
  std::vector<std::filesystem::path> files_{}; ///< in the order in which they were written
};

} // namespace surfgrad::cli
