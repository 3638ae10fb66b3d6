#pragma once

namespace surfgrad::maps {

/// What adjoins the border of a map.
enum class Borders {
  wrap,  ///< its other side
  clamp, ///< nothing: heights go on as their point reflection at the border texel, so that a plane stays one
};

/// A texel beyond the border, from those within: texel * h[index] + first * h[0] + last * h[count - 1].
struct Beyond {
  int index = 0;
  double texel = 1;
  double first = 0;
  double last = 0;
};

/// i may be any number.
[[nodiscard]] Beyond beyond(int i, int count, Borders borders);

} // namespace surfgrad::maps
