#include "scene/scene.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "io/in_parallel.hpp"
#include "io/model_file.hpp"
#include "stack/uses.hpp"

#include <exception>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace surfgrad::scene {
namespace {

namespace fs = std::filesystem;

stack::Wrap wrap_of(image::Wrap mode) {
  switch (mode) {
  case image::Wrap::mirror:
    return stack::Wrap::mirror;
  case image::Wrap::clamp:
    return stack::Wrap::clamp;
  case image::Wrap::repeat:
    break;
  }
  return stack::Wrap::repeat;
}

/// A model's own normal texture as a layer.
stack::NormalMapLayer layer_of(const io::ModelMaterial& material) {
  const io::ModelTexture& texture = *material.normal;
  stack::NormalMapLayer layer;
  layer.common.key = "material \"" + material.name + "\"";
  layer.common.scale = texture.scale;
  layer.map.file = {texture.name, 0, layer.common.key};
  layer.map.uv = texture.uv_set;
  layer.map.tile = texture.tile;
  layer.map.rotate_deg = texture.rotate_rad * 180.0 / std::numbers::pi;
  layer.map.offset = texture.offset;
  layer.map.wrap = wrap_of(texture.wrap_s);
  layer.map.wrap_t = wrap_of(texture.wrap_t);
  return layer;
}

/// Runs read(); an InputError also says which line of the document named the file.
template <class Read>
auto named_by(const fs::path& document, const stack::FileName& name, const Read& read) {
  try {
    return read();
  } catch (const io::TooManyWeights&) {
    throw; // the mistake is elsewhere in the document
  } catch (const InputError& error) {
    if (document.empty()) throw;
    Fault fault = error.fault();
    fault.place = "(named by " + document.filename().string() + ":" + std::to_string(name.line) + ": " +
                  name.key + ")" + (fault.place.empty() ? "" : " " + fault.place);
    throw InputError(fault);
  }
}

fs::path beside(const fs::path& document, const fs::path& file) {
  return file.is_absolute() ? file : document.parent_path() / file;
}

/// All files that a document names but its mesh, in the order in which the scene asks for them.
std::vector<stack::FileName*> images_of(stack::Stack& document) {
  std::vector<stack::FileName*> names;
  const auto add_layers = [&](std::vector<stack::Layer>& layers) {
    for (stack::Layer& layer : layers)
      for (stack::FileName* name : stack::files_of(layer)) names.push_back(name);
  };
  if (document.has_layers) add_layers(document.layers);
  for (auto& [name, entry] : document.materials) add_layers(entry.layers);
  if (document.displace && document.displace->map) names.push_back(&document.displace->map->file);
  if (document.lights.environment) names.push_back(&*document.lights.environment);
  return names;
}

/// What the files of a document hold, each read once, as many at a time as there are threads. What
/// failed is thrown by whoever asks for it, as if it was read only then.
class Files {
 public:
  /// Resolves the names of the document's images against its folder and reads them and the model.
  Files(stack::Stack& document, const fs::path& model, const Report& report) : document_(&document) {
    std::vector<std::function<void()>> jobs;
    if (document.mesh)
      jobs.emplace_back([&] {
        model_.content = io::read_model(model, {.morph_weights = document.morph.weights, .report = report});
      });
    std::vector<std::exception_ptr*> errors;
    if (document.mesh) errors.push_back(&model_.error);
    for (stack::FileName* name : images_of(document)) {
      name->path = beside(document.file, name->path);
      const auto [at, is_new] = images_.try_emplace(name->path);
      if (!is_new) continue;
      jobs.emplace_back([&path = at->first, &image = at->second.content] {
        image = std::make_shared<image::Image>(io::read_image(path));
      });
      errors.push_back(&at->second.error);
    }
    const std::vector<std::exception_ptr> thrown = io::run_in_parallel(jobs, report);
    for (std::size_t i = 0; i < thrown.size(); ++i) *errors[i] = thrown[i];
  }

  /// Once.
  io::Model take_model() {
    return named_by(document_->file, *document_->mesh, [&] { return std::move(content_of(model_)); });
  }
  std::shared_ptr<const image::Image> image(const stack::FileName& name) {
    return named_by(document_->file, name, [&] { return content_of(images_.at(name.path)); });
  }

 private:
  template <class Content>
  struct Reading {
    Content content{};
    std::exception_ptr error{};
  };
  template <class Content>
  static Content& content_of(Reading<Content>& reading) {
    if (reading.error) std::rethrow_exception(reading.error);
    return reading.content;
  }

  stack::Stack* document_;
  Reading<io::Model> model_{};
  std::map<fs::path, Reading<std::shared_ptr<const image::Image>>> images_{};
};

void take_image(const stack::FileName& name, Files& files, Scene& scene) {
  scene.images.try_emplace(name.path, files.image(name));
}

void take_maps(std::vector<stack::Layer>& layers, Files& files, Scene& scene) {
  for (stack::Layer& layer : layers)
    for (const stack::FileName* name : stack::files_of(layer)) take_image(*name, files, scene);
}

/// The model with the document's morph weights.
io::Model take_model(const fs::path& model, const stack::Stack& document, Files& files) {
  try {
    return files.take_model();
  } catch (const io::TooManyWeights& error) {
    throw InputError({document.file, document.morph.line, "morph",
                      model.filename().string() + " " + error.fault().problem, error.fault().remedy});
  }
}

void refuse_weights_of_the_demo(const stack::Stack& document) {
  if (document.morph.weights.empty()) return;
  throw InputError({document.file, document.morph.line, "morph", "the built-in demo has no morph targets",
                    "give a \"mesh\" that has some"});
}

void place_model(io::Model model, Scene& scene) {
  scene.meshes = std::move(model.meshes);
  for (io::ModelObject& object : model.objects)
    scene.objects.push_back({std::move(object.name), object.mesh, object.world_from_object});
  for (const io::ModelMaterial& material : model.materials) {
    Material m;
    m.name = material.name;
    m.back_faces = material.double_sided ? stack::BackFaces::flip : stack::BackFaces::cull;
    if (material.normal) {
      m.layers.emplace_back(layer_of(material));
      scene.images[material.normal->name] = material.normal->image;
    }
    scene.materials.push_back(std::move(m));
  }
}

std::string names_of(const std::vector<Material>& materials) {
  std::string names;
  for (const Material& m : materials) names += (names.empty() ? "" : ", ") + m.name;
  return names;
}

void assign_layers(stack::Stack& document, Files& files, Scene& scene) {
  if (document.has_layers) {
    take_maps(document.layers, files, scene);
    for (Material& m : scene.materials) m.layers = document.layers;
  }
  for (auto& [name, entry] : document.materials) {
    take_maps(entry.layers, files, scene);
    bool known = false;
    for (Material& m : scene.materials) {
      if (m.name != name) continue;
      m.layers = entry.layers;
      known = true;
    }
    if (!known)
      throw InputError({document.file, entry.line, entry.key, "the mesh has no material of this name",
                        "its materials are: " + names_of(scene.materials)});
  }
  if (document.back_faces)
    for (Material& m : scene.materials) m.back_faces = *document.back_faces;
}

void check_uv(const stack::Texture& texture, const fs::path& source, const Object& object,
              const mesh::TriangleMesh& mesh, const std::string& key) {
  const std::size_t sets = mesh.uv_sets.size();
  if (static_cast<std::size_t>(texture.uv) < sets) return;
  const std::string has = sets == 0 ? "has no texture coordinates"
                                    : "has " + std::to_string(sets) + " UV set" + (sets == 1 ? "" : "s");
  throw InputError(
      {source, texture.uv_line, key,
       "asks for UV set " + std::to_string(texture.uv) + ", but mesh \"" + object.name + "\" " + has,
       sets == 0 ? "unwrap the mesh, or give this material no layer that reads a texture coordinate"
                 : "use a set from 0 to " + std::to_string(sets - 1)});
}

/// Every layer of every material in use finds its UV sets. Layers without a line are the model's own.
void check_uv_sets(const Scene& scene, const fs::path& document, const fs::path& model) {
  for (const Object& object : scene.objects) {
    const mesh::TriangleMesh& mesh = scene.meshes[object.mesh];
    if (scene.displace && scene.displace->map)
      check_uv(*scene.displace->map, document, object, mesh, "displace.map.uv");
    const std::set<std::uint32_t> used(mesh.material_of_triangle.begin(), mesh.material_of_triangle.end());
    for (const std::uint32_t material : used)
      for (const stack::Layer& layer : scene.materials[material].layers)
        for (const stack::TextureUse& use : stack::textures_of(layer))
          check_uv(*use.texture, use.texture->uv_line > 0 ? document : model, object, mesh, use.key + ".uv");
  }
}

Scene load_document(const fs::path& file, const Report& report) {
  const std::vector<std::byte> bytes = io::read_file(file);
  stack::Stack document =
      stack::parse_stack({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  Scene scene;
  scene.source = file;
  if (!document.mesh) refuse_weights_of_the_demo(document);
  const fs::path model = document.mesh ? beside(file, document.mesh->path) : fs::path();
  scene.model = model;
  scene.morph_weights = document.morph.weights;
  Files files(document, model, report);
  if (document.mesh) {
    place_model(take_model(model, document, files), scene);
  } else {
    Scene demo = demo_scene();
    scene.meshes = std::move(demo.meshes);
    scene.objects = std::move(demo.objects);
    scene.materials = std::move(demo.materials);
    scene.images = std::move(demo.images);
  }
  assign_layers(document, files, scene);
  scene.displace = std::move(document.displace);
  if (scene.displace && scene.displace->map) take_image(scene.displace->map->file, files, scene);
  scene.camera = document.camera;
  scene.lights = document.lights;
  if (scene.lights.environment) {
    take_image(*scene.lights.environment, files, scene);
    scene.environment = scene.images.at(scene.lights.environment->path);
  }
  check_uv_sets(scene, file, model);
  return scene;
}

} // namespace

Scene load_scene(const fs::path& file, const Report& report) {
  const std::string extension = io::lower_extension(file);
  const bool folder = fs::is_directory(file);
  if (folder || (extension != ".json" && extension != ".gltf" && extension != ".glb" && extension != ".obj"))
    throw InputError({.file = file,
                      .problem = folder              ? "is a folder"
                                 : extension.empty() ? "has no extension"
                                                     : "\"" + extension + "\" is not a scene's extension",
                      .remedy = "expected a stack document (.json) or a model (.gltf, .glb, .obj)"});
  if (extension == ".json") return load_document(file, report);
  Scene scene;
  scene.source = file;
  scene.model = file;
  place_model(io::read_model(file, {.morph_weights = {}, .report = report}), scene);
  check_uv_sets(scene, file, file);
  return scene;
}

} // namespace surfgrad::scene
