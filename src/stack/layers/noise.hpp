#pragma once

#include "stack/layers/common.hpp"
#include "stack/noise_function.hpp"
#include "stack/volume_function.hpp"

namespace surfgrad::stack {

/// A function of space as a height over the surface.
struct NoiseLayer {
  static constexpr std::string_view type = "noise";
  LayerCommon common{};
  NoiseFunction noise{};
  Space space = Space::object;
  NoiseMethod method = NoiseMethod::surface_gradient;
  /// A program's own function in place of `noise`; no document can name one.
  std::optional<VolumeFunction> custom{};

  static const Fields<NoiseLayer>& fields();
};

} // namespace surfgrad::stack
