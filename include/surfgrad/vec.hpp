#pragma once

/// Vectors and matrices: aggregates of scalars. Matrices are row-major and multiply column vectors.

#include <surfgrad/scalar.hpp>

namespace surfgrad {

template <class T>
struct vec2 {
  T x, y;
};
template <class T>
struct vec3 {
  T x, y, z;
};
template <class T>
struct vec4 {
  T x, y, z, w;
};

/// Rows x, y, z.
template <class T>
struct mat3 {
  vec3<T> x, y, z;
};
/// Rows x, y, z, w.
template <class T>
struct mat4 {
  vec4<T> x, y, z, w;
};

// clang-format off
template <class T> SURFGRAD_HOST_DEVICE constexpr vec2<T> operator+(vec2<T> a, vec2<T> b) { return {a.x + b.x, a.y + b.y}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec2<T> operator-(vec2<T> a, vec2<T> b) { return {a.x - b.x, a.y - b.y}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec2<T> operator-(vec2<T> a) { return {-a.x, -a.y}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec2<T> operator*(T s, vec2<T> a) { return {s * a.x, s * a.y}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec2<T> operator*(vec2<T> a, T s) { return {a.x * s, a.y * s}; }
/// Component by component.
template <class T> SURFGRAD_HOST_DEVICE constexpr vec2<T> operator*(vec2<T> a, vec2<T> b) { return {a.x * b.x, a.y * b.y}; }

template <class T> SURFGRAD_HOST_DEVICE constexpr vec3<T> operator+(vec3<T> a, vec3<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec3<T> operator-(vec3<T> a, vec3<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec3<T> operator-(vec3<T> a) { return {-a.x, -a.y, -a.z}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec3<T> operator*(T s, vec3<T> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec3<T> operator*(vec3<T> a, T s) { return {a.x * s, a.y * s, a.z * s}; }

template <class T> SURFGRAD_HOST_DEVICE constexpr vec4<T> operator+(vec4<T> a, vec4<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec4<T> operator*(T s, vec4<T> a) { return {s * a.x, s * a.y, s * a.z, s * a.w}; }

template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T dot(vec2<T> a, vec2<T> b) { return a.x * b.x + a.y * b.y; }
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T dot(vec3<T> a, vec3<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T dot(vec4<T> a, vec4<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
/// Signed area spanned by a and b; exactly antisymmetric.
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T cross(vec2<T> a, vec2<T> b) { return a.x * b.y - a.y * b.x; }
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> cross(vec3<T> a, vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T> SURFGRAD_HOST_DEVICE constexpr vec3<T> operator*(const mat3<T>& m, vec3<T> v) { return {dot(m.x, v), dot(m.y, v), dot(m.z, v)}; }
template <class T> SURFGRAD_HOST_DEVICE constexpr vec4<T> operator*(const mat4<T>& m, vec4<T> v) { return {dot(m.x, v), dot(m.y, v), dot(m.z, v), dot(m.w, v)}; }
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr mat3<T> transpose(const mat3<T>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr mat4<T> transpose(const mat4<T>& m) {
  return {{m.x.x, m.y.x, m.z.x, m.w.x}, {m.x.y, m.y.y, m.z.y, m.w.y}, {m.x.z, m.y.z, m.z.z, m.w.z}, {m.x.w, m.y.w, m.z.w, m.w.w}};
}
template <class T> SURFGRAD_HOST_DEVICE constexpr mat3<T> operator*(const mat3<T>& a, const mat3<T>& b) {
  const mat3<T> c = transpose(b);
  return {{dot(a.x, c.x), dot(a.x, c.y), dot(a.x, c.z)}, {dot(a.y, c.x), dot(a.y, c.y), dot(a.y, c.z)}, {dot(a.z, c.x), dot(a.z, c.y), dot(a.z, c.z)}};
}
template <class T> SURFGRAD_HOST_DEVICE constexpr mat4<T> operator*(const mat4<T>& a, const mat4<T>& b) {
  const mat4<T> c = transpose(b);
  return {{dot(a.x, c.x), dot(a.x, c.y), dot(a.x, c.z), dot(a.x, c.w)}, {dot(a.y, c.x), dot(a.y, c.y), dot(a.y, c.z), dot(a.y, c.w)},
          {dot(a.z, c.x), dot(a.z, c.y), dot(a.z, c.z), dot(a.z, c.w)}, {dot(a.w, c.x), dot(a.w, c.y), dot(a.w, c.z), dot(a.w, c.w)}};
}
/// Matrix of the signed 2x2 minors: cof(M) = det(M) * transpose(inverse(M)); defined for singular M too.
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr mat3<T> cofactor(const mat3<T>& m) { return {cross(m.y, m.z), cross(m.z, m.x), cross(m.x, m.y)}; }
template <class T> [[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T determinant(const mat3<T>& m) { return dot(m.x, cross(m.y, m.z)); }
// clang-format on

/// Lane by lane, a where the mask is set, else b.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> select(mask_t<T> m, vec2<T> a, vec2<T> b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y)};
}
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> select(mask_t<T> m, vec3<T> a, vec3<T> b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

/// Largest magnitude of a component: a length that needs no square root and cannot overflow.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T max_abs(vec2<T> v) {
  return max(abs(v.x), abs(v.y));
}
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T max_abs(vec3<T> v) {
  return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

/// Euclidean length. Overflows or underflows where the square of a component does.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE T length(vec3<T> v) {
  return sqrt(dot(v, v));
}
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE T length(vec2<T> v) {
  return sqrt(dot(v, v));
}

/// 1 / a, or 0 where |a| is below the smallest normal number (zero and subnormals).
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T reciprocal_or_zero(T a) {
  const T tiny = T(std::numeric_limits<value_t<T>>::min());
  const mask_t<T> vanishes = abs(a) < tiny;
  return select(vanishes, T(value_t<T>(0)), T(value_t<T>(1)) / select(vanishes, T(value_t<T>(1)), a));
}

/// a within a sixteenth of the largest finite number, so that a few of them can be added: what a result
/// beyond the scalar's range becomes instead of Inf. NaN stays NaN.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr T saturated(T a) {
  const T most = T(std::numeric_limits<value_t<T>>::max() / 16);
  return min(most, max(-most, a)); // the second operand survives a comparison with NaN
}
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec2<T> saturated(vec2<T> v) {
  return {saturated(v.x), saturated(v.y)};
}
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE constexpr vec3<T> saturated(vec3<T> v) {
  return {saturated(v.x), saturated(v.y), saturated(v.z)};
}

namespace detail {

/// Squares of what lies between these, and sums and products of two such squares' roots, stay normal numbers.
template <Scalar T>
inline constexpr value_t<T> least_square = std::numeric_limits<value_t<T>>::min() * value_t<T>(1 << 25);
template <Scalar T>
inline constexpr value_t<T> most_square = 1 / least_square<T>;

/// A vector's direction and the inverse of its length; zero for a vector of subnormal components.
template <class T>
struct Normalized {
  vec3<T> unit;
  T inverse_length;
};

template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE Normalized<T> normalized(vec3<T> v) {
  const T one = T(value_t<T>(1));
  const T square = dot(v, v);
  const mask_t<T> usual = (T(least_square<T>) < square) & (square < T(most_square<T>));
  // Nothing stands between the square and its root, which packs wait for: what comes of an unusual square is
  // not used.
  const T inverse = one / sqrt(square);
  Normalized<T> result{inverse * v, inverse};
  if (!all(usual)) [[unlikely]] {
    // A power of two brings any other into that range, so that no result depends on which way it went.
    constexpr value_t<T> large = 1 / (std::numeric_limits<value_t<T>>::min() * value_t<T>(1ll << 50));
    const T zero = T(value_t<T>(0));
    const T size = max_abs(v);
    const mask_t<T> vanishes = size < T(std::numeric_limits<value_t<T>>::min());
    const T factor = select(vanishes, zero, select(size < one, T(large), T(1 / large)));
    const vec3<T> w = factor * v;
    const T inverse_of_w = one / sqrt(select(vanishes, one, dot(w, w)));
    result.unit = select<T>(usual, result.unit, inverse_of_w * w);
    result.inverse_length = select(usual, result.inverse_length, inverse_of_w * factor);
  }
  return result;
}

} // namespace detail

/// v / |v| for every magnitude, without overflow or underflow on the way.
///
/// degenerate  zero, or a vector of subnormal components, gives zero. NaN propagates; Inf gives NaN.
/// error       3 eps per component.
template <Scalar T>
[[nodiscard]] SURFGRAD_HOST_DEVICE vec3<T> normalize_or_zero(vec3<T> v) {
  return detail::normalized(v).unit;
}

} // namespace surfgrad
