#include "stack/layers/parallax.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

/// What says nothing here is a slip.
void check(const ParallaxLayer& layer, const Value& value) {
  if (layer.limit_offset && layer.method != ParallaxMethod::offset)
    value.member(*value.find("limit_offset"))
        .fail("does not apply to this method", R"(leave it out, or give "method": "offset")");
  if (layer.map.filter != Filter::bilinear && layer.map.filter != Filter::trilinear)
    value.member(*value.find("filter"))
        .fail("does not apply to heights that are seen from the side",
              "expected one of: bilinear, trilinear");
  refuse_hex_tiling(layer.map, value, "rays march through the map as it lies");
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
