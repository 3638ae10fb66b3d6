#include "mesh/places.hpp"

#include <array>
#include <bit>
#include <unordered_map>

namespace surfgrad::mesh {
namespace {

using Key = std::array<std::uint32_t, 3>;

/// -0 + 0 is 0: equal coordinates have equal bits.
Key key_of(vec3<float> p) {
  return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

struct Hash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t h = 0;
    for (const std::uint32_t word : key) {
      // Multiplication carries low bits up, the shift brings them down again. 2^64 / golden ratio, odd.
      h = (h ^ word) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }
};

} // namespace

Places places_of(std::span<const vec3<float>> positions) {
  std::unordered_map<Key, std::uint32_t, Hash> numbers;
  numbers.reserve(positions.size());
  Places places;
  places.of_vertex.reserve(positions.size());
  for (const vec3<float>& p : positions) {
    const auto next = static_cast<std::uint32_t>(numbers.size());
    places.of_vertex.push_back(numbers.try_emplace(key_of(p), next).first->second);
  }
  places.count = numbers.size();
  return places;
}

} // namespace surfgrad::mesh
