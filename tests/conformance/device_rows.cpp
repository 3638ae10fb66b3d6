#include "conformance/device_rows.hpp"

#include "gpu/pipeline.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <span>

namespace surfgrad::test {
namespace {

constexpr std::size_t lanes = 64; // of a workgroup

/// Rows that are compiled together: many small shaders repeat the library, one large one is slow to compile.
constexpr std::size_t rows_a_shader = 16;

std::size_t number_of(const Job& job) { return static_cast<std::size_t>(job.row - rows().data()); }

/// The shaders of a language, and their pipelines when a job first needs one.
class Pipelines {
 public:
  const gpu::ComputePipeline& of_group(const gpu::Device& device, Language language, std::size_t group) {
    auto& shaders = shaders_[language];
    if (shaders.empty()) shaders = compiled(language, gpu::ShaderStage::compute, texts(language));
    auto& pipeline = groups_[{language, group}];
    if (!pipeline) pipeline.emplace(device, shaders[group], std::vector<gpu::Binding>{{0}, {1}, {2}});
    return *pipeline;
  }
  void forget() { groups_.clear(); }

 private:
  static std::vector<std::string> texts(Language language) {
    std::vector<std::string> all;
    for (std::size_t first = 0; first < rows().size(); first += rows_a_shader) {
      std::vector<const Row*> some;
      for (std::size_t r = first; r < std::min(first + rows_a_shader, rows().size()); ++r)
        some.push_back(&rows()[r]);
      all.push_back(compute_text(language, some));
    }
    return all;
  }

  std::map<Language, std::vector<gpu::Spirv>> shaders_{};
  std::map<std::pair<Language, std::size_t>, std::optional<gpu::ComputePipeline>> groups_{};
};

Pipelines& pipelines() {
  static Pipelines all;
  return all;
}

/// Runs the jobs of one shader.
void run_together(const gpu::Device& device, const gpu::ComputePipeline& pipeline,
                  const std::vector<Job*>& jobs) {
  std::vector<ShaderInputs<float>> cases;
  std::vector<Work> work;
  for (const Job* job : jobs)
    for (std::size_t i = 0; i < job->cases.size(); i += lanes) {
      work.push_back({static_cast<std::uint32_t>(number_of(*job) % rows_a_shader),
                      static_cast<std::uint32_t>(cases.size())});
      for (std::size_t lane = 0; lane < lanes; ++lane)
        cases.push_back(job->cases[std::min(i + lane, job->cases.size() - 1)]);
    }
  const gpu::Buffer inputs = gpu::make_device_buffer(device, std::as_bytes(std::span(cases)));
  const gpu::Buffer groups = gpu::make_device_buffer(device, std::as_bytes(std::span(work)));
  const gpu::Buffer results(device, cases.size() * row_results * sizeof(float), gpu::Residence::result);
  // A component that no shader writes stays what no function gives.
  std::memset(results.mapped().data(), 0x55, results.bytes());
  gpu::BoundResources resources(device, pipeline);
  resources.bind(0, inputs);
  resources.bind(1, results);
  resources.bind(2, groups);
  device.run([&](VkCommandBuffer commands) {
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

} // namespace

void Conformance::TearDownTestSuite() {
  pipelines().forget();
  VulkanTest::TearDownTestSuite();
}

void Conformance::run(Language language, std::vector<Job>& jobs) {
  std::map<std::size_t, std::vector<Job*>> groups;
  for (Job& job : jobs) groups[number_of(job) / rows_a_shader].push_back(&job);
  for (const auto& [group, some] : groups)
    run_together(device(), pipelines().of_group(device(), language, group), some);
}

} // namespace surfgrad::test
