#include "gallery/models.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <system_error>

namespace fs = std::filesystem;

namespace surfgrad::gallery {
namespace {

std::vector<fs::path> models_below(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError({.file = folder, .problem = "is not a folder", .remedy = "give a folder of models"});
  std::vector<fs::path> models;
  const auto skipping = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, skipping, error), end; !error && at != end;
       at.increment(error)) {
    const std::string extension = io::lower_extension(at->path());
    if (extension == ".gltf" || extension == ".glb" || extension == ".obj") models.push_back(at->path());
  }
  if (error)
    throw InputError({.file = folder,
                      .problem = "cannot be searched: " + error.message(),
                      .remedy = "check the permissions of what lies in it"});
  std::sort(models.begin(), models.end());
  return models;
}

/// A name of letters, digits and hyphens that is not taken yet.
std::string id_of(const fs::path& model, std::set<std::string>& taken) {
  std::string id;
  for (const char c : model.stem().string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    const bool capital = c >= 'A' && c <= 'Z';
    id += plain ? c : capital ? static_cast<char>(c - 'A' + 'a') : '-';
  }
  std::string unique = id;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = id + "-" + std::to_string(i);
  return unique;
}

bool has_layers(const scene::Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const scene::Material& material) { return !material.layers.empty(); });
}

} // namespace

Figure model_figure(const fs::path& folder, const Report& report) {
  Figure figure{
      "models",
      "Models",
      "Every model of the given folder that brings normal maps, with them and without. A model's own "
      "tangents, texture coordinates and texture transforms are used as its file says.",
      {}};
  std::set<std::string> taken;
  for (const fs::path& file : models_below(folder)) {
    std::shared_ptr<const scene::Scene> scene;
    try {
      scene = std::make_shared<const scene::Scene>(scene::load_scene(file, report.at_the_start()));
    } catch (const InputError& error) {
      report.warn(std::string(error.what()) + " (left out of the gallery)");
      continue;
    }
    if (!has_layers(*scene)) continue;
    const std::string id = id_of(file, taken);
    const std::string name = file.filename().string();
    figure.panels.push_back({id, name, "With its normal maps.", Way::choice, "", [scene] { return *scene; }});
    figure.panels.push_back(
        {"without-" + id, name + ", bare", "The mesh without them.", Way::choice, "", [scene] {
           scene::Scene bare = *scene;
           for (scene::Material& material : bare.materials) material.layers.clear();
           return bare;
         }});
  }
  if (figure.panels.empty())
    throw InputError({.file = folder,
                      .problem = "holds no model with a normal map",
                      .remedy = "give a folder with .gltf, .glb or .obj files that name normal textures"});
  return figure;
}

} // namespace surfgrad::gallery
