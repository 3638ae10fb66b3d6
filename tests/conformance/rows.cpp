#include "conformance/rows.hpp"

#include <algorithm>
#include <cmath>

namespace surfgrad::test {

std::vector<const Field*> Row::used_fields() const {
  std::vector<const Field*> used;
  for (std::size_t at = call.find('$'); at != std::string::npos; at = call.find('$', at + 1)) {
    std::size_t end = at + 1;
    while (end < call.size() &&
           (std::isalnum(static_cast<unsigned char>(call[end])) != 0 || call[end] == '_'))
      ++end;
    const Field* f = &field(std::string_view(call).substr(at + 1, end - at - 1));
    if (std::find(used.begin(), used.end(), f) == used.end()) used.push_back(f);
  }
  return used;
}

std::vector<double> Row::device_bound(const ShaderInputs<double>& in) const {
  std::vector<double> eps = bound(in);
  for (double& each : eps) each = std::min(looseness.factor() * each, undecided);
  if (!of_powers) return eps;
  const std::vector<double> more = of_powers(in);
  for (std::size_t i = 0; i < eps.size(); ++i) eps[i] += more[i];
  return eps;
}

// log2: 3 units beyond [0.5, 2], 2^-21 (4 eps) absolute within.
double vulkan_log2_error(double log2_of_a) { return 4 * std::max(1.0, std::abs(log2_of_a)); }

// exp2: 3 + 2 |x| units; the exponent itself has been rounded.
double vulkan_exp2_error(double exponent) { return 3 + 3 * std::abs(exponent); }

double vulkan_pow_error(double a, double k) {
  if (!(a > 0)) return 0;
  const double l = std::log2(a);
  constexpr double ln2 = 0.693147180559945309;
  return vulkan_exp2_error(k * l) + ln2 * std::abs(k) * vulkan_log2_error(l);
}

const std::vector<Row>& rows() {
  static const std::vector<Row> all = [] {
    std::vector<Row> made;
    add_listing_rows(made);
    add_shape_rows(made);
    add_noise_rows(made);
    loosen(made);
    return made;
  }();
  return all;
}

} // namespace surfgrad::test
