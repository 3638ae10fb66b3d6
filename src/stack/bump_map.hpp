#pragma once

#include "stack/map.hpp"

namespace surfgrad::stack {

/// How the codes of a derivative map mean slopes.
struct DerivativeCode {
  double range = 1; ///< > 0: slope of the largest code
  NeutralCode neutral = NeutralCode::between;

  static const Fields<DerivativeCode>& fields();
};

/// How a projected image holds bumps, but for what its texels are, and how it is repeated over the plane
/// it is projected on. The files themselves belong to the layer: there may be several.
struct BumpCodes : Tiled {
  Channels channels = Channels::automatic;     ///< content normal
  Green green = Green::up;                     ///< contents of vectors
  DerivativeCode derivative{};                 ///< content derivative
  MaskChannel height_channel = MaskChannel::r; ///< content height
  double height = 1; ///< content height: displacement of a height of 1, in units of the space projected in

  static const Fields<BumpCodes>& fields();
};

/// A projected image of bumps.
struct BumpMap : BumpCodes {
  Content content = Content::normal;

  static const Fields<BumpMap>& fields();
};

/// Images projected along the three axes.
struct TriplanarMap : BumpCodes {
  TriplanarContent content = TriplanarContent::normal;

  static const Fields<TriplanarMap>& fields();
};

} // namespace surfgrad::stack
