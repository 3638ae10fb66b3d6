#pragma once

#include "image/map.hpp"
#include "image/sampler.hpp"

namespace surfgrad::image {

/// One channel as heights: 0 to 1 for integer files, a float file's values as they are, never clamped.
///
/// channel  0 to 3 for r, g, b, a; one that the image lacks reads as Image::source_of says
/// NaN      and infinite heights become 0; magnitudes beyond a sixteenth of the largest float are
///          brought to it, so that filters do not overflow
[[nodiscard]] Map make_height_map(const Image& image, int channel);

/// Slopes of those heights: (dh/ds, dh/dt), in units of height per whole map, so that an image of a
/// ramp from 0 to 1 has the slope 1 at every resolution and level. Levels average slopes.
///
/// wraps    what adjoins the border texels. A slope is that of the image as it lies: where a coordinate
///          with Wrap::mirror falls on a reflected copy, wrapped_slope turns it over.
/// filter   central differences: (h[i+1] - h[i-1]) / 2 texels, which is the exact derivative of the
///          uniform cubic B-spline of the texels (bicubic.hpp) at every texel centre. Exact for heights
///          that are polynomials of degree 2 in s and t, between texel centres too when sampled with
///          linear filters; a sine of w radians a texel comes out sin(w) / w as steep.
///          With Wrap::repeat the mean slope of the map is 0, as that of any periodic surface.
/// error    half an ulp: computed in double, rounded once; saturates as the heights do
[[nodiscard]] Map make_height_slopes(const Image& image, int channel, Wraps wraps);

/// A slope of an image, sampled at st, as the slope along the texture coordinate. Along an axis whose wrap
/// mirrors it is negated where st lies on a reflected copy; along one that clamps it is 0 beyond the
/// border, where the border's heights are drawn out.
template <LaneScalar T>
[[nodiscard]] vec2<T> wrapped_slope(vec2<T> st, vec2<T> slope, Wraps wraps) {
  const auto along = [](T coordinate, T d, Wrap wrap) {
    const T zero = T(value_t<T>(0));
    const T one = T(value_t<T>(1));
    if (wrap == Wrap::mirror) return select(one < detail::mirror_phase(coordinate), -d, d);
    if (wrap == Wrap::clamp) return select((coordinate < zero) | (one < coordinate), zero, d);
    return d;
  };
  return {along(st.x, slope.x, wraps.s), along(st.y, slope.y, wraps.t)};
}

} // namespace surfgrad::image
