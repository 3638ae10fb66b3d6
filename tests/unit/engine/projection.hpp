#pragma once

/// Heights that a projected image holds exactly, and fragments of analytic surfaces to project them on.

#include "lab.hpp"
#include "support/surfaces.hpp"

namespace surfgrad::engine::test {

using surfgrad::test::vec2d;
using surfgrad::test::vec3d;

/// A polynomial of degree 2 in two coordinates. Its coefficients are whole sixteenths, so that texels at
/// dyadic places hold its values and its slopes without rounding; central differences and linear filters
/// are exact for it too.
struct Quadratic {
  double a, b, aa, ab, bb;

  explicit Quadratic(Random& random) {
    const auto coefficient = [&] { return (random.integer(33) - 16) / 16.0; };
    a = coefficient(), b = coefficient(), aa = coefficient(), ab = coefficient(), bb = coefficient();
  }
  template <class T>
  [[nodiscard]] T operator()(vec2<T> q) const {
    return T(a) * q.x + T(b) * q.y + T(0.5 * aa) * (q.x * q.x) + T(ab) * (q.x * q.y) +
           T(0.5 * bb) * (q.y * q.y);
  }
  [[nodiscard]] vec2d gradient(vec2d q) const { return {a + aa * q.x + ab * q.y, b + ab * q.x + bb * q.y}; }
};

/// How the images lie: st in [-2, 2] is one map of 32 x 32 texels.
inline constexpr double tile = 0.25;
inline constexpr double offset = 0.5;
inline constexpr int texels = 32;

inline void lay(stack::Tiled& use) {
  use.tile = {tile, tile};
  use.offset = {offset, offset};
  use.wrap = stack::Wrap::clamp;
  use.filter = stack::Filter::bilinear;
}

/// An image of `value(st)`, a vec3 of channels, laid so.
template <class Value>
image::Image image_of(const Value& value) {
  image::Image result = surfgrad::test::constant_image(texels, texels, {0, 0, 0});
  for (int y = 0; y < texels; ++y)
    for (int x = 0; x < texels; ++x) {
      const vec3d v =
          value(vec2d{((x + 0.5) / texels - offset) / tile, ((y + 0.5) / texels - offset) / tile});
      result.at(x, y, 0) = static_cast<float>(v.x);
      result.at(x, y, 1) = static_cast<float>(v.y);
      result.at(x, y, 2) = static_cast<float>(v.z);
    }
  return result;
}

/// The fragment of a surface in object space, the object at the world's origin.
inline raster::Fragment<double> fragment_of(const surfgrad::test::SurfacePoint& p, Random& random) {
  raster::Fragment<double> f = random_fragment(random);
  const surfgrad::test::Fragment seen = random_camera(p, random).fragment(p);
  f.object_position = p.position;
  f.position = p.position;
  f.normal = p.normal;
  f.dp_dx = seen.dp_dx;
  f.dp_dy = seen.dp_dy;
  return f;
}

/// The same fragment of the object under a linear transform.
inline raster::Fragment<double> moved(raster::Fragment<double> f, const mat3<double>& m) {
  f.position = m * f.object_position;
  f.normal = normalize_or_zero(transform_normal(m, f.normal));
  f.dp_dx = m * f.dp_dx;
  f.dp_dy = m * f.dp_dy;
  return f;
}

/// Blinn's normal of a height over a surface, its weights held still: T + h_u N and B + h_v N, where
/// height(position) is over dual numbers.
template <class Surface, class Height>
vec3d blinn_normal(const Surface& surface, const surfgrad::test::SurfacePoint& p, const Height& height) {
  const vec2d h =
      surfgrad::test::gradient_of([&](auto uv) { return height(surface.position(uv.x, uv.y)); }, p.uv);
  const vec3d n = normalize_or_zero(cross(p.dp_du + h.x * p.normal, p.dp_dv + h.y * p.normal));
  return dot(cross(p.dp_du, p.dp_dv), p.normal) < 0 ? -n : n;
}

/// The normal of a surface bumped in object space, under the object's transform (Golubev, equation 33);
/// where it would lie below the surface, mirrored there (listing 7).
inline vec3d transformed_normal(const mat3<double>& m, vec3d normal, vec3d surfgrad) {
  const vec3d base = normalize_or_zero(transform_normal(m, normal));
  return normalize_or_zero(base - from_perturbed_normal(base, transform_normal(m, normal - surfgrad)));
}

/// A transform that turns and scales by up to 2 along any directions.
inline mat3<double> random_stretch(Random& random) {
  const vec3d s = random.vector3(0.5, 2);
  return random.rotation() * (mat3<double>{{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}} * random.rotation());
}

} // namespace surfgrad::engine::test
