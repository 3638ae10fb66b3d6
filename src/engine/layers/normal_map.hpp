#pragma once

#include "engine/layers/texture.hpp"

#include <surfgrad/gradient.hpp>

namespace surfgrad::engine {

/// A tangent-space normal map, stored as slopes.
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

/// Surface gradient of a tangent-space normal map at a fragment.
///
/// first_pass   uniform: no resolve came before
/// degenerate   (out) set where the texture coordinate or the vertex frame has collapsed; the
///              gradient is zero there
template <LaneScalar T>
[[nodiscard]] vec3<T> surface_gradient(const NormalMap& layer, const raster::Fragment<T>& fragment,
                                       const Frame<T>& frame, bool first_pass, mask_t<T>& degenerate) {
  const raster::UvFragment<T>& uv = fragment.uvs[static_cast<std::size_t>(layer.texture.slot)];
  TangentFrame<T> basis;
  if (layer.derived) {
    basis = tangent_basis(frame, uv.dst_dx, uv.dst_dy);
  } else {
    basis = mikktspace_basis(fragment.normal, uv.tangent, uv.sign);
    if (!first_pass) basis = rebased_basis(frame, basis);
  }
  // No bitangent either means no tangent or one along the normal.
  const mask_t<T> collapsed = max_abs(basis.bitangent) == T(value_t<T>(0));
  degenerate = degenerate | collapsed;
  const std::array<T, 2> slope = sample<2>(layer.texture, fragment);
  const vec3<T> g =
      from_tbn(along_coordinate(layer.texture, vec2<T>{slope[0], slope[1]}), basis.tangent, basis.bitangent);
  const T zero = T(value_t<T>(0));
  return select<T>(collapsed, vec3<T>{zero, zero, zero}, g);
}

} // namespace surfgrad::engine
