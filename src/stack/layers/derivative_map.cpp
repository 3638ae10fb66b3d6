#include "stack/layers/derivative_map.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<DerivativeMapLayer>& DerivativeMapLayer::fields() {
  static const auto table = Fields<DerivativeMapLayer>()
                                .type(type)
                                .part(&DerivativeMapLayer::map)
                                .part(&DerivativeMapLayer::code)
                                .word("basis", &DerivativeMapLayer::basis)
                                .part(&DerivativeMapLayer::common)
                                .finally([](DerivativeMapLayer& layer, const Value& value) {
                                  refuse_normal_filter(layer.map, value, "a map of slopes");
                                });
  return table;
}

} // namespace surfgrad::stack
