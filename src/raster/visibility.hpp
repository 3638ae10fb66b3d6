#pragma once

#include "raster/surface.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace surfgrad::raster {

/// Which triangle a pixel shows.
struct Visible {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t surface = none;
  std::uint32_t triangle = 0;
};

/// The nearest triangle at every pixel centre; row 0 at the bottom.
struct VisibilityBuffer {
  int width = 0;
  int height = 0;
  std::vector<Visible> pixels;

  [[nodiscard]] const Visible& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// Screen triangle setup: corners of a world-space triangle under a camera.
/// screen_from_world takes positions (relative to the surface's origin) to (x w, y w, w) in pixels.
[[nodiscard]] TrianglePlanes screen_planes(const Surface& surface, std::uint32_t triangle,
                                           const mat4<double>& screen_from_world);

/// Texture triangle setup: the triangle as it lies in a UV set, in texels.
[[nodiscard]] TrianglePlanes uv_planes(const Surface& surface, std::size_t slot, std::uint32_t triangle,
                                       int width, int height);

/// Depth-tested visibility from a camera. Both sides of triangles are kept unless `skip` says so;
/// what is nearer than `near` is not seen. Equal depths go to the earlier surface and triangle, so
/// that the result does not depend on threads.
///
/// screen_from_world  rows x, y and w of the projection to pixels, in mat4 rows x, y and w
/// skip               (surface, triangle, front_facing) -> leave this triangle out; may be empty
[[nodiscard]] VisibilityBuffer
see_from_camera(const std::vector<Surface>& surfaces, const mat4<double>& screen_from_world, double near,
                int width, int height, const std::function<bool(std::uint32_t, std::uint32_t, bool)>& skip);

/// Which triangle owns each texel centre of a UV set. Where islands overlap the lowest surface and
/// triangle index wins; `overlapping` (may be null) receives how many texels had more than one.
[[nodiscard]] VisibilityBuffer lay_out_in_uv(const std::vector<Surface>& surfaces, std::size_t slot,
                                             int width, int height, std::int64_t* overlapping);

} // namespace surfgrad::raster
