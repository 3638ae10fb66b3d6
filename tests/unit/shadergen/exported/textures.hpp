#pragma once

/// Maps as a program uploads them for exported shaders: what their files hold, and what filters them.

#include "gpu/texture.hpp"
#include "image/image.hpp"
#include "shadergen/shadergen.hpp"

#include <map>
#include <utility>

namespace surfgrad::shadergen::test {

/// Six square images as a cube map with all mip levels.
class CubeTexture {
 public:
  /// strip  +x -x +y -y +z -z from left to right
  CubeTexture(const gpu::Device& device, const image::Image& strip);

  [[nodiscard]] VkImageView view() const { return view_.get(); }

 private:
  gpu::Handle<VkDeviceMemory> memory_; // outlives the image bound to it
  gpu::Handle<VkImage> image_;
  gpu::Handle<VkImageView> view_;
};

/// The textures and samplers of a test, each made once.
class Textures {
 public:
  explicit Textures(const gpu::Device& device) : device_(device) {}

  /// from_top  rows of the file from its top on
  /// Images must live as long as this.
  [[nodiscard]] VkImageView view_of(const image::Image& image, bool is_cube, bool from_top);
  [[nodiscard]] VkSampler sampler_of(const TextureBinding& binding);

 private:
  const gpu::Device& device_;
  std::map<std::pair<const image::Image*, bool>, gpu::Texture> flat_{};
  std::map<const image::Image*, CubeTexture> cubes_{};
  std::map<std::tuple<gpu::Sampling, gpu::Addressing, gpu::Addressing>, gpu::Handle<VkSampler>> samplers_{};
};

} // namespace surfgrad::shadergen::test
