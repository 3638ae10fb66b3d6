#include "conformance/neighbourhood.hpp"

#include <algorithm>
#include <cmath>

namespace surfgrad::test {
namespace {

/// Enough that a decision in three dimensions goes both ways among them.
constexpr int neighbours = 64;
/// Relative: a hundred roundings, so that what a device's few can do is among what the neighbours do.
constexpr double distance = 2e-5;

/// Signs are no measures: a frame's are its last two scalars.
std::size_t measures_of(const Field& field) {
  if (field.name == "sign") return 0;
  return field.kind == "_frame" ? field.count - 2 : field.count;
}

bool is_class(double v) { return v == 0 || v == 1 || v == -1; }

} // namespace

Neighbourhood::Neighbourhood(const Row& row, const ShaderInputs<float>& in) {
  results_.push_back(row.in_float(in));
  Random random(1);
  const auto used = row.used_fields();
  for (int i = 0; i < neighbours; ++i) {
    ShaderInputs<float> beside = in;
    for (const Field* field : used) {
      const std::span<float> values = values_of(beside, *field).first(measures_of(*field));
      for (float& v : values) v = static_cast<float>(v * (1 + random.uniform(-distance, distance)));
    }
    results_.push_back(row.in_float(beside));
  }
}

bool Neighbourhood::has(std::size_t component, double result) const {
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  bool classes = true;
  for (const auto& each : results_) {
    const double v = each[component];
    if (v == result || (std::isnan(v) && std::isnan(result))) return true;
    if (!std::isfinite(v)) continue;
    classes = classes && is_class(v);
    low = std::min(low, v);
    high = std::max(high, v);
  }
  if (classes || !std::isfinite(result)) return false;
  const double margin = 0.5 * (high - low);
  return low - margin <= result && result <= high + margin;
}

} // namespace surfgrad::test
