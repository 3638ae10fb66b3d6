#pragma once

/// What the bakes and renders of the races work on.

#include "image/image.hpp"
#include "scene/scene.hpp"

namespace surfgrad::bench {

inline constexpr double noise_frequency = 8; ///< cells a unit of length
inline constexpr double noise_height = 0.02;

/// A torus that fills the unit square of UV set 0, under two normal maps on two UV sets, both in the
/// vertex frame, and noise on top of what they make.
///
/// map_size  side of the two maps
/// depth     of the files that they might have come from
[[nodiscard]] scene::Scene bake_scene(int map_size, image::Depth depth = image::Depth::unorm16);

/// Names of the maps in the scene.
inline constexpr const char* first_map = "first.png";
inline constexpr const char* second_map = "second.png";

} // namespace surfgrad::bench
