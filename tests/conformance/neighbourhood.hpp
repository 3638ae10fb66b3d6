#pragma once

/// What a function may give where its bound says nothing, because rounding decides between two answers or
/// what is left of cancelling terms is mostly rounding: what the core gives near by.

#include "conformance/rows.hpp"

#include <vector>

namespace surfgrad::test {

class Neighbourhood {
 public:
  Neighbourhood(const Row& row, const ShaderInputs<float>& in);

  /// Whether a result lies among those of the neighbours: where these are only signs, flags and zeros, it
  /// must be one of them. NaN and Inf where a neighbour gives the same.
  [[nodiscard]] bool has(std::size_t component, double result) const;

 private:
  std::vector<std::vector<double>> results_; ///< [neighbour][component]
};

} // namespace surfgrad::test
