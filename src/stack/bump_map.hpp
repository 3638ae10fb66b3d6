#pragma once

#include "stack/map.hpp"

namespace surfgrad::stack {

/// How the codes of a derivative map mean slopes.
struct DerivativeCode {
  double range = 1; ///< > 0: slope of the largest code
  NeutralCode neutral = NeutralCode::between;

  static const Fields<DerivativeCode>& fields();
};

/// How a projected image holds bumps, and how it is repeated over the plane it is projected on. The
/// files themselves belong to the layer: there may be several.
struct BumpMap : Tiled {
  Content content = Content::normal;
  Channels channels = Channels::automatic;     ///< content normal
  Green green = Green::up;                     ///< contents normal and derivative
  DerivativeCode derivative{};                 ///< content derivative
  MaskChannel height_channel = MaskChannel::r; ///< content height
  double height = 1; ///< content height: displacement of a height of 1, in units of the space projected in

  static const Fields<BumpMap>& fields();
};

} // namespace surfgrad::stack
