#pragma once

/// Arguments for every function that has shader twins: those of the core's tests and what volume functions
/// need besides.

#include "support/core_inputs.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::test {

/// An aggregate of scalars only, like CoreInputs.
template <class T>
struct ShaderInputs {
  CoreInputs<T> core;
  vec3<T> decal_origin; ///< with core.rotation as its axes
  vec3<T> point;        ///< within a decal or just outside
  vec3<T> half_size;
  T half_length, tan_half_angle, range, radius, fade;
  vec3<T> place;      ///< where noise is sampled
  T width;            ///< of a pixel there
  vec2<T> plane;      ///< where hex tiles lie
  vec2<T> height_map; ///< slopes of the height map that is marched
  T turn;
  T exponent;
  T positive;  ///< argument of logarithms and powers
  T alpha;     ///< roughness
  vec2<T> far; ///< x as an exponent of 2, y as an angle in turns
};

template <class T>
inline constexpr std::size_t shader_input_count = sizeof(ShaderInputs<T>) / sizeof(T);

template <class To, class From>
[[nodiscard]] ShaderInputs<To> convert(const ShaderInputs<From>& in) {
  std::array<From, shader_input_count<From>> from;
  static_assert(sizeof(from) == sizeof(in));
  std::memcpy(from.data(), &in, sizeof(in));
  std::array<To, shader_input_count<To>> to;
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<To>(from[i]);
  ShaderInputs<To> result;
  std::memcpy(static_cast<void*>(&result), to.data(), sizeof(result));
  return result;
}

/// A member of ShaderInputs as shaders see it: so many scalars from an offset on.
struct Field {
  std::string_view name; ///< in a row's call: $name
  std::string_view kind; ///< 1, 2, 3, _mat3, _mat4 or _frame: how a harness's in... reads it
  std::size_t offset;    ///< in scalars
  std::size_t count;
};
[[nodiscard]] const std::vector<Field>& fields();
/// throws  std::out_of_range for a name that no field has
[[nodiscard]] const Field& field(std::string_view name);

[[nodiscard]] ShaderInputs<float> random_shader_inputs(Random& random);

/// The scalars of a field.
[[nodiscard]] std::span<float> values_of(ShaderInputs<float>& in, const Field& field);

/// Where a case of the edge table belongs.
enum class Edge {
  ordinary, ///< zeros, units, mirrored, collapsed, facing away: results agree
  extreme,  ///< beyond the magnitudes that shaders promise results for: finite where C++ is
  infinite, ///< NaN and Inf
};
struct EdgeCase {
  ShaderInputs<float> in{};
  Edge edge = Edge::ordinary;
  std::string what{};
};

/// Every field of `used` at zero, at units, mirrored, parallel to another, tiny, huge and NaN, in turn.
[[nodiscard]] std::vector<EdgeCase> edge_cases(const std::vector<const Field*>& used);

} // namespace surfgrad::test
