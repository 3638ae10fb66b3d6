#pragma once

#include "image/map.hpp"
#include "image/sampler.hpp"

#include <surfgrad/power.hpp>

#include <array>
#include <string>
#include <variant>

namespace surfgrad::image {

/// Directions stored over all directions: six square faces of one size, a full pyramid each.
///
/// Faces are numbered +x, -x, +y, -y, +z, -z and lie in their files as OpenGL, Vulkan and Direct3D have
/// them. With the file's right and up (Image keeps the bottom row first):
///
///   face    +x  -x  +y  -y  +z  -z
///   right   -z  +z  +x  +x  +x  -x
///   up      +y  +y  -z  +z  +y  +y
///
/// Every face of every level has a border one texel wide, copied from the faces it adjoins; a corner,
/// which three faces share, is the average of their three texels. So linear filters are continuous over
/// edges and corners without looking at a second face. A level of `map` is the six bordered faces one
/// above the other: size + 2 texels wide, 6 * (size + 2) high, +x lowest.
struct CubeMap {
  Map map{};

  /// Side of a face without its border.
  [[nodiscard]] int size(int level = 0) const { return map.width(level) - 2; }
};

/// Why images make no cube map, in the words of an InputError.
struct CubeFault {
  std::string problem{};
  std::string remedy{};
  int face = -1; ///< which of six images is at fault; -1 for one image of all faces
};

/// Faces larger than this are refused: words of a map are counted by 32-bit integers.
inline constexpr int max_cube_size = 8192;

/// The cube map of six images of directions (code values 0..1 mean -1..1, any length but 0), in the
/// order and orientation of CubeMap. Zero vectors stay zero, and so become those that are not finite.
/// Levels average directions within a face; they are not made unit length again.
///
/// Fails where a face is not square, is larger than max_cube_size, has fewer than three channels
/// besides opacity, or differs in size from the first.
[[nodiscard]] std::variant<CubeMap, CubeFault> make_cube_map(const std::array<const Image*, 6>& faces);

/// The same from one image that holds all faces, the shape telling the layout:
///
///   6:1  +x -x +y -y +z -z      1:6  the same from top to bottom
///
///   4:3     +y                  3:4     +y
///        -x +z +x -z                 -x +z +x
///           -y                          -y
///                                       -z   turned by 180 degrees, as the folded cube has it
///
/// Fails for any other shape, and as for six images.
[[nodiscard]] std::variant<CubeMap, CubeFault> make_cube_map(const Image& image);

/// The cube map of six square maps in the order and orientation of CubeMap: three components, one size and
/// one number of levels. They may hold anything, light for one; it is kept as it is.
[[nodiscard]] CubeMap cube_of_faces(const std::array<Map, 6>& faces);

/// The direction, not of unit length, at a point of a face: st runs from (-1, -1), lower left, to (1, 1).
[[nodiscard]] vec3<double> cube_direction(int face, vec2<double> st);

namespace detail {

/// The face that a direction meets, and where: st in [-1, 1]^2.
template <class T>
struct CubePoint {
  index_t<T> face;
  vec2<T> st;
};

/// d must have a component other than 0. Where two are equally large, x wins over y over z.
template <LaneScalar T>
[[nodiscard]] CubePoint<T> cube_point(vec3<T> d) {
  const vec3<T> a{abs(d.x), abs(d.y), abs(d.z)};
  const mask_t<T> x_major = !((a.x < a.y) | (a.x < a.z));
  const mask_t<T> y_major = !(x_major | (a.y < a.z));
  const T major = select(x_major, d.x, select(y_major, d.y, d.z));
  const mask_t<T> negative = major < T(value_t<T>(0));
  // The table of CubeMap: -y alone has +z up, +x alone has -z to the right, and so on.
  const T z_turned = select(negative, d.z, -d.z);
  const T right = select(x_major, z_turned, select(y_major | !negative, d.x, -d.x));
  const T up = select(y_major, z_turned, d.y);
  const T size = abs(major);
  const auto number = [](int i) { return index_constant<T>(i); };
  const index_t<T> axis = select(x_major, number(0), select(y_major, number(2), number(4)));
  return {index_t<T>(axis + select(negative, number(1), number(0))), {right / size, up / size}};
}

template <LaneScalar T>
[[nodiscard]] std::array<T, 3> sample_cube_level(const Map& map, CubePoint<T> at, index_t<T> level,
                                                 mask_t<T> active) {
  const Level<T> of = levels_of<T>(map, level, active);
  const T half = constant<T>(0.5);
  // Texel i of the face is texel i + 1 of its bordered image; the point lies half a texel or more inside.
  const T size = of.width - constant<T>(2);
  const vec2<T> p{(at.st.x * half + half) * size + half, (at.st.y * half + half) * size + half};
  const vec2<T> low{floor(p.x), floor(p.y)};
  const vec2<T> fraction = p - low;
  const index_t<T> x = to_index(low.x);
  const index_t<T> y = to_index(low.y);
  const index_t<T> face_row = index_t<T>(bits_t<T>(at.face) * bits_t<T>(to_index(of.width)));
  const bits_t<T> lower = word_of<3, T>(of, x, index_t<T>(face_row + y));
  const bits_t<T> row = of.row_texels * bits_t<T>(index_constant<T>(3));
  using Format = Texels<TexelFormat::floats, 3>;
  const TexelPair<3, T> below = Format::pair<T>(map.texels(), lower, active);
  const TexelPair<3, T> above = Format::pair<T>(map.texels(), lower + row, active);
  return mix<3, T>(mix<3, T>(below[0], below[1], fraction.x), mix<3, T>(above[0], above[1], fraction.x),
                   fraction.y);
}

} // namespace detail

/// What a cube map stores in a direction: linear within a level, over its edges too, and between two.
///
/// direction   of any length
/// lod         clamped to the pyramid; NaN reads level 0
/// active      lanes to sample; others give 0
/// returns     three components, not normalised
/// degenerate  a zero direction, and one with a component that is not finite, gives zero
/// error       of unit directions stored in their own place, with h = 2 / size: h^2 / 4 inside a face, as
///             no second derivative of a direction along s or t exceeds 1; h / 4 + h^2 beside edges. A
///             border texel lies on the next face's grid, up to h / 2 along the edge from where this face
///             would have it (h / sqrt(2) in a corner), where directions change by 1 / sqrt(3) of that;
///             it has at most half the weight (a quarter, beside two borders with a quarter each).
template <LaneScalar T>
[[nodiscard]] vec3<T> sample_cube(const CubeMap& cube, vec3<T> direction, T lod, mask_t<T> active) {
  const T zero = T(value_t<T>(0));
  const vec3<T> none = zero * direction; // NaN for what is not finite
  const mask_t<T> valid =
      active & (none.x == zero) & (none.y == zero) & (none.z == zero) & (zero < max_abs(direction));
  const vec3<T> somewhere{zero, zero, T(value_t<T>(1))};
  const detail::CubePoint<T> at = detail::cube_point(select<T>(valid, direction, somewhere));
  const detail::LevelBlend<T> blend = detail::level_blend(cube.map.level_count, lod, valid);
  const std::array<T, 3> value = detail::between_levels<3, T>(blend, [&](int k) {
    const index_t<T> level = index_t<T>(blend.level + detail::index_constant<T>(k));
    return detail::sample_cube_level<T>(cube.map, at, level, k == 0 ? valid : blend.between);
  });
  return {value[0], value[1], value[2]};
}

/// Mip level for a direction that changes by these amounts per pixel: log2 of the angle it sweeps, in
/// texels of the size that the map has in that direction.
///
/// A face's texels cover the least angle towards the corners. Their size is taken as the square root of
/// their solid angle, (2 / n)^2 / r^3 with r = |d| / max(|d.x|, |d.y|, |d.z|): the same on both sides of an
/// edge, where derivatives of the face's own coordinates would step by up to half a level. Of a texel in a
/// corner, longer one way than the other, that is the geometric mean: either side is within 0.4 levels.
///
/// direction   of any length; only its angle counts, not a change of length
/// returns     may be negative (magnification); the sampler clamps it
/// degenerate  a zero direction or footprint gives a level far below 0; never NaN
template <Scalar T>
[[nodiscard]] T cube_lod(const CubeMap& cube, vec3<T> direction, vec3<T> ddirection_dx,
                         vec3<T> ddirection_dy) {
  const T inverse = reciprocal_or_zero(max_abs(direction));
  const vec3<T> d = inverse * direction;
  // |cross(d, c)| = r^2 * angle; times sqrt(1 / r) and n / 2 that is angle * n / 2 * r^1.5.
  const vec3<T> x = cross(d, inverse * ddirection_dx);
  const vec3<T> y = cross(d, inverse * ddirection_dy);
  const T scale = max(max_abs(x), max_abs(y)); // keeps the squares in range
  const vec3<T> u = reciprocal_or_zero(scale) * x;
  const vec3<T> v = reciprocal_or_zero(scale) * y;
  const T most = max(constant<T>(0.5), max(dot(u, u), dot(v, v)));
  return log2(constant<T>(0.5 * cube.size())) + log2(scale) + constant<T>(0.5) * log2(most) -
         constant<T>(0.25) * log2(max(T(value_t<T>(1)), dot(d, d)));
}

} // namespace surfgrad::image
