#include "maps/fit.hpp"

#include <cmath>
#include <cstddef>

namespace surfgrad::maps {
namespace {

/// Sums over pairs of one axis.
struct Sums {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;

  void add(double x, double y) {
    a += x;
    b += y;
    aa += x * x;
    bb += y * y;
    ab += x * y;
  }
  [[nodiscard]] double correlation(double count) const {
    const double varies = (aa - a * a / count) * (bb - b * b / count);
    return varies > 0 ? (ab - a * b / count) / std::sqrt(varies) : 0;
  }
};

} // namespace

Fit fit_slopes(const image::Image& slopes, const image::Image& reference) {
  Sums s, t;
  for (std::size_t i = 0; i < slopes.texels.size(); i += 2) {
    s.add(slopes.texels[i], reference.texels[i]);
    t.add(slopes.texels[i + 1], reference.texels[i + 1]);
  }
  const double count = static_cast<double>(slopes.width) * slopes.height;
  const double squares = s.aa + t.aa;
  return {{s.correlation(count), t.correlation(count)}, squares > 0 ? (s.ab + t.ab) / squares : 0};
}

} // namespace surfgrad::maps
