#pragma once

#include "gpu/device.hpp"
#include "gpu/filter_plan.hpp"
#include "gpu/texture.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

namespace surfgrad::gpu {

/// How a device reads maps.
enum class Filtering {
  exact,    ///< out of buffers, filtered as the engine filters
  hardware, ///< through samplers, as many as it is known how far normals can be off for it (FilterPlan)
};

struct FilterOptions {
  Filtering filtering = Filtering::exact;
  std::function<bool(VkFormat)> filters{}; ///< in place of Device::filters, for tests
};

/// What a device's limits promise of its filters: coordinates and levels of detail are snapped to multiples
/// of 2^-bits of a texel and of a level (subTexelPrecisionBits and mipmapPrecisionBits, each at least 4,
/// usually 8). To which side is not said: they are off by a whole step at most.
[[nodiscard]] FilterPrecision filter_precision(const VkPhysicalDeviceLimits& limits);

/// What hardware filters of what was prepared last, and how far that turns normals at most.
struct FilterReport {
  std::size_t maps = 0; ///< textures of all materials
  std::size_t sampled = 0;
  double largest_angle = 0; ///< in radians
};

/// Writes the shaders of a scene's materials. Everything given must outlive it.
class MaterialShaders {
 public:
  MaterialShaders(const Device& device, const FilterOptions& options, const scene::Scene& scene,
                  const std::vector<raster::UvSlot>& slots, const std::vector<raster::Surface>& surfaces,
                  engine::MapLibrary& library);

  /// Of a material, by its number. Counted in the report.
  [[nodiscard]] shadergen::Shader write(std::uint32_t material);
  /// Of a texture; none where hardware does not filter it.
  [[nodiscard]] std::optional<TextureFormat> format_of(const image::Map& map, stack::Filter filter) const;
  [[nodiscard]] const FilterReport& report() const { return report_; }

 private:
  [[nodiscard]] bool even(std::uint32_t material) const;
  bool samples(FilterPlan& plan, const shadergen::MapSite& site, const shadergen::TextureBinding& texture);

  const Device& device_;
  const FilterOptions& options_;
  const scene::Scene& scene_;
  const std::vector<raster::UvSlot>& slots_;
  const std::vector<raster::Surface>& surfaces_;
  engine::MapLibrary& library_;
  std::map<std::tuple<const image::Map*, image::Wrap, image::Wrap, image::Filter>, double> errors_;
  FilterReport report_;
};

} // namespace surfgrad::gpu
