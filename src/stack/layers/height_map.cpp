#include "stack/layers/height_map.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

/// A key that says nothing about this mode is a slip.
void check_mode(const HeightMapLayer& layer, const Value& value) {
  const auto refuse = [&](std::string_view key, std::string_view remedy) {
    if (const Member* member = value.find(key))
      value.member(*member).fail("does not apply to this mode", std::string(remedy));
  };
  refuse_normal_filter(layer.map, value, "a map of heights");
  if (layer.mode == HeightMode::physical) {
    refuse("basis", R"(leave it out, or give "mode": "scale_free")");
    return;
  }
  refuse("units", R"(leave it out, or give "mode": "physical")");
  if (layer.taps != Taps::bicubic)
    refuse("taps", R"(leave it out, or give "mode": "physical" or "taps": "bicubic")");
}

} // namespace

const Fields<HeightMapLayer>& HeightMapLayer::fields() {
  static const auto table = Fields<HeightMapLayer>()
                                .type(type)
                                .part(&HeightMapLayer::map)
                                .word("channel", &HeightMapLayer::channel)
                                .word("mode", &HeightMapLayer::mode)
                                .number("height", &HeightMapLayer::height)
                                .word("units", &HeightMapLayer::units)
                                .word("taps", &HeightMapLayer::taps)
                                .word("basis", &HeightMapLayer::basis)
                                .part(&HeightMapLayer::common)
                                .finally(check_mode);
  return table;
}

} // namespace surfgrad::stack
