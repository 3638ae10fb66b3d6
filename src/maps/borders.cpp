#include "maps/borders.hpp"

namespace surfgrad::maps {

Beyond beyond(int i, int count, Borders borders) {
  if (i >= 0 && i < count) return {.index = i};
  if (borders == Borders::wrap) return {.index = (i % count + count) % count};
  if (count == 1) return {};
  // Reflected at both ends, heights repeat after two lengths but for what they rise: h[i + 2 length] = h[i] +
  // 2 (h[last] - h[0]).
  const int period = 2 * (count - 1);
  const int remainder = (i % period + period) % period;
  const double rise = 2.0 * ((i - remainder) / period);
  if (remainder < count) return {remainder, 1, -rise, rise};
  return {period - remainder, -1, -rise, rise + 2};
}

} // namespace surfgrad::maps
