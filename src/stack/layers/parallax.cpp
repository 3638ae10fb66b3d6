#include "stack/layers/parallax.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

/// A key that says nothing about this method is a slip.
void check(const ParallaxLayer& layer, const Value& value) {
  const Member* limit = value.find("limit_offset");
  if (limit != nullptr && layer.method != ParallaxMethod::offset)
    value.member(*limit).fail("does not apply to this method", R"(leave it out, or give "method": "offset")");
  if (layer.map.filter == Filter::nearest)
    value.member(*value.find("filter"))
        .fail("does not apply to heights that are seen from the side",
              "expected one of: bilinear, trilinear");
}

} // namespace

const Fields<ParallaxLayer>& ParallaxLayer::fields() {
  static const auto table =
      Fields<ParallaxLayer>()
          .type(type)
          .part(&ParallaxLayer::map)
          .word("channel", &ParallaxLayer::channel)
          .word("method", &ParallaxLayer::method)
          .number("height", &ParallaxLayer::height, {.least = 0, .excludes_least = true})
          .number("level", &ParallaxLayer::level, {.least = 0, .most = 1})
          .truth("limit_offset", &ParallaxLayer::limit_offset)
          .word("lod", &ParallaxLayer::lod)
          .word("normal", &ParallaxLayer::normal)
          .truth("curvature", &ParallaxLayer::curvature)
          .word("facing", &ParallaxLayer::facing)
          .truth("self_shadow", &ParallaxLayer::self_shadow)
          .part(&ParallaxLayer::common)
          .finally(check);
  return table;
}

} // namespace surfgrad::stack
