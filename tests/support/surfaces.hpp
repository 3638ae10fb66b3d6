#pragma once

/// Analytic surfaces, texture coordinates and a camera in double: the truth that the core's
/// functions are compared with.

#include "support/dual.hpp"
#include "support/random.hpp"
#include <surfgrad/frame.hpp>
#include <surfgrad/screen.hpp>
#include <utility>

namespace surfgrad::test {

using vec2d = vec2<double>;
using vec3d = vec3<double>;
using mat3d = mat3<double>;
using mat4d = mat4<double>;

[[nodiscard]] inline vec3d value_of(const vec3<Dual<2>>& v) { return {v.x.value, v.y.value, v.z.value}; }
[[nodiscard]] inline vec3d partial_of(const vec3<Dual<2>>& v, int i) {
  return {v.x.partial[i], v.y.partial[i], v.z.partial[i]};
}

/// Position, unit normal and their derivatives by two parameters.
struct SurfacePoint {
  vec2d uv;
  vec3d position, normal;
  vec3d dp_du, dp_dv;
  vec3d dn_du, dn_dv;
};

/// Every surface offers position, outward unit normal, parameters of a point of space (a smooth
/// extension off the surface) and an implicit function that vanishes on the surface.
struct Plane {
  vec3d origin{0.3, -0.2, 0.1};
  mat3d axes{{0.8, 0.6, 0}, {-0.48, 0.64, 0.6}, {0.36, -0.48, 0.8}}; // rows: orthonormal, z the normal

  template <class T>
  [[nodiscard]] vec3<T> position(T u, T v) const {
    return lift<T>(origin) + u * lift<T>(axes.x) + v * lift<T>(axes.y);
  }
  template <class T>
  [[nodiscard]] vec3<T> normal(T, T) const {
    return lift<T>(axes.z);
  }
  template <class T>
  [[nodiscard]] vec2<T> parameters(vec3<T> p) const {
    const vec3<T> d = p - lift<T>(origin);
    return {dot(d, lift<T>(axes.x)), dot(d, lift<T>(axes.y))};
  }
  template <class T>
  [[nodiscard]] T implicit(vec3<T> p) const {
    return dot(p - lift<T>(origin), lift<T>(axes.z));
  }
  template <class T>
  [[nodiscard]] static vec3<T> lift(vec3d v) {
    return {T(v.x), T(v.y), T(v.z)};
  }
};

struct Sphere {
  double radius = 1.7;

  template <class T>
  [[nodiscard]] vec3<T> normal(T u, T v) const {
    using std::cos, std::sin;
    return {cos(u) * cos(v), sin(u) * cos(v), sin(v)};
  }
  template <class T>
  [[nodiscard]] vec3<T> position(T u, T v) const {
    return T(radius) * normal(u, v);
  }
  template <class T>
  [[nodiscard]] vec2<T> parameters(vec3<T> p) const {
    using std::atan2, std::sqrt;
    return {atan2(p.y, p.x), atan2(p.z, sqrt(p.x * p.x + p.y * p.y))};
  }
  template <class T>
  [[nodiscard]] T implicit(vec3<T> p) const {
    return dot(p, p) - T(radius * radius);
  }
};

struct Torus {
  double ring = 2.0;
  double tube = 0.7;

  template <class T>
  [[nodiscard]] vec3<T> normal(T u, T v) const {
    using std::cos, std::sin;
    return {cos(u) * cos(v), sin(u) * cos(v), sin(v)};
  }
  template <class T>
  [[nodiscard]] vec3<T> position(T u, T v) const {
    using std::cos, std::sin;
    const T r = T(ring) + T(tube) * cos(v);
    return {r * cos(u), r * sin(u), T(tube) * sin(v)};
  }
  template <class T>
  [[nodiscard]] vec2<T> parameters(vec3<T> p) const {
    using std::atan2, std::sqrt;
    return {atan2(p.y, p.x), atan2(p.z, sqrt(p.x * p.x + p.y * p.y) - T(ring))};
  }
  template <class T>
  [[nodiscard]] T implicit(vec3<T> p) const {
    using std::sqrt;
    const T d = sqrt(p.x * p.x + p.y * p.y) - T(ring);
    return d * d + p.z * p.z - T(tube * tube);
  }
};

template <class Surface>
[[nodiscard]] SurfacePoint evaluate(const Surface& surface, vec2d uv) {
  const Dual<2> u = Dual<2>::variable(uv.x, 0);
  const Dual<2> v = Dual<2>::variable(uv.y, 1);
  const vec3<Dual<2>> p = surface.position(u, v);
  const vec3<Dual<2>> n = surface.normal(u, v);
  return {
      uv, value_of(p), value_of(n), partial_of(p, 0), partial_of(p, 1), partial_of(n, 0), partial_of(n, 1)};
}

/// A point away from the poles of the sphere, where its parameters collapse.
template <class Surface>
[[nodiscard]] SurfacePoint random_point(const Surface& surface, Random& random) {
  return evaluate(surface, random.vector2(-1.2, 1.2));
}

/// Calls `visit` with a plane, a sphere and a torus.
template <class Visit>
void for_each_surface(Visit&& visit) {
  visit(Plane{});
  visit(Sphere{});
  visit(Torus{});
}

/// Texture coordinates (s, t) as an affine map of the parameters: scaled, sheared, mirrored.
struct UvMap {
  vec2d s, t; ///< rows of the linear part
  vec2d offset{0, 0};

  template <class T>
  [[nodiscard]] vec2<T> operator()(vec2<T> uv) const {
    return {T(s.x) * uv.x + T(s.y) * uv.y + T(offset.x), T(t.x) * uv.x + T(t.y) * uv.y + T(offset.y)};
  }
  [[nodiscard]] double determinant() const { return cross(s, t); }
  [[nodiscard]] vec2d linear(vec2d d) const { return {dot(s, d), dot(t, d)}; }
  [[nodiscard]] UvMap inverse() const {
    const double f = 1 / determinant();
    const vec2d a{f * t.y, -f * s.y};
    const vec2d b{-f * t.x, f * s.x};
    return {a, b, {-dot(a, offset), -dot(b, offset)}};
  }
  /// dp/ds and dp/dt at a point: the columns of [dp_du dp_dv] * inverse.
  [[nodiscard]] std::pair<vec3d, vec3d> tangents(const SurfacePoint& p) const {
    const UvMap i = inverse();
    return {i.s.x * p.dp_du + i.t.x * p.dp_dv, i.s.y * p.dp_du + i.t.y * p.dp_dv};
  }
};

/// Well away from collapse, of either handedness.
[[nodiscard]] inline UvMap random_uv_map(Random& random) {
  for (;;) {
    const UvMap map{random.vector2(-2, 2), random.vector2(-2, 2), random.vector2()};
    if (std::abs(map.determinant()) > 0.3) return map;
  }
}

/// Derivatives of the surface by the screen at one fragment.
struct Fragment {
  vec2d pixel;
  vec3d dp_dx, dp_dy;
  vec2d duv_dx, duv_dy;
  bool front_facing;
};

/// A pinhole camera. `screen_y` is -1 where pixel rows run down the picture.
struct Pinhole {
  vec3d eye;
  mat3d axes; ///< rows: right, up, forward
  double focal_px = 500;
  vec2d centre_px{320, 240};
  double screen_y = -1;

  /// Not unit: its part along the forward axis is 1.
  template <class T>
  [[nodiscard]] vec3<T> direction(T x, T y) const {
    const T right = (x - T(centre_px.x)) / T(focal_px);
    const T up = T(screen_y) * ((y - T(centre_px.y)) / T(focal_px));
    return right * Plane::lift<T>(axes.x) + up * Plane::lift<T>(axes.y) + Plane::lift<T>(axes.z);
  }
  [[nodiscard]] vec2d project(vec3d p) const {
    const vec3d d = p - eye;
    const double z = dot(d, axes.z);
    return {centre_px.x + focal_px * dot(d, axes.x) / z,
            centre_px.y + screen_y * focal_px * dot(d, axes.y) / z};
  }
  /// The point of the plane through `p` with normal `n` under a pixel.
  template <class T>
  [[nodiscard]] vec3<T> intersect(vec3d p, vec3d n, T x, T y) const {
    const vec3<T> d = direction(x, y);
    const T along = T(dot(p - eye, n)) / dot(Plane::lift<T>(n), d);
    return Plane::lift<T>(eye) + along * d;
  }
  /// Exact to first order: the tangent plane and the surface share their first derivatives.
  [[nodiscard]] Fragment fragment(const SurfacePoint& p) const {
    const vec2d pixel = project(p.position);
    const vec3<Dual<2>> hit =
        intersect(p.position, p.normal, Dual<2>::variable(pixel.x, 0), Dual<2>::variable(pixel.y, 1));
    const vec3d dp_dx = partial_of(hit, 0);
    const vec3d dp_dy = partial_of(hit, 1);
    return {pixel,
            dp_dx,
            dp_dy,
            parameters_of(p, dp_dx),
            parameters_of(p, dp_dy),
            dot(eye - p.position, p.normal) > 0};
  }
  /// (du, dv) with dp_du * du + dp_dv * dv = d, for d in the tangent plane.
  [[nodiscard]] static vec2d parameters_of(const SurfacePoint& p, vec3d d) {
    const double a = dot(p.dp_du, p.dp_du);
    const double b = dot(p.dp_du, p.dp_dv);
    const double c = dot(p.dp_dv, p.dp_dv);
    const double e = dot(p.dp_du, d);
    const double f = dot(p.dp_dv, d);
    const double det = a * c - b * b;
    return {(c * e - b * f) / det, (a * f - b * e) / det};
  }
  /// (x, y, depth, 1) in pixels, depth in [0, 1] between the clip distances, to world space.
  [[nodiscard]] mat4d world_from_screen(double near_clip, double far_clip) const {
    const double a = far_clip / (far_clip - near_clip);
    const double b = -near_clip * a;
    // depth = a + b / z, so z = b / (depth - a) and world * (depth - a) = eye * (depth - a) + b * d.
    const vec3d x = (b / focal_px) * axes.x;
    const vec3d y = (b * screen_y / focal_px) * axes.y;
    const vec3d w = b * direction(0.0, 0.0) - a * eye;
    return {{x.x, y.x, eye.x, w.x}, {x.y, y.y, eye.y, w.y}, {x.z, y.z, eye.z, w.z}, {0, 0, 1, -a}};
  }
};

/// Looks at `p` from a random place at least 20 degrees off edge-on, from either side, with either
/// direction of screen y.
[[nodiscard]] inline Pinhole random_camera(const SurfacePoint& p, Random& random) {
  for (;;) {
    const vec3d towards = random.unit_vector();
    if (std::abs(dot(towards, p.normal)) < 0.34) continue;
    const vec3d eye = p.position + random.uniform(2, 6) * towards;
    const vec3d target = p.position + 0.3 * random.vector3();
    const vec3d forward = normalize_or_zero(target - eye);
    const vec3d right = normalize_or_zero(cross(forward, random.unit_vector()));
    return {eye, {right, cross(right, forward), forward}, 500, {320, 240}, random.sign()};
  }
}

/// The core's frame at a fragment.
[[nodiscard]] inline Frame<double> frame_at(const SurfacePoint& p, const Fragment& f) {
  return make_frame(p.normal, f.dp_dx, f.dp_dy);
}

/// A smooth height over two parameters, its derivatives of order one.
template <class T>
[[nodiscard]] T wavy(vec2<T> q) {
  using std::sin, std::cos;
  return T(0.3) * sin(T(2.1) * q.x + T(0.4) * q.y) + T(0.2) * cos(T(1.3) * q.y - q.x * q.y);
}
/// A smooth function of space, its derivatives of order one.
template <class T>
[[nodiscard]] T wavy(vec3<T> p) {
  using std::sin, std::cos;
  return T(0.4) * sin(p.x + T(0.7) * p.y) + T(0.3) * cos(p.z * p.x) + T(0.2) * p.y * p.z;
}

/// (df/dx, df/dy) of a function of two variables.
template <class Function>
[[nodiscard]] vec2d gradient_of(Function&& f, vec2d q) {
  const Dual<2> r = f(vec2<Dual<2>>{Dual<2>::variable(q.x, 0), Dual<2>::variable(q.y, 1)});
  return {r.partial[0], r.partial[1]};
}
/// Gradient of a function of space.
template <class Function>
[[nodiscard]] vec3d gradient_of(Function&& f, vec3d p) {
  const Dual<3> r =
      f(vec3<Dual<3>>{Dual<3>::variable(p.x, 0), Dual<3>::variable(p.y, 1), Dual<3>::variable(p.z, 2)});
  return {r.partial[0], r.partial[1], r.partial[2]};
}

} // namespace surfgrad::test
