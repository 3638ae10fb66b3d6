#pragma once

#include "engine/layers/influence.hpp"

#include <surfgrad/gradient.hpp>

namespace surfgrad::engine {

/// A tangent-space normal map or a derivative map: both are stored as slopes.
struct NormalMap {
  Influence influence{};
  Texture texture{};
  bool derived = false; ///< tangent frame from the texture coordinate, else the vertex frame
};

/// The vertex frame for a later pass: its tangent turned into the plane of the new base normal, its
/// bitangent kept on its own side; zero vectors where the tangent lies along the normal to rounding. In
/// the first pass the frame is used as MikkTSpace defines it.
template <Scalar T>
[[nodiscard]] TangentFrame<T> rebased_basis(const Frame<T>& frame, const TangentFrame<T>& vertex) {
  const T one = T(value_t<T>(1));
  const T zero = T(value_t<T>(0));
  const vec3<T> along = from_volume_gradient(frame.normal, vertex.tangent);
  // Removing the part along the normal leaves up to 4 eps of rounding, which points anywhere.
  const T rounding = (T(value_t<T>(8)) * T(epsilon_v<T>)) * max_abs(vertex.tangent);
  const vec3<T> tangent = select<T>(rounding < max_abs(along), normalize_or_zero(along), {zero, zero, zero});
  const vec3<T> bitangent = cross(frame.normal, tangent);
  const T side = select(dot(bitangent, vertex.bitangent) < zero, -one, one);
  return {tangent, side * bitangent};
}

/// Tangent frame of a texture coordinate: made in place, or the vertex frame of the pass.
///
/// derived     uniform: from the texture coordinate's derivatives, else from the vertex tangents
/// collapsed   (out) the coordinate or the vertex frame has collapsed: there the frame is zero
template <Scalar T>
[[nodiscard]] TangentFrame<T> frame_of(const Point<T>& point, int slot, bool derived, mask_t<T>& collapsed) {
  const raster::UvFragment<T>& uv = point.fragment.uvs[static_cast<std::size_t>(slot)];
  TangentFrame<T> basis;
  if (derived) {
    basis = tangent_basis(point.frame, uv.dst_dx, uv.dst_dy);
  } else {
    basis = mikktspace_basis(point.fragment.normal, uv.tangent, uv.sign);
    if (!point.first_pass) basis = rebased_basis(point.frame, basis);
  }
  // No bitangent either means no tangent or one along the normal.
  const T zero = T(value_t<T>(0));
  const vec3<T> none{zero, zero, zero};
  collapsed = max_abs(basis.bitangent) == zero;
  return {select<T>(collapsed, none, basis.tangent), select<T>(collapsed, none, basis.bitangent)};
}

/// Surface gradient of a tangent-space normal map or a derivative map at a point.
///
/// degenerate   (out) set where the texture coordinate or the vertex frame has collapsed; the
///              gradient is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const NormalMap& layer, const Point<T>& point, mask_t<T>& degenerate) {
  const vec2<T> slope = sample_slopes(layer.texture, point.fragment); // first: texels take their time to come
  mask_t<T> collapsed;
  const TangentFrame<T> basis = frame_of(point, layer.texture.slot, layer.derived, collapsed);
  degenerate = degenerate | collapsed;
  return from_tbn(along_coordinate(layer.texture.tiled, slope), basis.tangent, basis.bitangent);
}

} // namespace surfgrad::engine
