/// Every function of the shader libraries gives what the C++ core gives, within its bound, on a Vulkan
/// device: for random arguments and for the edge table.

#include "conformance/device_rows.hpp"
#include "conformance/neighbourhood.hpp"
#include "conformance/open_results.hpp"
#include "support/worst.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace surfgrad::test {
namespace {

constexpr std::size_t random_cases = 1024;

INSTANTIATE_TEST_SUITE_P(Languages, Conformance, ::testing::ValuesIn(languages),
                         [](const auto& each) { return name_of(each.param); });

double largest(const std::vector<double>& results) {
  double size = 0;
  for (const double r : results) size = std::max(size, std::abs(r));
  return size;
}

/// Whether a bound, in eps, tells results of this size from others: to first order it holds below 1/100.
bool is_telling(double bound, double size) { return bound == 0 || bound * eps <= 0.01 * size; }

/// Compares a case's results; those without a telling bound with the neighbours', and counts these.
long compare(const Job& job, std::size_t i, Worst& worst) {
  const Row& row = *job.row;
  const ShaderInputs<double> exact = convert<double>(job.cases[i]);
  const auto expected = row.in_double(exact);
  const auto bounds = row.device_bound(exact);
  EXPECT_EQ(expected.size(), bounds.size()) << row.name;
  EXPECT_LE(expected.size(), row_results) << row.name;
  const double size = largest(expected);
  std::optional<Neighbourhood> neighbours;
  long near = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    // Nothing but zeros, as outside a decal, is exact.
    const double bound = size == 0 && bounds[k] < undecided ? 0 : bounds[k];
    if (is_telling(bound, size)) {
      // The second order may add a thousandth; subnormal numbers may become zero.
      constexpr double smallest = std::numeric_limits<float>::min();
      worst.add(job.result(i, k), expected[k], 1.001 * eps * bound + smallest, static_cast<long>(i));
      continue;
    }
    ++near;
    if (!neighbours) neighbours.emplace(row, job.cases[i]);
    EXPECT_TRUE(neighbours->has(k, job.result(i, k)))
        << row.name << ", case " << i << ", component " << k << ": got " << job.result(i, k) << ", expected "
        << expected[k] << " or what is near";
  }
  return near;
}

TEST_P(Conformance, RandomArgumentsGiveTheCoresResults) {
  Random random(seed);
  std::vector<ShaderInputs<float>> cases;
  for (std::size_t i = 0; i < random_cases; ++i) cases.push_back(random_shader_inputs(random));
  std::vector<Job> jobs;
  for (const Row& row : rows()) jobs.push_back({&row, cases});
  run(GetParam(), jobs);
  std::printf("  seed %d\n", static_cast<int>(seed));
  for (const Job& job : jobs) {
    const Row& row = *job.row;
    long near = 0;
    {
      Worst worst(row.name);
      for (std::size_t i = 0; i < cases.size(); ++i) near += compare(job, i, worst);
    }
    if (near == 0) continue;
    const double share =
        static_cast<double>(near) / static_cast<double>(cases.size() * row.in_float(cases[0]).size());
    std::printf("    and %ld among those of their neighbours (%.4f)\n", near, share);
    EXPECT_LE(share, open_results(row).ill_conditioned)
        << row.name << ": too many results have no telling bound";
  }
}

enum class Class { finite, infinite, nan };
Class class_of(double v) {
  if (std::isnan(v)) return Class::nan;
  return std::isinf(v) ? Class::infinite : Class::finite;
}

/// Subnormal numbers as zero, which shaders may take them for.
ShaderInputs<float> flushed(ShaderInputs<float> in) {
  for (const Field& each : fields())
    for (float& v : values_of(in, each))
      if (std::abs(v) < std::numeric_limits<float>::min()) v = std::copysign(0.0f, v);
  return in;
}

/// What a case of the edge table has to give.
class Expectation {
 public:
  Expectation(const Row& row, const ShaderInputs<float>& in)
      : row_(row), in_(in), expected_(row.in_float(in)), bounds_(row.device_bound(convert<double>(in))) {
    for (const double e : expected_)
      if (std::isfinite(e)) size_ = std::max(size_, std::abs(e));
  }

  [[nodiscard]] const std::vector<double>& expected() const { return expected_; }

  /// Within the bound, the core's own error included; results of whole numbers, whose bound is often zero,
  /// within a few roundings of the largest. By class where that is NaN or Inf.
  [[nodiscard]] bool is_met(std::size_t k, double got) const {
    const double e = expected_[k];
    if (class_of(e) != Class::finite) return class_of(got) == class_of(e);
    if (got == e) return true;
    constexpr double few = 8;
    const double bound = std::max(2 * (std::isfinite(bounds_[k]) ? bounds_[k] : 0), few * size_);
    return is_telling(bound, size_) &&
           std::abs(got - e) <= eps * bound + static_cast<double>(std::numeric_limits<float>::min());
  }
  [[nodiscard]] bool is_near(std::size_t k, double got) {
    if (!neighbours_) neighbours_.emplace(row_, in_);
    return neighbours_->has(k, got);
  }

 private:
  const Row& row_;
  const ShaderInputs<float>& in_;
  std::vector<double> expected_, bounds_;
  double size_ = 0;
  std::optional<Neighbourhood> neighbours_{};
};

/// A finite component beyond what the function's results can be. A vector that is NaN elsewhere has no
/// length.
bool is_larger_than_any(const Job& job, std::size_t i, std::size_t k) {
  const std::size_t components = job.row->in_float(job.cases[i]).size();
  for (std::size_t c = 0; c < components; ++c)
    if (!std::isfinite(job.result(i, c))) return false;
  return std::abs(job.result(i, k)) > open_results(*job.row).largest * (1 + 8 * eps);
}

TEST_P(Conformance, TheEdgeTableGivesTheCoresResults) {
  std::vector<Job> jobs;
  std::vector<std::vector<EdgeCase>> edges;
  for (const Row& row : rows()) {
    edges.push_back(edge_cases(row.used_fields()));
    jobs.push_back({&row});
    for (const EdgeCase& each : edges.back()) jobs.back().cases.push_back(each.in);
  }
  run(GetParam(), jobs);
  OpenCounts all{};
  long met = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const Row& row = *jobs[j].row;
    OpenCounts open{};
    for (std::size_t i = 0; i < edges[j].size(); ++i) {
      const EdgeCase& edge = edges[j][i];
      Expectation expectation(row, edge.in);
      const ShaderInputs<float> without_subnormals = flushed(edge.in);
      Expectation of_flushed(row, without_subnormals);
      for (std::size_t k = 0; k < expectation.expected().size(); ++k) {
        const double got = jobs[j].result(i, k);
        const double expected = expectation.expected()[k];
        const auto failure = [&](const char* why) {
          ADD_FAILURE() << row.name << ", " << edge.what << ", component " << k << ": got " << got
                        << ", expected " << expected << ": " << why;
        };
        if (expectation.is_met(k, got) || of_flushed.is_met(k, got)) {
          ++met;
        } else if (class_of(got) == class_of(expected) &&
                   (expectation.is_near(k, got) || of_flushed.is_near(k, got))) {
          ++open.near;
        } else if (edge.edge == Edge::ordinary) {
          failure("beyond the bound and all neighbours");
        } else if (is_larger_than_any(jobs[j], i, k)) {
          failure("larger than any result of the function");
        } else if (class_of(expected) != Class::finite) {
          if (edge.edge == Edge::infinite && row.nan == NanPolicy::kept) failure("of another class");
          ++open.vanished;
        } else if (class_of(got) == Class::finite) {
          ++open.magnitude;
        } else {
          if (!row.overflows) failure("not finite");
          ++open.overflown;
        }
      }
    }
    const OpenCounts most = open_results(row).edges;
    if (open != OpenCounts{})
      std::printf("  open of %s: near %ld, magnitude %ld, vanished %ld, overflown %ld\n", row.name.c_str(),
                  open.near, open.magnitude, open.vanished, open.overflown);
    EXPECT_TRUE(open.near <= most.near && open.magnitude <= most.magnitude &&
                open.vanished <= most.vanished && open.overflown <= most.overflown)
        << row.name << ": more results are open than open_results.cpp states";
    all.near += open.near;
    all.magnitude += open.magnitude;
    all.vanished += open.vanished;
    all.overflown += open.overflown;
  }
  std::printf(
      "  %ld results as expected, %ld among their neighbours; open: %ld finite beyond the magnitudes that "
      "shaders promise, %ld numbers for NaN or Inf, %ld overflown\n",
      met, all.near, all.magnitude, all.vanished, all.overflown);
}

} // namespace
} // namespace surfgrad::test
