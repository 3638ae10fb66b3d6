#pragma once

#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// A tangent-space normal map.
struct NormalMapLayer {
  static constexpr std::string_view type = "normal_map";
  LayerCommon common{};
  TangentMap map{};
  Basis basis = Basis::mikktspace;

  static const Fields<NormalMapLayer>& fields();
};

} // namespace surfgrad::stack
