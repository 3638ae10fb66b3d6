#pragma once

#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// A map of heights.
struct HeightMapLayer {
  static constexpr std::string_view type = "height_map";
  LayerCommon common{};
  Texture map{};
  MaskChannel channel = MaskChannel::r;
  HeightMode mode = HeightMode::physical;
  double height = 1;            ///< of the value 1: in `units`, or in widths of the map where scale-free
  Units units = Units::scene;   ///< physical
  Taps taps = Taps::three;      ///< physical; scale-free heights know only `bicubic`
  std::optional<Basis> basis{}; ///< scale-free; absent: derived

  static const Fields<HeightMapLayer>& fields();
};

} // namespace surfgrad::stack
