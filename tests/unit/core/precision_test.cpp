/// Float against double: every function keeps the error bound that its doc comment states.

#include "support/core_functions.hpp"
#include "support/worst.hpp"

namespace surfgrad::test {
namespace {

// The documented bounds hold to first order in eps; the second order may add this share.
constexpr double second_order = 1.001;

TEST(Precision, FloatKeepsTheDocumentedBounds) {
  for_each_core_function([](const char* name, int, auto call, auto bound) {
    Random random(32);
    Worst worst(name);
    for (long i = 0; i < 20000; ++i) {
      const CoreInputs<float> in = random_inputs<float>(random);
      const CoreInputs<double> exact = convert<double>(in); // the same numbers: no error of input
      const auto got = call(in);
      const auto expected = call(exact);
      const auto bounds = bound(exact);
      // Beyond 1 / 100 eps a bound to first order says nothing, and degenerate clamps set in.
      constexpr double eps = epsilon_v<float>;
      double size = 0;
      for (const double e : expected) size = std::max(size, std::abs(e));
      for (std::size_t k = 0; k < got.size(); ++k) {
        if (bounds[k] * eps > 0.01 * size) continue;
        worst.add(static_cast<double>(got[k]), expected[k], second_order * eps * bounds[k], i);
      }
    }
  });
}

} // namespace
} // namespace surfgrad::test
