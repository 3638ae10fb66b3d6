#include "stack/layers/noise.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<NoiseLayer>& NoiseLayer::fields() {
  static const auto table = Fields<NoiseLayer>()
                                .type(type)
                                .part(&NoiseLayer::noise)
                                .word("space", &NoiseLayer::space)
                                .word("method", &NoiseLayer::method)
                                .part(&NoiseLayer::common);
  return table;
}

} // namespace surfgrad::stack
