#include "gpu/backend.hpp"

#include "gpu/stack_maps.hpp"
#include "gpu/stack_pipeline.hpp"
#include "simd/lane.hpp"

#include <surfgrad/gradient.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstring>
#include <map>

namespace surfgrad::gpu {
namespace {

using engine::TileWork;

/// Fragments of one thread on their way to the device and back.
struct Batch {
  Buffer fragments, results, object;
  std::vector<float> resolve_signs;
  std::vector<AttributeArray> arrays;
  std::map<std::uint32_t, BoundResources> bound; // by material
};

/// Arrays are this long: the last pack of lanes may fill more than the fragments.
std::size_t stride_of(std::size_t fragments) { return fragments + most_lanes; }

float* floats(const Buffer& buffer) { return reinterpret_cast<float*>(buffer.mapped().data()); }

void copy(const float* from, float* to, int count) {
  if (to != nullptr) std::memcpy(to, from, static_cast<std::size_t>(count) * sizeof(float));
}

/// Of a thread's fragments on the device: more at a time would not be faster, and threads are many.
constexpr std::size_t most_batch_bytes = std::size_t{64} << 20;

class DeviceComposer : public stage::Composer {
 public:
  DeviceComposer(const Device& device, int tile_side, std::size_t most_fragments, const scene::Scene& scene,
                 const std::vector<raster::UvSlot>& slots, engine::MapLibrary& library,
                 MaterialShaders& shaders, PipelineCache& cache, std::size_t most_buffer_bytes)
      : device_(device), slots_(slots) {
    std::size_t most_floats = StackPipeline::result_floats;
    std::size_t most_values = 1;
    for (std::uint32_t material = 0; material < scene.materials.size(); ++material) {
      const std::string& name = scene.materials[material].name;
      const shadergen::Shader shader = shaders.write(material);
      const StackMaps maps(shader, library, [&](const image::Map& map, stack::Filter filter) {
        return shaders.format_of(map, filter).value();
      });
      const MapWords words(device, maps.maps(), name, most_buffer_bytes);
      pipelines_.push_back(std::make_unique<StackPipeline>(device, shader, maps.maps(), words, cache, name));
      most_floats = std::max(most_floats, pipelines_.back()->fragment_floats());
      most_values = std::max(most_values, pipelines_.back()->object_values({}).size());
    }
    // Larger tiles are composed in parts.
    const std::size_t in_buffer =
        std::min<std::size_t>(device.limits().maxStorageBufferRange, most_batch_bytes) /
            (most_floats * sizeof(float)) -
        most_lanes;
    const std::size_t in_dispatch = std::size_t{device.limits().maxComputeWorkGroupCount[0]} * 64;
    const auto side = static_cast<std::size_t>(tile_side);
    most_fragments_ = std::min({side * side, in_buffer, in_dispatch, most_fragments});
    fragment_bytes_ = stride_of(most_fragments_) * most_floats * sizeof(float);
    object_bytes_ = most_values * sizeof(float);
  }

  void compose(const TileWork& work, std::uint32_t material) const override {
    Batch& batch = batches_.local();
    if (batch.fragments.bytes() == 0) {
      batch.fragments = Buffer(device_, fragment_bytes_, Residence::upload);
      batch.results =
          Buffer(device_, stride_of(most_fragments_) * StackPipeline::result_floats * sizeof(float),
                 Residence::result);
      batch.object = Buffer(device_, object_bytes_, Residence::upload);
      batch.resolve_signs.resize(stride_of(most_fragments_));
    }
    const StackPipeline& pipeline = *pipelines_[material];
    auto bound = batch.bound.find(material);
    if (bound == batch.bound.end())
      bound =
          batch.bound.emplace(material, pipeline.bound(batch.fragments, batch.results, batch.object)).first;
    const std::vector<float> object = pipeline.object_values(*work.placement);
    std::memcpy(batch.object.mapped().data(), object.data(), object.size() * sizeof(float));
    const auto most = static_cast<int>(most_fragments_);
    for (int first = 0; first < work.count; first += most)
      compose_part(work, pipeline, batch, bound->second, first, std::min(most, work.count - first));
  }

 private:
  [[nodiscard]] int slot_of(int uv_set) const {
    for (std::size_t s = 0; s < slots_.size(); ++s)
      if (slots_[s].uv_set == uv_set) return static_cast<int>(s);
    return 0;
  }

  void compose_part(const TileWork& work, const StackPipeline& pipeline, Batch& batch,
                    const BoundResources& resources, int first, int count) const {
    const std::size_t stride = stride_of(most_fragments_);
    float* to = floats(batch.fragments);
    batch.arrays.clear();
    for (const StackAttribute& each : pipeline.attributes()) {
      batch.arrays.push_back({each.attribute, each.uv < 0 ? 0 : slot_of(each.uv), to});
      to += static_cast<std::size_t>(floats_of(each.attribute)) * stride;
    }
    FragmentWork fragments{.tile = &work,
                           .wanted = work.wanted,
                           .first = first,
                           .count = count,
                           .arrays = batch.arrays.data(),
                           .array_count = static_cast<int>(batch.arrays.size()),
                           .stride = stride,
                           .resolve_sign = batch.resolve_signs.data()};
    fragments.wanted.object_position =
        pipeline.wants(Attribute::object_position) || pipeline.wants(Attribute::world_position);
    fragments.wanted.normal_derivatives =
        pipeline.wants(Attribute::dn_dx) || pipeline.wants(Attribute::dn_dy);
    write_fragments(fragments);
    device_.run([&](VkCommandBuffer commands) {
      pipeline.compose(commands, resources, static_cast<std::uint32_t>(count),
                       static_cast<std::uint32_t>(stride));
    });
    take_results(work, batch, first, count);
  }

  void take_results(const TileWork& work, const Batch& batch, int first, int count) const {
    const std::size_t stride = stride_of(most_fragments_);
    const float* from = floats(batch.results);
    const auto result = [&](std::size_t k) { return from + k * stride; };
    const auto at = [first](float* array) { return array == nullptr ? nullptr : array + first; };
    const TileWork::Results& r = work.results;
    copy(result(0), at(r.normal.x), count);
    copy(result(1), at(r.normal.y), count);
    copy(result(2), at(r.normal.z), count);
    copy(result(3), at(r.base_normal.x), count);
    copy(result(4), at(r.base_normal.y), count);
    copy(result(5), at(r.base_normal.z), count);
    copy(result(6), at(r.degenerate), count);
    copy(result(7), at(r.sunlight), count);
    if (r.surfgrad.x == nullptr) return;
    for (int i = 0; i < count; ++i) {
      const vec3<float> normal{result(0)[i], result(1)[i], result(2)[i]};
      const vec3<float> base{result(3)[i], result(4)[i], result(5)[i]};
      const vec3<float> g =
          batch.resolve_signs[static_cast<std::size_t>(i)] * from_perturbed_normal(base, normal);
      r.surfgrad.x[first + i] = g.x;
      r.surfgrad.y[first + i] = g.y;
      r.surfgrad.z[first + i] = g.z;
    }
  }

  const Device& device_;
  std::vector<raster::UvSlot> slots_;
  std::vector<std::unique_ptr<StackPipeline>> pipelines_; // one a material
  std::size_t most_fragments_ = 0;
  std::size_t fragment_bytes_ = 0;
  std::size_t object_bytes_ = 0;
  mutable tbb::enumerable_thread_specific<Batch> batches_;
};

} // namespace

Backend::Backend(const Device& device, int most_tile_side, std::size_t most_fragments,
                 FilterOptions filter_options, std::size_t most_buffer_bytes)
    : device_(device), tile_side_(std::max(1, most_tile_side)),
      most_fragments_(std::max<std::size_t>(1, most_fragments)), filter_options_(std::move(filter_options)),
      most_buffer_bytes_(most_buffer_bytes) {}

std::unique_ptr<stage::Composer> Backend::prepare(const scene::Scene& scene,
                                                  const std::vector<raster::UvSlot>& slots,
                                                  const std::vector<raster::Surface>& surfaces,
                                                  engine::MapLibrary& maps) const {
  MaterialShaders shaders(device_, filter_options_, scene, slots, surfaces, maps);
  auto composer = std::make_unique<DeviceComposer>(device_, tile_side_, most_fragments_, scene, slots, maps,
                                                   shaders, cache_, most_buffer_bytes_);
  const std::scoped_lock lock(mutex_);
  report_ = shaders.report();
  return composer;
}

FilterReport Backend::filter_report() const {
  const std::scoped_lock lock(mutex_);
  return report_;
}

} // namespace surfgrad::gpu
