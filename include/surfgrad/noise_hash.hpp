#pragma once

/// The integer lattice under the noise functions: cells, and a hash of their indices.

#include <surfgrad/vec.hpp>

namespace surfgrad {

/// Coordinates of noise beyond this magnitude are taken as this: cell indices, those of neighbours
/// and the skewed ones of simplex noise (up to twice as large) then stay within int32.
inline constexpr int noise_extent = 1 << 29;

namespace detail {

/// A small integer in every index lane. The scalar concept only has conversions from T; lanes that are made
/// from a number save them.
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr index_t<T> index_constant(int i) {
  if constexpr (std::constructible_from<index_t<T>, std::int32_t>)
    return index_t<T>(static_cast<std::int32_t>(i));
  else
    return to_index(T(static_cast<value_t<T>>(i)));
}

/// A word in every lane: by conversions exact for 16 bits at a time.
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bits_t<T> bits_constant(std::uint32_t word) {
  if constexpr (std::constructible_from<bits_t<T>, std::uint32_t>) return bits_t<T>(word);
  const bits_t<T> high = bits_t<T>(index_constant<T>(static_cast<int>(word >> 16)));
  const bits_t<T> low = bits_t<T>(index_constant<T>(static_cast<int>(word & 0xffffu)));
  return (high << 16) + low;
}

/// `count` bits from position `first` up, as a number.
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T bit_field(bits_t<T> word, int first, int count) {
  return T(index_t<T>((word << (32 - first - count)) >> (32 - count)));
}

/// The coordinate that noise uses: within +-noise_extent, NaN as -noise_extent.
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> saturate_to_lattice(vec3<T> p) {
  const T extent = T(static_cast<value_t<T>>(noise_extent));
  return {min(max(p.x, -extent), extent), min(max(p.y, -extent), extent), min(max(p.z, -extent), extent)};
}

/// Unit cell of a point.
template <class T>
struct LatticeCell {
  index_t<T> x, y, z; ///< lower corner
  vec3<T> fraction;   ///< position in the cell, each component in [0, 1]
};

template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE LatticeCell<T> lattice_cell(vec3<T> p) {
  const vec3<T> q = saturate_to_lattice(p);
  const vec3<T> low{floor(q.x), floor(q.y), floor(q.z)};
  return {to_index(low.x), to_index(low.y), to_index(low.z), q - low};
}

// The odd multipliers by which lattice_hash sums a cell's indices.
inline constexpr std::uint32_t lattice_x = 0x5cdbcce3u;
inline constexpr std::uint32_t lattice_y = 0x456e33c9u;
inline constexpr std::uint32_t lattice_z = 0xe1392b77u;

template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bits_t<T> lattice_sum(index_t<T> x, index_t<T> y, index_t<T> z) {
  return bits_t<T>(x) * bits_constant<T>(lattice_x) + bits_t<T>(y) * bits_constant<T>(lattice_y) +
         bits_t<T>(z) * bits_constant<T>(lattice_z);
}

template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bits_t<T> finalised(bits_t<T> h) {
  h = (h ^ (h >> 16)) * bits_constant<T>(0x7feb352du);
  h = (h ^ (h >> 15)) * bits_constant<T>(0x846ca68bu);
  return h ^ (h >> 16);
}

} // namespace detail

/// 32 well mixed bits for a point of the integer lattice.
///
/// returns     a function of the three indices alone, the same on every machine: integer arithmetic
///             modulo 2^32, no table. fract(sin()) differs between processors and repeats visibly.
/// degenerate  none: every index has its bits, (0, 0, 0) the bits 0
/// error       none
/// source      own sum of the indices; finaliser: C. Wellons, lowbias32
/// quality     The indices are summed with odd multipliers, found by search: two lattice points with equal
///             sums lie at least 1749 cells apart (no choice of multipliers exceeds about 1820), whereas a
///             table of 256 entries repeats along each axis. A finaliser of two multiplications and three
///             shifts, a bijection, then lets every input bit change every output bit with a probability of
///             1/2 to about 0.1 %, so that low bits may be used as they are.
template <LaneScalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bits_t<T> lattice_hash(index_t<T> x, index_t<T> y,
                                                                    index_t<T> z) {
  return detail::finalised<T>(detail::lattice_sum<T>(x, y, z));
}

/// lattice_hash as an object: the default for noise functions whose hash can be exchanged.
template <LaneScalar T>
struct LatticeHash {
  [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bits_t<T> operator()(index_t<T> x, index_t<T> y,
                                                                    index_t<T> z) const {
    return lattice_hash<T>(x, y, z);
  }
};

/// lattice_hash counted from another cell: noise sampled near it is exact however far away that cell is.
template <LaneScalar T>
struct MovedLatticeHash {
  std::uint32_t start = 0; ///< lattice_start of the cell

  [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr bits_t<T> operator()(index_t<T> x, index_t<T> y,
                                                                    index_t<T> z) const {
    return detail::finalised<T>(detail::lattice_sum<T>(x, y, z) + detail::bits_constant<T>(start));
  }
};

/// What MovedLatticeHash starts from at a cell.
///
/// x, y, z     index of the cell, modulo 2^32: lattice_hash sums indices, so they may be added at any time
/// degenerate  none
/// error       none
/// source      own
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr std::uint32_t lattice_start(std::uint32_t x, std::uint32_t y,
                                                                         std::uint32_t z) {
  return x * detail::lattice_x + y * detail::lattice_y + z * detail::lattice_z;
}

} // namespace surfgrad
