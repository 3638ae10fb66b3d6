#include "stack/layers/normal_map.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<NormalMapLayer>& NormalMapLayer::fields() {
  static const auto table = Fields<NormalMapLayer>()
                                .type(type)
                                .part(&NormalMapLayer::map)
                                .word("basis", &NormalMapLayer::basis)
                                .part(&NormalMapLayer::common);
  return table;
}

} // namespace surfgrad::stack
