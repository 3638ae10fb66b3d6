#include "stack/layers/planar.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<PlanarLayer>& PlanarLayer::fields() {
  static const auto table = Fields<PlanarLayer>()
                                .type(type)
                                .file("map", &PlanarLayer::file)
                                .required()
                                .word("axis", &PlanarLayer::axis)
                                .required()
                                .word("space", &PlanarLayer::space)
                                .part(&PlanarLayer::map)
                                .part(&PlanarLayer::common);
  return table;
}

} // namespace surfgrad::stack
