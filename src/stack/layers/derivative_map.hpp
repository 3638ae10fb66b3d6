#pragma once

#include "stack/bump_map.hpp"
#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// A map of slopes along s and t, two channels with a stated range: what a normal map becomes when it is
/// read, without the detour.
struct DerivativeMapLayer {
  static constexpr std::string_view type = "derivative_map";
  LayerCommon common{};
  Map map{};
  DerivativeCode code{};
  Basis basis = Basis::mikktspace;

  static const Fields<DerivativeMapLayer>& fields();
};

} // namespace surfgrad::stack
