#include "gpu/material_shaders.hpp"

#include "gpu/stack_maps.hpp"

#include <algorithm>
#include <cmath>

namespace surfgrad::gpu {
namespace {

image::Filter filter_of(stack::Filter filter) {
  return filter == stack::Filter::nearest    ? image::Filter::nearest
         : filter == stack::Filter::bilinear ? image::Filter::bilinear
                                             : image::Filter::trilinear;
}

/// Textures with samplers that a shader may have.
std::size_t most_sampled(const VkPhysicalDeviceLimits& limits) {
  // Half of all resources: the rest are buffers.
  return std::min({limits.maxPerStageDescriptorSamplers, limits.maxPerStageDescriptorSampledImages,
                   limits.maxDescriptorSetSamplers, limits.maxDescriptorSetSampledImages,
                   limits.maxPerStageResources / 2});
}

/// Whether a transform scales all directions alike: its columns are as long and at right angles.
bool is_even(const mat3<double>& m) {
  const mat3<double> columns = transpose(m);
  const double size = dot(columns.x, columns.x);
  constexpr double rounding = 1e-6; // of transforms that were given in float
  const auto near = [&](double a, double b) { return std::abs(a - b) <= rounding * size; };
  return size > 0 && near(dot(columns.y, columns.y), size) && near(dot(columns.z, columns.z), size) &&
         near(dot(columns.x, columns.y), 0) && near(dot(columns.y, columns.z), 0) &&
         near(dot(columns.z, columns.x), 0);
}

std::size_t sampled_in(const shadergen::Shader& shader) {
  return static_cast<std::size_t>(
      std::count_if(shader.textures.begin(), shader.textures.end(),
                    [](const shadergen::TextureBinding& t) { return t.sampled; }));
}

} // namespace

FilterPrecision filter_precision(const VkPhysicalDeviceLimits& limits) {
  return {std::ldexp(1.0, -static_cast<int>(limits.subTexelPrecisionBits)),
          std::ldexp(1.0, -static_cast<int>(limits.mipmapPrecisionBits))};
}

MaterialShaders::MaterialShaders(const Device& device, const FilterOptions& options,
                                 const scene::Scene& scene, const std::vector<raster::UvSlot>& slots,
                                 const std::vector<raster::Surface>& surfaces, engine::MapLibrary& library)
    : device_(device), options_(options), scene_(scene), slots_(slots), surfaces_(surfaces),
      library_(library) {}

bool MaterialShaders::even(std::uint32_t material) const {
  for (const scene::Object& object : scene_.objects) {
    const auto& used = scene_.meshes[object.mesh].material_of_triangle;
    if (std::find(used.begin(), used.end(), material) != used.end() &&
        !is_even(raster::linear_part(object.world_from_object)))
      return false;
  }
  return true;
}

std::optional<TextureFormat> MaterialShaders::format_of(const image::Map& map, stack::Filter filter) const {
  const auto most = static_cast<int>(device_.limits().maxImageDimension2D);
  if (map.width() > most || map.height() > most) return std::nullopt;
  if (filter == stack::Filter::nearest) return format_on(device_, map);
  return filtered_format(map, [&](VkFormat format) {
    return options_.filters ? options_.filters(format) : device_.filters(format);
  });
}

bool MaterialShaders::samples(FilterPlan& plan, const shadergen::MapSite& site,
                              const shadergen::TextureBinding& texture) {
  if (!plan.follows(site)) return false;
  const auto map = map_of(texture, library_);
  if (!format_of(*map, texture.filter)) return false;
  const image::Wraps wraps{engine::wrap_of(texture.wrap_s), engine::wrap_of(texture.wrap_t)};
  const image::Filter filter = filter_of(texture.filter);
  const auto [error, is_new] = errors_.try_emplace({map.get(), wraps.s, wraps.t, filter});
  if (is_new) error->second = filter_error(*map, wraps, filter, filter_precision(device_.limits()));
  plan.count(site, error->second);
  return true;
}

shadergen::Shader MaterialShaders::write(std::uint32_t material) {
  const std::vector<stack::Layer>& layers = scene_.materials[material].layers;
  shadergen::Options options;
  options.access = shadergen::TextureAccess::exact;
  options.back_faces = scene_.materials[material].back_faces;
  options.diagnostics = true;
  options.document = scene_.source;
  if (options_.filtering == Filtering::exact) return shadergen::generate(layers, options);
  const FilterPlan fresh(engine::compile(layers, slots_, library_), mesh_reach(surfaces_, material),
                         even(material));
  // Where a device has too few samplers the last layers stay exact.
  for (std::size_t count = layers.size();; --count) {
    FilterPlan plan = fresh;
    options.samples = [&](const shadergen::MapSite& site, const shadergen::TextureBinding& texture) {
      return site.layer < count && samples(plan, site, texture);
    };
    shadergen::Shader shader = shadergen::generate(layers, options);
    const std::size_t sampled = sampled_in(shader);
    if (sampled > most_sampled(device_.limits())) continue;
    report_.maps += shader.textures.size();
    report_.sampled += sampled;
    report_.largest_angle = std::max(report_.largest_angle, plan.largest_angle());
    return shader;
  }
}

} // namespace surfgrad::gpu
