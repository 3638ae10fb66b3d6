#pragma once

#include "bake/bake.hpp"

namespace surfgrad::bake {

/// How far the normals that a map decodes to are from those composed, over the pixels of a picture.
struct Deviation {
  std::int64_t compared = 0;
  std::int64_t left_out = 0;
  double mean_deg = 0;
  double high_deg = 0; ///< of a thousand pixels one is farther off, to 1/256 of it
  double most_deg = 0;
  int x = 0, y = 0; ///< the pixel farthest off, from the lower left
};

struct Verification {
  /// At the texels of the map, the nearest one fetched: what its encoding has lost. Those that no map in
  /// tangent space can hold are left out: Counts::singular, Counts::clamped.
  Deviation texels{};
  /// At the pixels of a picture, the map filtered: what filtering it instead of the stack's own maps changes.
  /// Pixels of what lies beyond the map are left out.
  Deviation on_screen{};
};

/// Sides of that picture.
inline constexpr int screen_side = 1024;

/// Decodes a map as an engine does, normalize(x T + y B + z N) of the interpolated vertex frame as it is, and
/// compares with the stack: at the points that were baked, and as the scene's camera sees it, with trilinear
/// filtering of the texels as they are encoded.
///
/// options  those it was baked with; the size is the map's
/// map      as read from its file: its depth says what its values are
/// Same result for any number of threads.
[[nodiscard]] Verification verify(const scene::Scene& scene, const Options& options, const image::Image& map,
                                  const Report& report = {});

} // namespace surfgrad::bake
