#include "gpu/map_words.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace surfgrad::gpu {
namespace {

std::uint64_t words_in(const StackMap& m) {
  const std::size_t nodes = m.field != nullptr ? m.field->maxima.size() + m.field->node_table.size() : 0;
  return m.map->words.size() + m.map->level_table.size() + nodes;
}

/// Of each map the first that is the same: layers share maps.
std::vector<std::size_t> originals(const std::vector<StackMap>& maps) {
  std::vector<std::size_t> result;
  for (const StackMap& each : maps)
    result.push_back(static_cast<std::size_t>(
        std::find_if(maps.begin(), maps.end(), [&](const StackMap& m) { return m.map == each.map; }) -
        maps.begin()));
  return result;
}

} // namespace

Packing first_fit(std::span<const std::uint64_t> sizes, std::uint64_t most) {
  Packing packing;
  for (const std::uint64_t size : sizes) {
    std::size_t k = 0;
    while (k < packing.used.size() && most - packing.used[k] < size) ++k;
    if (k == packing.used.size()) packing.used.push_back(0);
    packing.places.push_back({k, packing.used[k]});
    packing.used[k] += size;
  }
  return packing;
}

MapWords::MapWords(const Device& device, const std::vector<StackMap>& maps, const std::string& material,
                   std::size_t most_bytes) {
  const std::size_t most = std::min<std::size_t>(device.limits().maxStorageBufferRange, most_bytes);
  const std::vector<std::size_t> original = originals(maps);
  std::vector<std::uint64_t> sizes;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    sizes.push_back(original[i] == i ? words_in(maps[i]) : 0);
    const std::uint64_t bytes = sizes[i] * sizeof(std::uint32_t);
    if (bytes > most)
      throw MachineError(
          fmt::format("cannot compose the material \"{}\" on \"{}\": the map {} needs {} bytes in "
                      "one buffer, maxStorageBufferRange is {}; use smaller maps, or --device cpu",
                      material, device.info().name, maps[i].file, bytes, most));
  }
  const Packing packing = first_fit(sizes, most / sizeof(std::uint32_t));
  pieces_.resize(packing.used.size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (original[i] != i) {
      blocks_.push_back(blocks_[original[i]]);
      maps_.push_back(maps_[original[i]]);
      continue;
    }
    const Packing::Place& place = packing.places[i];
    blocks_.push_back(static_cast<int>(place.buffer));
    auto next = static_cast<std::uint32_t>(place.first);
    const auto put = [&](std::span<const std::uint32_t> words) {
      pieces_[place.buffer].push_back(words);
      const std::uint32_t at = next;
      next += static_cast<std::uint32_t>(words.size());
      return at;
    };
    const image::Map& map = *maps[i].map;
    shadergen::ExactMap exact;
    exact.texels = put(map.words);
    exact.levels = put(map.level_table);
    exact.level_count = static_cast<std::uint32_t>(map.level_count);
    exact.format = static_cast<std::uint32_t>(map.format) +
                   256u * static_cast<std::uint32_t>(map.components) + (map.encoded ? 65536u : 0u);
    exact.scale = static_cast<float>(map.scale);
    if (const image::HeightField* field = maps[i].field; field != nullptr) {
      exact.nodes = put(field->maxima);
      exact.rows = put(field->node_table);
      exact.row_words = static_cast<std::uint32_t>(field->row_words);
    }
    maps_.push_back(exact);
  }
}

std::vector<std::uint32_t> MapWords::words(int buffer) const {
  std::vector<std::uint32_t> all;
  const auto& pieces = pieces_[static_cast<std::size_t>(buffer)];
  std::size_t count = 0;
  for (const auto& piece : pieces) count += piece.size();
  all.reserve(count);
  for (const auto& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

} // namespace surfgrad::gpu
