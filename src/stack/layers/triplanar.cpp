#include "stack/layers/triplanar.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<Convention>& Convention::fields() {
  static const auto table = Fields<Convention>()
                                .word("handedness", &Convention::handedness)
                                .word("origin", &Convention::origin)
                                .word("planes", &Convention::planes);
  return table;
}

const Fields<TriplanarLayer>& TriplanarLayer::fields() {
  static const auto table =
      Fields<TriplanarLayer>()
          .type(type)
          .files("map", &TriplanarLayer::files, {3})
          .required()
          .number("sharpness", &TriplanarLayer::sharpness, {.least = 0, .excludes_least = true})
          .word("space", &TriplanarLayer::space)
          .object("convention", &TriplanarLayer::convention)
          .part(&TriplanarLayer::map)
          .part(&TriplanarLayer::common);
  return table;
}

} // namespace surfgrad::stack
