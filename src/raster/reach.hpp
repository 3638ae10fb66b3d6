#pragma once

#include "raster/surface.hpp"

#include <array>

namespace surfgrad::raster {

/// How a triangle of a texture lies to pixels whose centre it does not cover.
class Reach {
 public:
  /// corners         as of TrianglePlanes, w = 1
  /// x_most, y_most  of the points that are asked about
  Reach(const std::array<vec3<double>, 3>& corners, double x_most, double y_most);

  [[nodiscard]] const TrianglePlanes& planes() const { return planes_; }
  /// Whether its area is more than what its edge functions are rounded by: else attributes, which change over
  /// its width, are noise.
  [[nodiscard]] bool has_area() const { return has_area_; }
  /// Whether some of it lies inside the unit square around a point; its border does not count.
  [[nodiscard]] bool into_square(double x, double y) const;
  /// Edge functions that are positive where the square around a point is not wholly beyond the edge.
  [[nodiscard]] const std::array<vec3<double>, 3>& widened_edges() const { return widened_; }
  /// Its point nearest to one that it does not cover.
  [[nodiscard]] vec2<double> nearest(double x, double y) const;

 private:
  TrianglePlanes planes_;
  TrianglePlanes::Box box_;
  std::array<vec2<double>, 3> corners_;
  std::array<vec3<double>, 3> widened_{};
  bool has_area_ = false;
};

} // namespace surfgrad::raster
