#pragma once

/// Parallax occlusion mapping: the first crossing of a ray with a height map (section 2.6).

#include <surfgrad/vec.hpp>

namespace surfgrad {

template <class T>
struct ParallaxHit {
  vec2<T> texture_coordinate; ///< where the ray meets the map
  T height;                   ///< of the crossing, in [0, 1]
  mask_t<T> hit;
};

/// Halvings of the step that holds the crossing. At a jump of the map, where the final interpolation
/// cannot help, the error is a whole bracket: 1 / (8 * 2^6) is below half a level of an 8-bit map
/// (1/510) from 8 steps on.
inline constexpr int parallax_refinements = 6;

/// Finer steps are below the resolution of heights near 1 in float by the time they are refined:
/// 2^-18 / 2^6 = eps / 2.
inline constexpr int parallax_most_steps = 1 << 18;

/// First crossing of a ray with a height map, coming from height 1 down to 0.
///
/// height_at   (vec2<T> uv, T lod, mask_t<T> active) -> T: height in [0, 1]; what it gives for lanes
///             outside `active` is not used. lod is relative to the level the caller chose and always 0:
///             a search on a coarser level would find the crossing of another surface, outside whose
///             bracket the refinement is lost. Take the level from the coordinate before correction
///             (texture_lod).
/// st          texture coordinate of the fragment, where the ray reaches height 0
/// dst         project_to_texture_space towards the viewer: at height h the ray is over st + h * dst
/// step_limit  uniform; steps of the search, taken within [1, parallax_most_steps]. A feature narrower than
/// |dst| / step_limit
///             can be stepped over.
/// returns     first height h, searched downwards, where the map reaches the ray, and st + h * dst
/// degenerate  no crossing (every height below the ray: negative or NaN): hit false, height 0, st
///             unchanged. Heights of 1 and more at the top: height 1. NaN heights lie below every ray.
///             Zero dst gives the height at st.
/// error       height, against the map's first crossing within the step found: 1 / (64 * step_limit) at a
///             jump; where the map is straight along the ray over the last bracket, 4 eps / the rate at
///             which ray and map approach (height a unit of ray height)
/// source      Mikkelsen 2019, section 2.6; linear search, bisection and one interpolation
template <Scalar T, class HeightAt>
[[nodiscard]] SURFGRAD_HOST_DEVICE ParallaxHit<T> march_parallax(HeightAt height_at, vec2<T> st, vec2<T> dst,
                                                                 int step_limit) {
  const T zero = T(value_t<T>(0));
  const T one = T(value_t<T>(1));
  const int steps = step_limit < 1 ? 1 : step_limit < parallax_most_steps ? step_limit : parallax_most_steps;
  // Height of the map above the ray. The bounds, outside the range of heights, keep Inf and NaN out of
  // the interpolation; NaN takes the lower.
  const auto clearance = [&](T ray, mask_t<T> active) {
    const T h = height_at(st + ray * dst, zero, active);
    return min(max(h, -one), constant<T>(2)) - ray;
  };

  mask_t<T> searching = zero == zero;
  // The bracket: the ray is above the map at `upper`, at or below it at `lower`.
  T upper = one, lower = one;
  T upper_clearance = zero, lower_clearance = zero;
  for (int i = 0; i <= steps && any(searching); ++i) {
    const T ray = T(static_cast<value_t<T>>(steps - i) / static_cast<value_t<T>>(steps));
    const T c = clearance(ray, searching);
    const mask_t<T> crossed = !(c < zero);
    lower = select(searching, ray, lower);
    lower_clearance = select(searching, c, lower_clearance);
    searching = searching & !crossed;
    upper = select(searching, ray, upper);
    upper_clearance = select(searching, c, upper_clearance);
  }
  const mask_t<T> hit = !searching;
  if (any(hit)) {
    for (int i = 0; i < parallax_refinements; ++i) {
      const T middle = constant<T>(0.5) * (upper + lower);
      const T c = clearance(middle, hit);
      const mask_t<T> above = c < zero;
      upper = select(above, middle, upper);
      upper_clearance = select(above, c, upper_clearance);
      lower = select(above, lower, middle);
      lower_clearance = select(above, lower_clearance, c);
    }
  }
  // Where the straight line through the bracket's ends meets the ray; the ends of a crossing at the top
  // coincide and leave no line.
  const T share = upper_clearance * reciprocal_or_zero(upper_clearance - lower_clearance);
  const T height = select(hit, upper + share * (lower - upper), zero);
  return {select<T>(hit, st + height * dst, st), height, hit};
}

} // namespace surfgrad
