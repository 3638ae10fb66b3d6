#pragma once

/// Height images, and fragments of analytic surfaces to lay them on.

#include "lab.hpp"
#include "support/surfaces.hpp"

#include <numbers>

namespace surfgrad::engine::test {

using surfgrad::test::SurfacePoint;
using surfgrad::test::UvMap;

inline mat3<double> scaling(vec3<double> s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}}; }

/// A smooth height of period 1 along s and t, its derivatives up to about 2.
template <class T>
[[nodiscard]] T waves(vec2<T> st) {
  using std::sin, std::cos;
  const T turn = T(2 * std::numbers::pi);
  return T(0.5) + T(0.2) * sin(turn * (st.x + T(2) * st.y) + T(0.3)) +
         T(0.1) * cos(turn * (T(2) * st.x - st.y));
}

/// One channel: value(s, t) at the centres of the texels.
template <class Value>
[[nodiscard]] image::Image height_image(int width, int height, Value value) {
  image::Image result = image::make_image(width, height, 1, image::Depth::float32);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      result.at(x, y, 0) = static_cast<float>(value(vec2<double>{(x + 0.5) / width, (y + 0.5) / height}));
  return result;
}

/// The fragment of a point under a camera, st = uv(parameters) its texture coordinate.
inline raster::Fragment<double> fragment_of(const SurfacePoint& p, const surfgrad::test::Fragment& screen,
                                            const UvMap& uv) {
  raster::Fragment<double> f{};
  f.raster = screen.pixel;
  f.position = f.object_position = p.position;
  f.normal = p.normal;
  f.dp_dx = screen.dp_dx;
  f.dp_dy = screen.dp_dy;
  f.front_facing = true;
  f.uvs[0].st = uv(p.uv);
  f.uvs[0].dst_dx = f.uvs[0].footprint_dx = uv.linear(screen.duv_dx);
  f.uvs[0].dst_dy = f.uvs[0].footprint_dy = uv.linear(screen.duv_dy);
  f.uvs[0].sign = 1;
  return f;
}

/// The same point under pixels that are `factor` as large.
inline raster::Fragment<double> zoomed(raster::Fragment<double> f, double factor) {
  f.dp_dx = factor * f.dp_dx;
  f.dp_dy = factor * f.dp_dy;
  for (raster::UvFragment<double>& uv : f.uvs) {
    uv.dst_dx = uv.footprint_dx = factor * uv.dst_dx;
    uv.dst_dy = uv.footprint_dy = factor * uv.dst_dy;
  }
  return f;
}

/// Under pixels whose longer axis covers this many texels of a square map of `size`.
inline raster::Fragment<double> with_footprint(const raster::Fragment<double>& f, double texels, int size) {
  const double longer = std::max(length(f.uvs[0].dst_dx), length(f.uvs[0].dst_dy));
  return zoomed(f, texels / (longer * size));
}

/// The same surface in the world of an object placed by m.
inline raster::Fragment<double> moved(raster::Fragment<double> f, const mat3<double>& m) {
  f.position = m * f.position;
  f.normal = normalize_or_zero(transform_normal(m, f.normal));
  f.dp_dx = m * f.dp_dx;
  f.dp_dy = m * f.dp_dy;
  return f;
}

/// Blinn's normal: across the tangents p_s + h_s n and p_t + h_t n, the curvature's part left out.
/// dh_dst  derivative of the displacement by the texture coordinate
inline vec3<double> blinn_normal(const SurfacePoint& p, const UvMap& uv, vec2<double> dh_dst) {
  const auto [t, b] = uv.tangents(p);
  const double side = uv.determinant() < 0 ? -1 : 1;
  return side * normalize_or_zero(cross(t + dh_dst.x * p.normal, b + dh_dst.y * p.normal));
}

/// Calls visit(point, uv, fragment) for points of a plane, a sphere and a torus. Coordinates are sheared,
/// half of them mirrored.
template <class Visit>
void for_each_point(Random& random, int count, Visit visit) {
  surfgrad::test::for_each_surface([&](const auto& surface) {
    for (int i = 0; i < count; ++i) {
      const SurfacePoint p = surfgrad::test::random_point(surface, random);
      const UvMap uv = surfgrad::test::random_uv_map(random);
      visit(p, uv, fragment_of(p, surfgrad::test::random_camera(p, random).fragment(p), uv));
    }
  });
}

/// Every way in which a height map makes slopes.
struct Way {
  const char* name;
  stack::HeightMode mode;
  stack::Units units;
  stack::Taps taps;
};
inline constexpr Way ways[] = {
    {"one tap", stack::HeightMode::physical, stack::Units::scene, stack::Taps::one},
    {"three taps", stack::HeightMode::physical, stack::Units::scene, stack::Taps::three},
    {"bicubic", stack::HeightMode::physical, stack::Units::scene, stack::Taps::bicubic},
    {"object units", stack::HeightMode::physical, stack::Units::object, stack::Taps::three},
    {"scale-free", stack::HeightMode::scale_free, stack::Units::scene, stack::Taps::three},
    {"scale-free bicubic", stack::HeightMode::scale_free, stack::Units::scene, stack::Taps::bicubic}};

inline stack::HeightMapLayer layer_of(const Way& way, double height) {
  stack::HeightMapLayer layer = height_layer("heights", height, way.mode);
  layer.units = way.units;
  layer.taps = way.taps;
  return layer;
}

} // namespace surfgrad::engine::test
