#pragma once

#include "raster/surface.hpp"

#include <array>

namespace surfgrad::raster {

/// How surfaces lie in a raster: as a camera sees them, or as a UV set lays them out.
class Projection {
 public:
  /// screen_from_world  rows x, y and w of the projection to pixels, in mat4 rows x, y and w; takes
  ///                    positions relative to the surfaces' origin
  /// near               what is nearer than this is not seen
  [[nodiscard]] static Projection camera(const mat4<double>& screen_from_world, double near);
  /// A unit square of a UV set over a raster of this size.
  ///
  /// corner  texture coordinates of its lower left corner
  [[nodiscard]] static Projection texture(std::size_t slot, int width, int height,
                                          vec2<double> corner = {0, 0});

  /// Corners of a triangle as (x w, y w, w) in pixels, y up; w is 1 in a texture.
  [[nodiscard]] std::array<vec3<double>, 3> corners(const Surface& surface, std::uint32_t triangle) const;
  [[nodiscard]] TrianglePlanes planes(const Surface& surface, std::uint32_t triangle) const {
    return TrianglePlanes(corners(surface, triangle));
  }

  /// Whether nearer triangles hide others. In a texture the first one stays.
  [[nodiscard]] bool has_depth() const { return near_ > 0; }
  [[nodiscard]] double near() const { return near_; }

 private:
  mat4<double> screen_from_world_{};
  double near_ = 0;
  std::size_t slot_ = 0;
  vec2<double> size_{0, 0};
  vec2<double> corner_{0, 0};
};

} // namespace surfgrad::raster
