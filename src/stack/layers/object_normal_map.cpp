#include "stack/layers/object_normal_map.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<ObjectNormalMapLayer>& ObjectNormalMapLayer::fields() {
  static const auto table = Fields<ObjectNormalMapLayer>()
                                .type(type)
                                .part(&ObjectNormalMapLayer::map)
                                .word("space", &ObjectNormalMapLayer::space)
                                .part(&ObjectNormalMapLayer::common)
                                .finally([](ObjectNormalMapLayer& layer, const Value& value) {
                                  refuse_hex_tiling(layer.map, value);
                                });
  return table;
}

} // namespace surfgrad::stack
