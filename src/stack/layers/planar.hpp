#pragma once

#include "stack/bump_map.hpp"
#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// An image of bumps projected along one axis.
struct PlanarLayer {
  static constexpr std::string_view type = "planar";
  LayerCommon common{};
  FileName file{};
  PlaneAxis axis = PlaneAxis::x;
  Space space = Space::object;
  BumpMap map{};

  static const Fields<PlanarLayer>& fields();
};

} // namespace surfgrad::stack
