#pragma once

#include "bake/bake.hpp"
#include "output_names.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace surfgrad::cli {

/// What `bake --gltf FILE` writes: the model with the map inside. Does nothing where it is not asked for.
class GltfOutput {
 public:
  void add_option(CLI::App& verb);

  [[nodiscard]] bool is_wanted() const { return !file_.empty(); }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// Refuses names that do not tell the scenes apart.
  void check(const OutputNames& names, const std::vector<std::string>& scenes) const;
  /// The names become what they mean for one scene.
  void rename(const std::function<std::filesystem::path(const std::string&)>& file_for);

  /// Before long work. Throws CLI::ValidationError where glTF cannot hold the map that is asked for, and as
  /// io::check_glb_output.
  void check(const bake::Options& job, const std::filesystem::path& map) const;
  /// What goes into the model.
  struct Maps {
    std::filesystem::path normal;    ///< written
    const image::Image* roughness{}; ///< null: materials keep theirs
  };
  /// After the map was written.
  void write(const scene::Scene& scene, const bake::Options& job, const bake::Counts& baked, const Maps& maps,
             bool quiet) const;

 private:
  std::filesystem::path file_{};
};

} // namespace surfgrad::cli
