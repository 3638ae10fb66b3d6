#pragma once

#include <array>
#include <cstdint>

namespace surfgrad::bake {

/// Texels along a side of the tile of blue noise.
inline constexpr int blue_noise_side = 64;

using BlueNoise = std::array<std::uint16_t, blue_noise_side * blue_noise_side>;

/// Ranks from 0 to side^2 - 1, each once, so ordered that those below any limit lie evenly over the tile and
/// its repetitions: low frequencies, which the eye and mip levels keep, are all but absent. Made once, the
/// same on every machine, by the void-and-cluster method (Ulichney 1993).
[[nodiscard]] const BlueNoise& blue_noise();

} // namespace surfgrad::bake
