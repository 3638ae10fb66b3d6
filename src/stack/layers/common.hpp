#pragma once

#include "stack/map.hpp"

#include <optional>

namespace surfgrad::stack {

/// How strongly a layer acts.
struct LayerWeight {
  int line = 0;      ///< where the layer's object begins
  std::string key{}; ///< e.g. `layers[2]`, `materials.skin[0]`
  double scale = 1;  ///< of the surface gradient; any sign
  std::optional<Mask> mask{};
  double opacity = 1; ///< 0 to 1; multiplies the mask

  static const Fields<LayerWeight>& fields();
};

/// What every layer has but `resolve`, and decals, whose blend offers more.
struct LayerCommon : LayerWeight {
  Blend blend = Blend::add;

  static const Fields<LayerCommon>& fields();
};

} // namespace surfgrad::stack
