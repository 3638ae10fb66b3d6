#pragma once

#include "image/sampler.hpp"
#include "render/environment.hpp"
#include "stack/view.hpp"

#include <surfgrad/vec.hpp>

#include <numbers>

namespace surfgrad::render {

/// A plain glazed surface: GGX reflection over a diffuse body. It has no texture, so that all one sees is
/// the normal.
namespace glaze {

inline constexpr double roughness = 0.36; // glossy enough that highlights trace the bumps
inline constexpr double alpha = roughness * roughness;
inline constexpr double f0 = 0.05; // a dielectric
inline constexpr vec3<double> body{0.37, 0.32, 0.28};

/// Schlick's Fresnel factor without f0, of a cosine in [0, 1].
template <LaneScalar T>
[[nodiscard]] T grazing(T cosine) {
  const T m = T(value_t<T>(1)) - cosine;
  const T m2 = m * m;
  return m2 * m2 * m;
}

/// The root in Smith's masking function: sqrt(alpha^2 + (1 - alpha^2) c^2).
template <LaneScalar T>
[[nodiscard]] T smith_root(T c) {
  return sqrt(constant<T>(alpha * alpha) + constant<T>(1 - alpha * alpha) * (c * c));
}

} // namespace glaze

/// The lights around a glazed surface, made ready.
class Shading {
 public:
  /// environment  panorama of the surroundings, or null for the built-in sky. It replaces the default
  ///              sun, too: a sun that the lights name shines all the same.
  Shading(const stack::Lights& lights, const image::Image* environment);

  /// World space, unit; zero where no sun shines.
  [[nodiscard]] vec3<double> to_sun() const { return to_sun_; }
  /// Strength of the sun, and of all else.
  [[nodiscard]] double sun() const { return sun_; }
  [[nodiscard]] double sky() const { return sky_; }
  /// Must not be sampled where sky() is 0.
  [[nodiscard]] const Environment& environment() const { return environment_; }

  /// Share of a white sky that the glaze reflects, seen at a cosine in [0, 1].
  template <LaneScalar T>
  [[nodiscard]] T mirrored(T cos_view) const {
    const T zero = T(value_t<T>(0));
    const T x = cos_view * constant<T>(mirrored_.size - 1);
    const index_t<T> last = image::detail::index_constant<T>(mirrored_.size - 2);
    const index_t<T> truncated = to_index(x);
    const index_t<T> i = select(last < truncated, last, truncated);
    const auto entry = [&](index_t<T> at) {
      using image::float_from_bits; // a pack's is found by its argument
      return float_from_bits<T>(gather(mirrored_, at, zero == zero));
    };
    const T low = entry(i);
    return low + (x - T(i)) * (entry(index_t<T>(i + image::detail::index_constant<T>(1))) - low);
  }

 private:
  Environment environment_{};
  vec3<double> to_sun_{0, 0, 0};
  double sun_ = 0;
  double sky_ = 0;
  Words mirrored_; ///< floats, against the cosine of the view
};

/// Linear radiance towards the viewer.
///
/// normal, to_viewer  unit
/// sunlight           share of the sun that reaches the point, in [0, 1]
/// degenerate         a normal that faces away from the viewer, and a zero vector, is seen edge-on. The
///                    sky in a zero direction is black. Finite for shorter vectors, and for NaN.
/// error              of sunlight, relative: (4 / cos_view + 4 / cos_light + 800 / |to_sun + to_viewer|)
///                    eps. Cosines are off by 1.5 eps; two of them, against the half vector's length and
///                    times 2 / alpha^2 = 120, enter a square
/// source             Walter et al. 2007 (GGX), Heitz 2014 (height-correlated Smith), Schlick 1994
template <LaneScalar T>
[[nodiscard]] vec3<T> shade(const Shading& lights, vec3<T> normal, vec3<T> to_viewer, T sunlight) {
  using namespace glaze;
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const vec3<T> tint{constant<T>(body.x), constant<T>(body.y), constant<T>(body.z)};
  // Maxima replace NaN.
  const T facing = dot(normal, to_viewer);
  const T cos_view = min(max(facing, zero), one);
  const T mirrored = lights.mirrored(cos_view);
  vec3<T> radiance{zero, zero, zero};

  if (lights.sky() > 0) {
    const vec3<T> mirror = (facing + facing) * normal - to_viewer;
    const vec3<T> diffuse = lights.environment().diffuse(normal);
    const vec3<T> scattered{tint.x * diffuse.x, tint.y * diffuse.y, tint.z * diffuse.z};
    radiance = constant<T>(lights.sky()) *
               ((one - mirrored) * scattered + mirrored * lights.environment().specular(mirror));
  }

  if (lights.sun() > 0) {
    const vec3<double> direction = lights.to_sun();
    const vec3<T> to_sun{constant<T>(direction.x), constant<T>(direction.y), constant<T>(direction.z)};
    const T cos_sun = dot(normal, to_sun);
    const T cos_light = max(cos_sun, zero);
    // The half vector is sum / |sum|; its length squared stays in the formulas, so that neither is divided:
    //   cos^2(h) = along^2 / square,  dot(h, v) = |sum| / 2
    const vec3<T> sum = to_sun + to_viewer;
    const T square = max(dot(sum, sum), constant<T>(1e-8)); // the sun right behind: powers stay in range
    const T along = cos_sun + facing;                       // the normal
    const T along2 = min(along * along, square);
    const T half_view = min(constant<T>(0.5) * sqrt(square), one);
    const T fresnel = constant<T>(f0) + constant<T>(1 - f0) * grazing(half_view);
    // Distribution and visibility over one denominator:
    //   D = alpha^2 square^2 / (pi spread^2),  V = 1 / (2 smith)
    const T spread = square - constant<T>(1 - alpha * alpha) * along2;
    const T seen = max(cos_view, constant<T>(1e-4));
    const T smith = cos_light * smith_root(seen) + seen * smith_root(cos_light);
    const T gloss = constant<T>(alpha * alpha / (2 * std::numbers::pi)) * fresnel * (square * square) /
                    (spread * spread * smith);
    const T direct = sunlight * constant<T>(lights.sun()) * cos_light;
    const T matte = constant<T>(1 / std::numbers::pi) * (one - mirrored);
    radiance = radiance + direct * (matte * tint + vec3<T>{gloss, gloss, gloss});
  }
  return radiance;
}

} // namespace surfgrad::render
