#pragma once

#include "image/image.hpp"

namespace surfgrad::image {

/// How a row of a tangent-space normal map becomes slopes.
struct SlopeCode {
  bool two_channels = false; ///< z is reconstructed
  bool green_up = true;      ///< false negates the second slope
};

/// Slopes of a row of a normal map (code values 0..1 mean -1..1), two floats a texel. They are computed in
/// double and rounded once. Texels that are not finite are flat.
///
/// returns  how many texels point inward (z <= 0), those that are not finite among them; 0 for two channels
int slope_row(const Image& image, int y, SlopeCode code, float* slopes);

} // namespace surfgrad::image
