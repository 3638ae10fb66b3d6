#pragma once

/// The table of what shaders must give: one row a function (or overload, or mode of it).

#include "conformance/inputs.hpp"

#include <functional>
#include <string>
#include <vector>

namespace surfgrad::test {

/// What becomes of NaN and Inf. max, min and clamp may return either operand where one is NaN, and nothing
/// else is promised: a row says so where that shows.
enum class NanPolicy {
  kept,       ///< NaN where the core gives NaN; a number where it gives one
  may_vanish, ///< also a number where the core gives NaN: the function clamps
};

struct Row {
  std::string name;
  /// One statement in the words that the three languages share (their harness files define put...): the
  /// library's functions by their GLSL names, inputs as $name.
  std::string call;

  std::function<std::vector<double>(const ShaderInputs<float>&)> in_float;   ///< the C++ core
  std::function<std::vector<double>(const ShaderInputs<double>&)> in_double; ///< the truth
  NanPolicy nan = NanPolicy::kept;
  /// Products of vectors overflow between the lengths that shaders are made for, up to 1e18, and the largest.
  bool overflows = false;
  /// How far a shader may be from the truth, in eps, component by component.
  std::function<std::vector<double>(const ShaderInputs<double>&)> bound;

  [[nodiscard]] std::vector<const Field*> used_fields() const;
};

/// Most results of a row.
inline constexpr std::size_t row_results = 16;

/// The documented bounds count roundings of half a unit in the last place. Vulkan lets a division err by
/// 2.5 units and an inverse square root by 2 (Vulkan 1.3, "Precision and Operation of SPIR-V Instructions"):
/// five times as much.
inline constexpr double vulkan_rounding = 5;

[[nodiscard]] const std::vector<Row>& rows();

// Parts of rows().
void add_listing_rows(std::vector<Row>& rows);
void add_shape_rows(std::vector<Row>& rows);
void add_noise_rows(std::vector<Row>& rows);

/// A row's call for WGSL, which neither overloads nor leaves arguments out.
[[nodiscard]] std::string wgsl_call(const Row& row);

/// Vulkan's own errors of the functions that it does not round correctly, in eps.
[[nodiscard]] double vulkan_log2_error(double log2_of_a);
/// Relative.
[[nodiscard]] double vulkan_exp2_error(double exponent);
[[nodiscard]] double vulkan_pow_error(double a, double k);

template <class Call, class Bound>
[[nodiscard]] Row make_row(std::string name, std::string shader_call, Call call, Bound bound) {
  Row row;
  row.name = std::move(name);
  row.call = std::move(shader_call);
  row.in_float = [call](const ShaderInputs<float>& in) {
    const auto result = call(in);
    return std::vector<double>(result.begin(), result.end());
  };
  row.in_double = [call](const ShaderInputs<double>& in) {
    const auto result = call(in);
    return std::vector<double>(result.begin(), result.end());
  };
  row.bound = [bound](const ShaderInputs<double>& in) {
    const auto result = bound(in);
    return std::vector<double>(result.begin(), result.end());
  };
  return row;
}

} // namespace surfgrad::test
