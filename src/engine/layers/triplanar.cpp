#include "engine/layers/triplanar.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {
namespace {

BumpMap plane(const stack::TriplanarMap& use, const stack::FileName& file, const Compiler& compiler) {
  switch (use.content) {
  case stack::TriplanarContent::object_normal:
    return {compiler.tiled(use, compiler.maps().directions(file, use.green))};
  case stack::TriplanarContent::derivative:
    return compiler.bump_map(use, stack::Content::derivative, file);
  case stack::TriplanarContent::height:
    return compiler.bump_map(use, stack::Content::height, file);
  case stack::TriplanarContent::normal:
    break;
  }
  return compiler.bump_map(use, stack::Content::normal, file);
}

} // namespace

Triplanar compiled(const stack::TriplanarLayer& layer, const Compiler& compiler) {
  // One map serves all planes.
  const stack::FileName& x = layer.files.front();
  const stack::FileName& y = layer.files.size() == 3 ? layer.files[1] : x;
  const stack::FileName& z = layer.files.size() == 3 ? layer.files[2] : x;
  return {compiler.influence(layer.common),
          {plane(layer.map, x, compiler), plane(layer.map, y, compiler), plane(layer.map, z, compiler)},
          layer.map.content == stack::TriplanarContent::object_normal,
          layer.sharpness,
          layer.space == stack::Space::world,
          {layer.convention.handedness, layer.convention.origin, layer.convention.planes}};
}

} // namespace surfgrad::engine
