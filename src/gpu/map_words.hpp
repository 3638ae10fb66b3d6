#pragma once

#include "gpu/device.hpp"
#include "gpu/texture.hpp"
#include "image/height_field.hpp"
#include "shadergen/shadergen.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::gpu {

/// A map of a generated shader, in the order of Shader::textures; a relief is two, each with its nodes.
struct StackMap {
  const image::Map* map = nullptr;
  const image::HeightField* field = nullptr; ///< whose map it is; null where rays do not meet it
  std::string file{};                        ///< for messages
  /// What a sampled texture holds, and how; `map` then has its levels and the texture's unit, and no texels.
  const image::Map* sampled = nullptr;
  TextureFormat format{};
};

/// Where pieces lie that are put into buffers, each into the first that has room for it.
struct Packing {
  struct Place {
    std::size_t buffer = 0;
    std::uint64_t first = 0;
  };
  std::vector<Place> places{};       ///< one a piece
  std::vector<std::uint64_t> used{}; ///< of each buffer
};

/// sizes  none above `most`, which is what a buffer holds
[[nodiscard]] Packing first_fit(std::span<const std::uint64_t> sizes, std::uint64_t most);

/// The maps of a material as `exact` access reads them, in as many buffers as a device's limit asks for. A
/// map lies in one of them.
///
/// The maps must outlive it.
class MapWords {
 public:
  /// most_bytes  of a buffer, if the device allows as many: for tests
  /// throws      MachineError where a map alone is too large for a buffer
  MapWords(const Device& device, const std::vector<StackMap>& maps, const std::string& material,
           std::size_t most_bytes = SIZE_MAX);

  /// For shadergen::exact_words.
  [[nodiscard]] const std::vector<int>& blocks() const { return blocks_; }
  [[nodiscard]] int buffer_count() const { return static_cast<int>(pieces_.size()); }
  /// One a StackMap.
  [[nodiscard]] const std::vector<shadergen::ExactMap>& maps() const { return maps_; }
  /// What a buffer holds.
  [[nodiscard]] std::vector<std::uint32_t> words(int buffer) const;

 private:
  std::vector<int> blocks_;
  std::vector<shadergen::ExactMap> maps_;
  /// What lies in each buffer, one after the other.
  std::vector<std::vector<std::span<const std::uint32_t>>> pieces_;
};

} // namespace surfgrad::gpu
