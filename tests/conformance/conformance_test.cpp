/// Every function of the shader libraries gives what the C++ core gives, within its bound, on a Vulkan
/// device: for random arguments, for the edge table, and for the arguments of the reference vectors, where
/// it gives what the author's own shaders gave.

#include "conformance/languages.hpp"
#include "gpu/pipeline.hpp"
#include "support/reference_vectors.hpp"
#include "support/vulkan.hpp"
#include "support/worst.hpp"

#include <surfgrad/triplanar.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <span>

namespace surfgrad::test {
namespace {

constexpr std::uint64_t seed = 5;
constexpr std::size_t random_cases = 1024;
constexpr std::size_t lanes = 64; // of a workgroup
constexpr double eps = epsilon_v<float>;

/// Rows that are compiled together: many small shaders repeat the library, one large one is slow to compile.
constexpr std::size_t rows_a_shader = 16;

/// A row's arguments, and what the shader made of them: row_results numbers a case.
struct Job {
  std::size_t row; ///< of rows()
  std::vector<ShaderInputs<float>> cases{};
  std::vector<float> results{};

  [[nodiscard]] const Row& what() const { return rows()[row]; }
  [[nodiscard]] double result(std::size_t which, std::size_t component) const {
    return static_cast<double>(results[which * row_results + component]);
  }
};

/// The pipelines of a language, compiled when a job first needs one.
class Pipelines {
 public:
  explicit Pipelines(Language language) : language_(language) {}

  const gpu::ComputePipeline& of_group(const gpu::Device& device, std::size_t group) {
    auto& pipeline = groups_[group];
    if (!pipeline) {
      std::vector<const Row*> some;
      for (std::size_t r = group * rows_a_shader; r < std::min((group + 1) * rows_a_shader, rows().size());
           ++r)
        some.push_back(&rows()[r]);
      pipeline.emplace(device, compiled(language_, shader_text(language_, some)),
                       std::vector<gpu::Binding>{{0}, {1}, {2}});
    }
    return *pipeline;
  }

 private:
  Language language_;
  std::map<std::size_t, std::optional<gpu::ComputePipeline>> groups_{};
};

class Conformance : public VulkanTest, public ::testing::WithParamInterface<Language> {
 protected:
  static void TearDownTestSuite() {
    pipelines.clear();
    VulkanTest::TearDownTestSuite();
  }

  /// Runs the jobs of one shader.
  static void run_together(const gpu::ComputePipeline& pipeline, const std::vector<Job*>& jobs) {
    std::vector<ShaderInputs<float>> cases;
    std::vector<Work> work;
    for (const Job* job : jobs)
      for (std::size_t i = 0; i < job->cases.size(); i += lanes) {
        work.push_back(
            {static_cast<std::uint32_t>(job->row % rows_a_shader), static_cast<std::uint32_t>(cases.size())});
        for (std::size_t lane = 0; lane < lanes; ++lane)
          cases.push_back(job->cases[std::min(i + lane, job->cases.size() - 1)]);
      }
    const gpu::Buffer inputs = gpu::make_device_buffer(device(), std::as_bytes(std::span(cases)));
    const gpu::Buffer groups = gpu::make_device_buffer(device(), std::as_bytes(std::span(work)));
    const gpu::Buffer results(device(), cases.size() * row_results * sizeof(float), gpu::Residence::result);
    // A component that no shader writes stays what no function gives.
    std::memset(results.mapped().data(), 0x55, results.bytes());
    gpu::BoundResources resources(device(), pipeline);
    resources.bind(0, inputs);
    resources.bind(1, results);
    resources.bind(2, groups);
    device().run([&](VkCommandBuffer commands) {
      resources.dispatch(commands, static_cast<std::uint32_t>(work.size()));
      gpu::barrier_after_writes(commands);
    });
    const std::byte* from = results.mapped().data();
    for (Job* job : jobs) {
      job->results.resize(job->cases.size() * row_results);
      std::memcpy(job->results.data(), from, job->results.size() * sizeof(float));
      from += (job->cases.size() + lanes - 1) / lanes * lanes * row_results * sizeof(float);
    }
  }

  static void run(Language language, std::vector<Job>& jobs) {
    std::map<std::size_t, std::vector<Job*>> groups;
    for (Job& job : jobs) groups[job.row / rows_a_shader].push_back(&job);
    Pipelines& made = pipelines.try_emplace(language, language).first->second;
    for (const auto& [group, some] : groups) run_together(made.of_group(device(), group), some);
  }

 private:
  inline static std::map<Language, Pipelines> pipelines;
};

INSTANTIATE_TEST_SUITE_P(Languages, Conformance, ::testing::ValuesIn(languages),
                         [](const auto& each) { return name_of(each.param); });

TEST_P(Conformance, RandomArgumentsGiveTheCoresResults) {
  Random random(seed);
  std::vector<ShaderInputs<float>> cases;
  for (std::size_t i = 0; i < random_cases; ++i) cases.push_back(random_shader_inputs(random));
  std::vector<Job> jobs;
  for (std::size_t r = 0; r < rows().size(); ++r) jobs.push_back({r, cases});
  run(GetParam(), jobs);
  std::printf("  seed %d\n", static_cast<int>(seed));
  for (const Job& job : jobs) {
    Worst worst(job.what().name);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const ShaderInputs<double> exact = convert<double>(cases[i]);
      const auto expected = job.what().in_double(exact);
      const auto bounds = job.what().bound(exact);
      ASSERT_EQ(expected.size(), bounds.size()) << job.what().name;
      ASSERT_LE(expected.size(), row_results) << job.what().name;
      double size = 0;
      for (const double e : expected) size = std::max(size, std::abs(e));
      for (std::size_t k = 0; k < expected.size(); ++k) {
        // Beyond 1 / 100 eps a bound to first order says nothing, and degenerate clamps set in.
        if (bounds[k] * eps > 0.01 * size && bounds[k] > 0) continue;
        // The second order may add a thousandth; subnormal numbers may become zero.
        constexpr double smallest = std::numeric_limits<float>::min();
        worst.add(job.result(i, k), expected[k], 1.001 * eps * bounds[k] + smallest, static_cast<long>(i));
      }
    }
  }
}

enum class Class { finite, infinite, nan };
Class class_of(double v) {
  if (std::isnan(v)) return Class::nan;
  return std::isinf(v) ? Class::infinite : Class::finite;
}

/// How far results of whole numbers and simple fractions may differ: the row's bound, or a few roundings.
double edge_tolerance(double expected, double bound) {
  const double few = 4 * vulkan_rounding * (1 + std::abs(expected));
  return eps * (std::isfinite(bound) ? std::max(bound, few) : few);
}

bool agrees(const Row& row, Edge edge, double got, double expected, double bound) {
  const Class c = class_of(expected);
  switch (edge) {
  case Edge::ordinary:
    return class_of(got) == c &&
           (c != Class::finite || std::abs(got - expected) <= edge_tolerance(expected, bound));
  case Edge::extreme: // magnitudes for which shaders promise no more
    return c != Class::finite || class_of(got) == Class::finite || row.overflows;
  case Edge::infinite:
    break;
  }
  if (c == Class::finite) return class_of(got) == Class::finite;
  return row.nan != NanPolicy::kept || class_of(got) == c;
}

TEST_P(Conformance, TheEdgeTableGivesTheCoresResults) {
  std::vector<Job> jobs;
  std::vector<std::vector<EdgeCase>> edges;
  for (std::size_t r = 0; r < rows().size(); ++r) {
    edges.push_back(edge_cases(rows()[r].used_fields()));
    jobs.push_back({r});
    for (const EdgeCase& each : edges.back()) jobs.back().cases.push_back(each.in);
  }
  run(GetParam(), jobs);
  long compared = 0;
  long vanished = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const Row& row = jobs[j].what();
    for (std::size_t i = 0; i < edges[j].size(); ++i) {
      const auto expected = row.in_float(edges[j][i].in);
      const auto bounds = row.bound(convert<double>(edges[j][i].in));
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const double got = jobs[j].result(i, k);
        ++compared;
        vanished += class_of(got) != class_of(expected[k]);
        EXPECT_TRUE(agrees(row, edges[j][i].edge, got, expected[k], bounds[k]))
            << row.name << ", " << edges[j][i].what << ", component " << k << ": got " << got << ", expected "
            << expected[k];
      }
    }
  }
  std::printf(
      "  %ld results compared; of %ld NaN or Inf became a number or the reverse, where rows leave it open\n",
      compared, vanished);
}

/// The columns of the reference's results that a row gives.
struct Columns {
  const char* row;
  std::size_t first;
  bool turns_green = false;  ///< the reference's texture origin is upper left
  bool by_magnitude = false; ///< the reference divides by |dot(normal, dir)|
};
constexpr Columns columns[] = {{"make_frame", 0},
                               {"mikktspace_basis", 10},
                               {"derivative_from_normal(3)", 16, true},
                               {"tangent_basis", 21},
                               {"from_perturbed_normal", 30},
                               {"from_texel_derivative", 33},
                               {"from_height_derivative", 36},
                               {"from_volume_gradient", 39},
                               {"triplanar_weights", 42},
                               {"from_triplanar: listing 13", 45},
                               {"project_to_texture_space", 48, false, true},
                               {"project_to_texture_space, skipped", 50},
                               {"surface_offset", 52},
                               {"screen_derivatives", 58}};

ShaderInputs<float> inputs_of(const Pixel<float>& p, const mat4<float>& world_from_screen) {
  ShaderInputs<float> in{};
  in.core.frame = make_frame(p.normal, p.dp_dx, p.dp_dy);
  in.core.raw_normal = p.normal;
  in.core.raw_tangent = p.tangent;
  in.core.sign = p.sign;
  in.core.tangent_normal = p.tangent_normal;
  in.core.perturbed = p.perturbed;
  in.core.gradient = p.gradient;
  in.core.direction = p.direction;
  in.core.position = p.screen_position;
  in.core.weights = triplanar_weights(in.core.frame.normal);
  in.core.dst_dx = p.dst_dx;
  in.core.dst_dy = p.dst_dy;
  in.core.texture_offset = p.offset;
  in.core.size = {512, 256};
  in.core.deriv = p.deriv_x;
  in.core.deriv_y = p.deriv_y;
  in.core.deriv_z = p.deriv_z;
  in.core.dh_duv = p.height_deriv;
  in.core.bump_scale = p.bump_scale;
  in.core.world_from_screen = world_from_screen;
  in.core.x = p.x;
  in.core.y = p.y;
  return in;
}

TEST_P(Conformance, TheReferenceVectorsComeOut) {
  if (!std::filesystem::exists(SURFGRAD_SHARED_DIR "/vectors"))
    GTEST_SKIP() << "no folder " SURFGRAD_SHARED_DIR "/vectors";
  const Quads quads;
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  std::vector<ShaderInputs<float>> cases;
  for (int y = 0; y < quad_height; ++y)
    for (int x = 0; x < quad_width; ++x)
      cases.push_back(inputs_of(quads.pixel<float>(x, y), quads.matrix<float>()));
  std::vector<Job> jobs;
  for (const Columns& each : columns)
    for (std::size_t r = 0; r < rows().size(); ++r)
      if (rows()[r].name == each.row) jobs.push_back({r, cases});
  ASSERT_EQ(jobs.size(), std::size(columns));
  run(GetParam(), jobs);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    Worst worst(jobs[j].what().name);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto bounds = jobs[j].what().bound(convert<double>(cases[i]));
      const float* expected =
          quads.expected(static_cast<int>(i) % quad_width, static_cast<int>(i) / quad_width);
      const double along = dot(cases[i].core.frame.normal, cases[i].core.direction);
      for (std::size_t k = 0; k < bounds.size(); ++k) {
        const std::size_t column = columns[j].first + k;
        const auto group =
            std::find_if(std::begin(quad_groups), std::end(quad_groups), [&](const QuadGroup& g) {
              return column < static_cast<std::size_t>(g.first + g.count);
            });
        double size = 0;
        for (int c = group->first; c < group->first + group->count; ++c)
          size = std::max(size, std::abs(static_cast<double>(expected[c])));
        double sign = 1;
        if (columns[j].turns_green && k == 1) sign = -1;
        if (columns[j].by_magnitude && along < 0) sign = -1;
        // The frame that came in has rounded once already: the row's bound counts twice.
        worst.add(sign * jobs[j].result(i, k), static_cast<double>(expected[column]),
                  group->reference_error * size + 2 * eps * bounds[k], static_cast<long>(i));
      }
    }
  }
}

} // namespace
} // namespace surfgrad::test
