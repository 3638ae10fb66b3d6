#pragma once

/// One set of arguments for every function of the core, in any scalar.

#include "support/random.hpp"
#include <array>
#include <cstring>
#include <surfgrad/frame.hpp>

namespace surfgrad::test {

/// An aggregate of scalars only, so that it converts element by element.
template <class T>
struct CoreInputs {
  Frame<T> frame; ///< normal unit to rounding; sigma and flip_sign computed in float
  vec3<T> raw_normal, raw_tangent;
  T sign;
  vec3<T> tangent, bitangent;
  vec3<T> perturbed;
  vec3<T> dp_du, dp_dv;
  vec3<T> gradient;
  vec3<T> direction; ///< unit to rounding
  vec3<T> position;
  vec3<T> dn_dx, dn_dy;
  vec3<T> weights;
  vec3<T> tangent_normal;
  vec2<T> xy_normal;
  vec2<T> dst_dx, dst_dy;
  vec2<T> texture_offset;
  vec2<T> size;
  vec2<T> deriv, deriv_y, deriv_z; ///< slopes
  vec2<T> dh_duv;                  ///< heights, hence lengths
  T height, height_x, height_y;
  T bump_scale; ///< a length
  T scale;
  mat4<T> texels;
  vec2<T> fraction;
  mat3<T> rotation, matrix;
  mat4<T> world_from_screen;
  T x, y;
};

template <class T>
inline constexpr std::size_t core_input_count = sizeof(CoreInputs<T>) / sizeof(T);

template <class T>
[[nodiscard]] std::array<T, core_input_count<T>> elements(const CoreInputs<T>& in) {
  std::array<T, core_input_count<T>> a;
  static_assert(sizeof(a) == sizeof(in));
  std::memcpy(a.data(), &in, sizeof(in));
  return a;
}
template <class T>
[[nodiscard]] CoreInputs<T> from_elements(const std::array<T, core_input_count<T>>& a) {
  CoreInputs<T> in;
  std::memcpy(static_cast<void*>(&in), a.data(), sizeof(in));
  return in;
}

template <class To, class From>
[[nodiscard]] CoreInputs<To> convert(const CoreInputs<From>& in) {
  const auto from = elements(in);
  std::array<To, core_input_count<To>> to;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<To>(from[i]);
  return from_elements(to);
}

template <class To>
[[nodiscard]] vec3<To> convert(vec3<double> v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
}
template <class To>
[[nodiscard]] vec2<To> convert(vec2<double> v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y)};
}

/// Ranges of magnitudes. Lengths are those of a scene, rates those of texture coordinates.
struct InputRanges {
  double shortest = 1e-5;
  double longest = 1e2;
  double zero_chance = 0; ///< share of the elements replaced by zero
};

/// Arguments as a renderer meets them: a camera's matrix, unit normals, heights in scene units.
template <class T>
[[nodiscard]] CoreInputs<T> random_inputs(Random& random, const InputRanges& ranges = {}) {
  const auto length = [&] { return random.magnitude(ranges.shortest, ranges.longest); };
  const auto any3 = [&] { return convert<T>(length() * random.vector3()); };
  const auto any2 = [&] { return convert<T>(length() * random.vector2()); };
  const auto any1 = [&] { return static_cast<T>(random.sign() * length()); };
  CoreInputs<T> in;
  const vec3<double> n = random.unit_vector();
  in.raw_normal = any3();
  in.raw_tangent = any3();
  in.sign = static_cast<T>(random.sign());
  in.tangent = any3();
  in.bitangent = any3();
  in.perturbed = any3();
  in.dp_du = any3();
  in.dp_dv = any3();
  in.gradient = any3();
  in.direction = convert<T>(random.unit_vector());
  in.dn_dx = any3();
  in.dn_dy = any3();
  in.tangent_normal = any3();
  in.xy_normal = convert<T>(0.99 * random.vector2());
  in.dst_dx = any2();
  in.dst_dy = any2();
  in.texture_offset = any2();
  in.size = vec2<T>{static_cast<T>(1 + random.integer(4096)), static_cast<T>(1 + random.integer(4096))};
  in.deriv = any2();
  in.deriv_y = any2();
  in.deriv_z = any2();
  in.dh_duv = any2();
  in.height = any1();
  in.height_x = any1();
  in.height_y = any1();
  in.bump_scale = any1();
  in.scale = any1();
  const auto row = [&] {
    const vec2<T> a = any2();
    const vec2<T> b = any2();
    return vec4<T>{a.x, a.y, b.x, b.y};
  };
  in.texels = {row(), row(), row(), row()};
  in.fraction = convert<T>(random.vector2(0, 1));
  const mat3<double> r = random.rotation();
  in.rotation = {convert<T>(r.x), convert<T>(r.y), convert<T>(r.z)};
  in.matrix = {any3(), any3(), any3()};
  const double w0 = random.uniform(0, 1);
  const double w1 = random.uniform(0, 1 - w0);
  in.weights = convert<T>(vec3<double>{w0, w1, 1 - w0 - w1});

  // A camera `distance` away from the point of the plane under its pixel (x, y).
  const double distance = length();
  const mat3<double> axes = random.rotation();
  const double pixel = 1.0 / 1000;
  const vec2<double> at{random.uniform(0, 1280), random.uniform(0, 720)};
  const vec3<double> ray = (pixel * (at.x - 640)) * axes.x + (pixel * (at.y - 360)) * axes.y + axes.z;
  const double a = 1.01;
  const double b = -a * 0.01 * distance; // near clip at a hundredth of the distance, far beyond
  const vec3<double> eye{0, 0, 0};       // positions are relative to the camera
  const vec3<double> c = -(640 * pixel) * axes.x - (360 * pixel) * axes.y + axes.z;
  in.world_from_screen = {{T(b * pixel * axes.x.x), T(b * pixel * axes.y.x), T(eye.x), T(b * c.x)},
                          {T(b * pixel * axes.x.y), T(b * pixel * axes.y.y), T(eye.y), T(b * c.y)},
                          {T(b * pixel * axes.x.z), T(b * pixel * axes.y.z), T(eye.z), T(b * c.z)},
                          {T(0), T(0), T(1), T(-a)}};
  in.position = convert<T>(distance * ray);
  in.x = static_cast<T>(at.x);
  in.y = static_cast<T>(at.y);
  const vec3<T> dp_dx = any3();
  const vec3<T> dp_dy = any3();
  in.frame = detail::frame_from_unit_normal(convert<T>(n), dp_dx, dp_dy, static_cast<T>(random.sign()));
  if (ranges.zero_chance > 0) {
    auto e = elements(in);
    for (T& value : e)
      if (random.uniform(0, 1) < ranges.zero_chance) value = T(0);
    const CoreInputs<T> zeroed = from_elements(e);
    const CoreInputs<T> whole = in;
    in = zeroed;
    // What the functions require to be unit, a sign or a camera stays so.
    in.frame.normal = random.integer(4) == 0 ? vec3<T>{T(0), T(0), T(0)} : whole.frame.normal;
    in.frame = detail::frame_from_unit_normal(in.frame.normal, in.frame.dp_dx, in.frame.dp_dy,
                                              whole.frame.resolve_sign);
    in.direction = whole.direction;
    in.rotation = whole.rotation;
  }
  return in;
}

} // namespace surfgrad::test
