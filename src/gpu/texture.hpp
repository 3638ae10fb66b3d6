#pragma once

#include "gpu/buffer.hpp"
#include "image/map.hpp"

#include <functional>
#include <optional>

namespace surfgrad::gpu {

/// How the texels of a map lie on a device.
struct TextureFormat {
  VkFormat format = VK_FORMAT_UNDEFINED;
  int components = 0; ///< of a stored texel; the map's and, for three, one more that is 0
  /// What a fetched component must be multiplied by: formats that hold codes come back as fractions of
  /// the largest code.
  double unit = 1;
};

/// The map's own format where the device samples it (16-bit formats are optional in Vulkan), else floats.
[[nodiscard]] TextureFormat format_on(const Device& device, const image::Map& map);

/// The first of the same formats that `filters` says is filtered linearly (as Device::filters does); none
/// where no format of the map's is.
[[nodiscard]] std::optional<TextureFormat> filtered_format(const image::Map& map,
                                                           const std::function<bool(VkFormat)>& filters);

/// A map with all its levels as a texture: for texelFetch and for samplers. Texel (x, y) of a level is the
/// map's, so that t grows with y.
class Texture {
 public:
  Texture() = default;
  /// throws  MachineError where the device has no textures of the map's size, or not enough memory
  Texture(const Device& device, const image::Map& map) : Texture(device, map, format_on(device, map)) {}
  /// format  of format_on or filtered_format
  Texture(const Device& device, const image::Map& map, const TextureFormat& format);

  [[nodiscard]] VkImageView view() const { return view_.get(); }
  [[nodiscard]] const TextureFormat& format() const { return format_; }

 private:
  TextureFormat format_{};
  Handle<VkDeviceMemory> memory_; // outlives the image bound to it
  Handle<VkImage> image_;
  Handle<VkImageView> view_;
};

/// How a sampler filters: the engine's filters, as far as hardware has them.
enum class Sampling { nearest, bilinear, trilinear };
enum class Addressing { repeat, mirror, clamp };

/// Linear sampling needs Device::filters of the texture's format.
[[nodiscard]] Handle<VkSampler> make_sampler(const Device& device, Sampling sampling, Addressing s,
                                             Addressing t);

} // namespace surfgrad::gpu
