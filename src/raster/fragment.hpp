#pragma once

#include <surfgrad/vec.hpp>

#include <array>
#include <span>

namespace surfgrad::raster {

/// Texture coordinates that one fragment can carry: what the layers of a scene use together.
inline constexpr int max_uv_slots = 8;

/// One texture coordinate of a fragment with its vertex tangent space.
template <class T>
struct UvFragment {
  vec2<T> st;             ///< lower-left origin, t up
  vec2<T> dst_dx, dst_dy; ///< change per pixel to the right and upwards
  /// What mip levels are chosen by: dst_dx and dst_dy, but after a parallax correction those from before
  /// it, where the layer says so.
  vec2<T> footprint_dx, footprint_dy;
  vec3<T> tangent; ///< interpolated, not normalised; zero where no layer asked for it
  T sign;          ///< bitangent = sign * cross(normal, tangent)
};

/// A point of a surface as layers see it: interpolated attributes and analytic derivatives by the
/// raster position (x to the right, y up), whether that raster is a screen or a texture.
/// World space; positions are relative to the camera.
template <class T>
struct Fragment {
  vec2<T> raster; ///< where it lies in the raster, in pixels; centres at .5
  vec3<T> position;
  vec3<T> object_position;    ///< object space, before any displacement: where functions of space are sampled
  vec3<T> to_viewer;          ///< unit; zero where nobody looks, as in a bake
  vec3<T> normal;             ///< interpolated, any length
  mask_t<T> normal_is_absent; ///< interpolation gives zero: `normal` is the triangle's own
  vec3<T> dp_dx, dp_dy;
  vec3<T> dn_dx, dn_dy; ///< change of the interpolated normal
  mask_t<T> front_facing;
  int slots = max_uv_slots; ///< how many of the following there are
  std::array<UvFragment<T>, max_uv_slots> uvs;
};

/// Those texture coordinates that a fragment carries.
template <class T>
[[nodiscard]] std::span<UvFragment<T>> coordinates_of(Fragment<T>& fragment) {
  return {fragment.uvs.data(), static_cast<std::size_t>(fragment.slots)};
}

} // namespace surfgrad::raster
