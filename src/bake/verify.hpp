#pragma once

#include "bake/bake.hpp"

namespace surfgrad::bake {

/// How far the normals that a map decodes to are from those composed.
struct Verification {
  std::int64_t compared = 0;
  std::int64_t left_out = 0; ///< no map in tangent space can hold them: Counts::singular, Counts::clamped
  double mean_deg = 0;
  double high_deg = 0; ///< of a thousand texels one is farther off, to 1/256 of it
  double most_deg = 0;
  int x = 0, y = 0; ///< the texel farthest off, from the lower left
};

/// Decodes a map as an engine does, normalize(x T + y B + z N) of the nearest texel and the interpolated
/// vertex frame as it is, at the centres of its covered texels, and compares with the stack composed there.
///
/// options  those it was baked with; the size is the map's
/// map      as read from its file: its depth says what its values are
/// Same result for any number of threads.
[[nodiscard]] Verification verify(const scene::Scene& scene, const Options& options, const image::Image& map,
                                  const Report& report = {});

} // namespace surfgrad::bake
