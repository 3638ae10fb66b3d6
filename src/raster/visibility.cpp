#include "raster/visibility.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace surfgrad::raster {
namespace {

/// Rows that one task fills. Every task walks all triangles, so bands are few and tall.
constexpr int rows_per_band = 64;

struct PixelRange {
  int x_begin, x_end, y_begin, y_end;
};

/// Pixels whose centres the triangle can cover. A corner at or behind the eye has no image: the
/// triangle may then reach anywhere.
PixelRange pixel_range(const std::array<vec3<double>, 3>& corners, int width, int height) {
  double x_low = INFINITY, x_high = -INFINITY, y_low = INFINITY, y_high = -INFINITY;
  for (const vec3<double>& c : corners) {
    if (!(c.z > 0)) return {0, width, 0, height};
    x_low = std::min(x_low, c.x / c.z);
    x_high = std::max(x_high, c.x / c.z);
    y_low = std::min(y_low, c.y / c.z);
    y_high = std::max(y_high, c.y / c.z);
  }
  // One pixel of margin covers the rounding of the divisions; covers() decides exactly.
  const auto first = [](double low, int limit) {
    return static_cast<int>(std::clamp(std::floor(low) - 1, 0.0, double(limit)));
  };
  const auto last = [](double high, int limit) {
    return static_cast<int>(std::clamp(std::ceil(high) + 1, 0.0, double(limit)));
  };
  return {first(x_low, width), last(x_high, width), first(y_low, height), last(y_high, height)};
}

std::array<vec3<double>, 3> screen_corners(const Surface& surface, std::uint32_t triangle,
                                           const mat4<double>& m) {
  std::array<vec3<double>, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const vec3<double> p = surface.positions[surface.mesh->triangles[triangle][i]];
    const vec4<double> h{p.x, p.y, p.z, 1};
    corners[i] = {dot(m.x, h), dot(m.y, h), dot(m.w, h)};
  }
  return corners;
}

std::array<vec3<double>, 3> uv_corners(const Surface& surface, std::size_t slot, std::uint32_t triangle,
                                       int width, int height) {
  std::array<vec3<double>, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const vec2<double> st = surface.slots[slot].st[surface.mesh->triangles[triangle][i]];
    corners[i] = {st.x * width, st.y * height, 1};
  }
  return corners;
}

/// Calls visit(surface, triangle, planes, range) for every triangle, clipped to bands of rows, in
/// index order within a band; bands run in parallel.
template <class Corners, class Visit>
void for_each_triangle_in_bands(const std::vector<Surface>& surfaces, int width, int height,
                                const Corners& corners, const Visit& visit) {
  const int bands = (height + rows_per_band - 1) / rows_per_band;
  tbb::parallel_for(0, bands, [&](int band) {
    const int y_begin = band * rows_per_band;
    const int y_end = std::min(height, y_begin + rows_per_band);
    for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
      const auto count = static_cast<std::uint32_t>(surfaces[s].mesh->triangles.size());
      for (std::uint32_t t = 0; t < count; ++t) {
        const std::array<vec3<double>, 3> c = corners(s, t);
        PixelRange range = pixel_range(c, width, height);
        range.y_begin = std::max(range.y_begin, y_begin);
        range.y_end = std::min(range.y_end, y_end);
        if (range.y_begin >= range.y_end || range.x_begin >= range.x_end) continue;
        const TrianglePlanes planes(c);
        if (!planes.degenerate()) visit(s, t, planes, range);
      }
    }
  });
}

/// Calls visit(index of the pixel, x, y of its centre) for the pixels of the range that are covered.
template <class Visit>
void for_each_covered_pixel(const TrianglePlanes& planes, PixelRange range, int width, const Visit& visit) {
  for (int y = range.y_begin; y < range.y_end; ++y)
    for (int x = range.x_begin; x < range.x_end; ++x)
      if (planes.covers(x + 0.5, y + 0.5))
        visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x),
              x + 0.5, y + 0.5);
}

} // namespace

TrianglePlanes screen_planes(const Surface& surface, std::uint32_t triangle,
                             const mat4<double>& screen_from_world) {
  return TrianglePlanes(screen_corners(surface, triangle, screen_from_world));
}

TrianglePlanes uv_planes(const Surface& surface, std::size_t slot, std::uint32_t triangle, int width,
                         int height) {
  return TrianglePlanes(uv_corners(surface, slot, triangle, width, height));
}

VisibilityBuffer see_from_camera(const std::vector<Surface>& surfaces, const mat4<double>& screen_from_world,
                                 double near, int width, int height,
                                 const std::function<bool(std::uint32_t, std::uint32_t, bool)>& skip) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  VisibilityBuffer buffer{width, height, std::vector<Visible>(count)};
  std::vector<double> nearest(count, 0.0); // 1 / w: 0 is infinitely far
  const auto corners = [&](std::uint32_t s, std::uint32_t t) {
    return screen_corners(surfaces[s], t, screen_from_world);
  };
  for_each_triangle_in_bands(
      surfaces, width, height, corners,
      [&](std::uint32_t s, std::uint32_t t, const TrianglePlanes& planes, PixelRange range) {
        if (skip && skip(s, t, planes.counter_clockwise() != surfaces[s].mirrored)) return;
        for_each_covered_pixel(planes, range, width, [&](std::size_t i, double x, double y) {
          const double inverse_w = planes.inverse_w(x, y);
          if (inverse_w * near > 1 || !(inverse_w > nearest[i])) return;
          nearest[i] = inverse_w;
          buffer.pixels[i] = {s, t};
        });
      });
  return buffer;
}

VisibilityBuffer lay_out_in_uv(const std::vector<Surface>& surfaces, std::size_t slot, int width, int height,
                               std::int64_t* overlapping) {
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  VisibilityBuffer buffer{width, height, std::vector<Visible>(count)};
  std::vector<unsigned char> covered(count, 0);
  std::atomic<std::int64_t> overlaps{0};
  const auto corners = [&](std::uint32_t s, std::uint32_t t) {
    return uv_corners(surfaces[s], slot, t, width, height);
  };
  for_each_triangle_in_bands(
      surfaces, width, height, corners,
      [&](std::uint32_t s, std::uint32_t t, const TrianglePlanes& planes, PixelRange range) {
        for_each_covered_pixel(planes, range, width, [&](std::size_t i, double, double) {
          if (covered[i] == 0) buffer.pixels[i] = {s, t};
          if (covered[i] == 1) ++overlaps;
          if (covered[i] < 2) ++covered[i];
        });
      });
  if (overlapping != nullptr) *overlapping = overlaps;
  return buffer;
}

} // namespace surfgrad::raster
