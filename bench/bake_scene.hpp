#pragma once

/// What the bakes and renders of the races work on.

#include "scene/scene.hpp"

namespace surfgrad::bench {

inline constexpr double noise_frequency = 8; ///< cells a unit of length
inline constexpr double noise_height = 0.02;

/// A torus that fills the unit square of UV set 0, under two normal maps on two UV sets, both in the
/// vertex frame, and noise on top of what they make.
///
/// map_size  side of the two 16-bit maps
[[nodiscard]] scene::Scene bake_scene(int map_size);

/// Names of the maps in the scene.
inline constexpr const char* first_map = "first.png";
inline constexpr const char* second_map = "second.png";

} // namespace surfgrad::bench
