#include "maps/over_mesh.hpp"

#include "bake/bake.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <utility>

namespace surfgrad::maps {
namespace {

template <class L>
stack::Layer layer_of(const OverMesh& job, const std::filesystem::path& file) {
  L layer;
  layer.common.key = file.string();
  layer.map.file.path = file;
  layer.map.uv = job.uv_set;
  layer.map.green = job.green_from;
  // Texel by texel: nothing is to be filtered at the texels' own centres.
  layer.map.filter = stack::Filter::bilinear;
  return layer;
}

} // namespace

image::Image in_other_space(const image::Image& map, const OverMesh& job, const std::filesystem::path& file,
                            const Report& report) {
  scene::Scene scene = scene::load_scene(job.model, report);
  scene.images.clear();
  scene.images[file] = std::make_shared<image::Image>(map);
  for (scene::Material& material : scene.materials)
    material.layers = {job.to_object ? layer_of<stack::NormalMapLayer>(job, file)
                                     : layer_of<stack::ObjectNormalMapLayer>(job, file)};
  const bake::Options options{.width = map.width,
                              .height = map.height,
                              .space = job.to_object ? bake::Space::object : bake::Space::tangent,
                              .uv_set = job.uv_set,
                              .padding = job.padding,
                              .green = job.green_to,
                              .depth = job.depth,
                              .dither = job.dither};
  return std::move(bake::bake(std::move(scene), options, report).map);
}

} // namespace surfgrad::maps
