#include "stack/layers/common.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<LayerCommon>& LayerCommon::fields() {
  static const auto table = Fields<LayerCommon>()
                                .number("scale", &LayerCommon::scale)
                                .object("mask", &LayerCommon::mask)
                                .number("opacity", &LayerCommon::opacity, {.least = 0, .most = 1})
                                .word("blend", &LayerCommon::blend)
                                .finally([](LayerCommon& common, const Value& value) {
                                  common.line = value.node.line;
                                  common.key = value.key;
                                });
  return table;
}

} // namespace surfgrad::stack
