#pragma once

namespace surfgrad::image {

/// How a tangent-space normal map becomes slopes.
struct SlopeCode {
  bool two_channels = false; ///< z is reconstructed
  bool green_up = true;      ///< false negates the second slope
};

/// A row of a normal map and where its slopes go.
struct SlopeRow {
  const float* texels = nullptr; ///< code values: 0..1 mean -1..1
  int width = 0;
  int channels = 3; ///< 2 to 4
  SlopeCode code{};
  bool may_be_infinite = false; ///< or no number, as texels of float files
  float* slopes = nullptr;      ///< two floats a texel
};

/// Computes the slopes in double and rounds them once, the same on every instruction set. Texels that are not
/// finite are flat.
///
/// returns  how many texels point inward (z <= 0), those that are not finite among them; 0 for two channels
int slope_row(const SlopeRow& row);

} // namespace surfgrad::image
