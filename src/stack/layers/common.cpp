#include "stack/layers/common.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<LayerWeight>& LayerWeight::fields() {
  static const auto table = Fields<LayerWeight>()
                                .number("scale", &LayerWeight::scale)
                                .object("mask", &LayerWeight::mask)
                                .number("opacity", &LayerWeight::opacity, {.least = 0, .most = 1})
                                .finally([](LayerWeight& common, const Value& value) {
                                  common.line = value.node.line;
                                  common.key = value.key;
                                });
  return table;
}

const Fields<LayerCommon>& LayerCommon::fields() {
  static const auto table = Fields<LayerCommon>().base<LayerWeight>().word("blend", &LayerCommon::blend);
  return table;
}

} // namespace surfgrad::stack
