#include "gpu/stack_maps.hpp"

namespace surfgrad::gpu {
namespace {

using shadergen::MapKind;
using shadergen::TextureBinding;

/// What is one map.
std::shared_ptr<const image::Map> map_of(const TextureBinding& t, engine::MapLibrary& library) {
  const stack::FileName& file = t.files.front();
  switch (t.kind) {
  case MapKind::slopes:
    return library.slopes(file, t.channels, t.green);
  case MapKind::normals:
    return library.slopes(file, t.channels, t.green, stack::Filter::normal);
  case MapKind::derivatives:
    return library.derivatives(file, t.code, t.green);
  case MapKind::heights:
    return library.heights(file, t.channel);
  case MapKind::height_slopes:
    return library.height_slopes(file, t.channel, {engine::wrap_of(t.wrap_s), engine::wrap_of(t.wrap_t)});
  case MapKind::directions:
    return library.directions(file, t.green);
  case MapKind::weights:
    return library.weights(file, t.channel);
  case MapKind::cube: {
    const auto cube = library.cube(t.files);
    return {cube, &cube->map};
  }
  case MapKind::relief:
    break;
  }
  return nullptr;
}

} // namespace

StackMaps::StackMaps(const shadergen::Shader& shader, engine::MapLibrary& library) {
  for (const TextureBinding& t : shader.textures) {
    const std::string file = t.files.front().path.string();
    if (t.kind == MapKind::relief) {
      const auto field = library.relief(t.files.front(), t.channel);
      maps_.push_back({&field->from_above.map, &field->from_above, file});
      maps_.push_back({&field->from_below.map, &field->from_below, file});
      owners_.push_back(field);
      continue;
    }
    const auto map = map_of(t, library);
    maps_.push_back({map.get(), nullptr, file});
    owners_.push_back(map);
  }
}

} // namespace surfgrad::gpu
