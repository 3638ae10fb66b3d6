#pragma once

#include "stack/bump_map.hpp"
#include "stack/layers/common.hpp"

#include <vector>

namespace surfgrad::stack {

/// Which components of a position each plane samples, and in which directions. The defaults show every
/// image the right way round in our right-handed spaces, seen against its axis.
struct Convention {
  static constexpr std::string_view format_name = "convention";
  Handedness handedness = Handedness::right;
  TextureOrigin origin = TextureOrigin::lower_left;
  TriplanarPlanes planes = TriplanarPlanes::mikkelsen;

  static const Fields<Convention>& fields();
};

/// Images of bumps projected along the three axes, blended by the base normal.
struct TriplanarLayer {
  static constexpr std::string_view type = "triplanar";
  LayerCommon common{};
  std::vector<FileName> files{}; ///< one for every plane, or those of the x-, y- and z-plane
  double sharpness = 3;          ///< > 0: exponent of the weights
  Space space = Space::object;
  Convention convention{};
  TriplanarMap map{};

  static const Fields<TriplanarLayer>& fields();
};

} // namespace surfgrad::stack
