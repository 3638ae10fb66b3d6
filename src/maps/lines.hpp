#pragma once

#include "image/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace surfgrad::maps {

/// The rows or the columns of a picture.
enum class Axis { s, t };

/// Lines that are worked on together: as many as fill a cache line, so that columns are read by whole ones.
inline constexpr std::size_t lanes = 8;

/// Some neighbouring lines, value by value: the k-th values of all lie together. Those beyond the last line
/// of a picture hold zeros.
template <class T>
class LineBlock {
 public:
  explicit LineBlock(std::size_t length) : values_(length * lanes) {}
  [[nodiscard]] std::size_t length() const { return values_.size() / lanes; }
  [[nodiscard]] T* operator[](std::size_t k) { return values_.data() + k * lanes; }
  [[nodiscard]] const T* operator[](std::size_t k) const { return values_.data() + k * lanes; }

 private:
  std::vector<T> values_;
};

/// Where the lines of a picture of `stride` values a texel lie.
struct Lines {
  std::size_t length; ///< texels of a line
  std::size_t count;
  std::size_t along;  ///< from a texel to the next one of its line
  std::size_t across; ///< from a line to the next
};

[[nodiscard]] inline Lines lines_of(int width, int height, Axis axis, std::size_t stride = 1) {
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  return axis == Axis::s ? Lines{w, h, stride, w * stride} : Lines{h, w, w * stride, stride};
}

/// Calls body(block, first line, lines in it) for all lines, some at a time, on all threads. Blocks are read
/// with load() and written with store() below.
template <class Body>
void for_blocks_of_lines(const Lines& lines, const Body& body) {
  const std::size_t blocks = (lines.count + lanes - 1) / lanes;
  image::in_parallel(blocks, lines.length * lanes, [&](std::size_t block) {
    const std::size_t first = block * lanes;
    body(first, std::min(lanes, lines.count - first));
  });
}

template <class T, class Value>
void load(const Lines& lines, const Value* values, std::size_t first, std::size_t count,
          LineBlock<T>& block) {
  for (std::size_t k = 0; k < lines.length; ++k)
    for (std::size_t l = 0; l < count; ++l)
      block[k][l] = static_cast<T>(values[(first + l) * lines.across + k * lines.along]);
}

template <class T, class Value>
void store(const Lines& lines, const LineBlock<T>& block, std::size_t first, std::size_t count,
           Value* values) {
  for (std::size_t k = 0; k < lines.length; ++k)
    for (std::size_t l = 0; l < count; ++l)
      values[(first + l) * lines.across + k * lines.along] = static_cast<Value>(block[k][l]);
}

} // namespace surfgrad::maps
