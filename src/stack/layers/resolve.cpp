#include "stack/layers/resolve.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

const Fields<ResolveLayer>& ResolveLayer::fields() {
  static const auto table =
      Fields<ResolveLayer>().type(type).finally([](ResolveLayer& layer, const Value& value) {
        layer.line = value.node.line;
        layer.key = value.key;
      });
  return table;
}

} // namespace surfgrad::stack
