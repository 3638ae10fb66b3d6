#pragma once

/// How many results of a row may be looked at by less than its bound, and for which reason: stated here, so
/// that none passes unlooked at for a new one.

#include "conformance/rows.hpp"

#include <cmath>

namespace surfgrad::test {

/// Components of the edge table's results.
struct OpenCounts {
  long near = 0; ///< degenerate: among the neighbours' results (neighbourhood.hpp)
  long magnitude =
      0; ///< arguments beyond the magnitudes that shaders promise results for: finite as the core's
  long vanished = 0;  ///< a number where the core gives NaN or Inf: the function clamps
  long overflown = 0; ///< Inf or NaN where the core, which scales first, gives a number

  bool operator==(const OpenCounts&) const = default;
};

struct OpenResults {
  double ill_conditioned = 0; ///< share of the random arguments' results
  OpenCounts edges{};
  /// Of a unit vector's component, a weight, a clamped slope: no argument leads beyond,
  /// unless another component is NaN. HUGE_VAL where the
  /// function promises nothing.
  double largest = HUGE_VAL;
};

[[nodiscard]] OpenResults open_results(const Row& row);

} // namespace surfgrad::test
