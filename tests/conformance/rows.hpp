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

/// The operations on the way to a row's result that Vulkan rounds more loosely than C++ (Vulkan 1.3,
/// "Precision and Operation of SPIR-V Instructions"), and how many eps the documented bound counts there:
/// both figures together give the device's bound. An operation whose error cancels is not counted.
struct Looseness {
  double roundings = 1;  ///< eps of the documented bound, relative to the terms that it names
  int divisions = 0;     ///< 2.5 units in the last place in place of 1/2
  int inverse_roots = 0; ///< 2 in place of the 1/2 each of a root and a division
  int roots = 0;         ///< 4.5, those of an inverse root and a division, in place of 1/2

  [[nodiscard]] double factor() const { return 1 + (2 * divisions + inverse_roots + 4 * roots) / roundings; }
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
  /// How far the C++ core may be from the truth, in eps, component by component: the documented bound.
  std::function<std::vector<double>(const ShaderInputs<double>&)> bound;
  /// How often that holds on a device, which may round divisions and roots more loosely: at least once.
  Looseness looseness{};
  /// What a device's powers and logarithms add, in eps; empty where nothing.
  std::function<std::vector<double>(const ShaderInputs<double>&)> of_powers{};

  [[nodiscard]] std::vector<const Field*> used_fields() const;
  /// How far a shader may be from the truth, in eps.
  [[nodiscard]] std::vector<double> device_bound(const ShaderInputs<double>& in) const;
};

/// Most results of a row.
inline constexpr std::size_t row_results = 16;

/// A bound that says nothing: a decision that rounding makes.
inline constexpr double undecided = 1e30;

/// Functions as compute shaders run them.
[[nodiscard]] const std::vector<Row>& rows();
/// Functions that take derivatives across pixels. Inputs are those of a pixel: $position and $plane differ
/// from the neighbours' by the frame's dp_dx and dp_dy, and by dst_dx and dst_dy.
[[nodiscard]] const std::vector<Row>& fragment_rows();

// Parts of rows().
void add_listing_rows(std::vector<Row>& rows);
void add_shape_rows(std::vector<Row>& rows);
void add_noise_rows(std::vector<Row>& rows);
/// States each row's looseness (looseness.cpp).
void loosen(std::vector<Row>& rows);

/// A row's call for WGSL, which neither overloads nor leaves arguments out.
[[nodiscard]] std::string wgsl_call(const Row& row);
/// The name of an overload in WGSL, by its signature "name(type, type)"; empty for one that leaves out what
/// WGSL's callers write.
[[nodiscard]] std::string wgsl_name(const std::string& signature);

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
