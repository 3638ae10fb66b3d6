#include "stack/layers/object_normal_map.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<ObjectNormalMapLayer>& ObjectNormalMapLayer::fields() {
  static const auto table =
      Fields<ObjectNormalMapLayer>()
          .type(type)
          .part(&ObjectNormalMapLayer::map)
          .word("space", &ObjectNormalMapLayer::space)
          .part(&ObjectNormalMapLayer::common)
          .finally([](ObjectNormalMapLayer& layer, const Value& value) {
            refuse_normal_filter(layer.map, value, "a map of whole normals, which are filtered as they are");
            refuse_hex_tiling(layer.map, value, "whole normals do not turn with the tiles of a map");
          });
  return table;
}

} // namespace surfgrad::stack
