#pragma once

/// Runs the rows of a language on a Vulkan device.

#include "conformance/languages.hpp"
#include "support/vulkan.hpp"

#include <vector>

namespace surfgrad::test {

inline constexpr std::uint64_t seed = 5;
inline constexpr double eps = epsilon_v<float>;

/// A row's arguments, and what the shader made of them: row_results numbers a case.
struct Job {
  const Row* row;
  std::vector<ShaderInputs<float>> cases{};
  std::vector<float> results{};

  [[nodiscard]] double result(std::size_t which, std::size_t component) const {
    return static_cast<double>(results[which * row_results + component]);
  }
};

class Conformance : public VulkanTest, public ::testing::WithParamInterface<Language> {
 protected:
  static void TearDownTestSuite();
  /// Jobs of rows().
  static void run(Language language, std::vector<Job>& jobs);
};

} // namespace surfgrad::test
