#pragma once

// Internal to src/maps: transforms of all rows or columns of a picture of floats, in place.
//
// They are computed in double and kept in float, so that every number is rounded relative to itself. Each op
// is op(transform, line), with a line of complex numbers and a Transform of its length.

#include "image/parallel.hpp"
#include "maps/fourier.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace surfgrad::maps {

/// A transform costs about as much a number as this many texels of other work.
inline constexpr std::size_t transform_texels = 16;

/// Rows of complex numbers, each two floats.
template <class Transform, class Op>
void each_complex_row(float* values, std::size_t width, std::size_t height, const Op& op) {
  tbb::enumerable_thread_specific<Transform> transforms(width);
  image::in_parallel(height, transform_texels * width, [&](std::size_t y) {
    thread_local std::vector<Complex> line;
    line.resize(width);
    float* const row = values + 2 * y * width;
    for (std::size_t x = 0; x < width; ++x) line[x] = {row[2 * x], row[2 * x + 1]};
    op(transforms.local(), line.data());
    for (std::size_t x = 0; x < width; ++x) {
      row[2 * x] = static_cast<float>(line[x].real());
      row[2 * x + 1] = static_cast<float>(line[x].imag());
    }
  });
}

/// Rows of real numbers, two of them as the parts of a line.
template <class Transform, class Op>
void each_row_pair(float* values, std::size_t width, std::size_t height, const Op& op) {
  tbb::enumerable_thread_specific<Transform> transforms(width);
  image::in_parallel((height + 1) / 2, 2 * transform_texels * width, [&](std::size_t pair) {
    thread_local std::vector<Complex> line;
    line.resize(width);
    float* const row = values + 2 * pair * width;
    float* const next = 2 * pair + 1 < height ? row + width : nullptr;
    for (std::size_t x = 0; x < width; ++x) line[x] = {row[x], next != nullptr ? next[x] : 0.0f};
    op(transforms.local(), line.data());
    for (std::size_t x = 0; x < width; ++x) {
      row[x] = static_cast<float>(line[x].real());
      if (next != nullptr) next[x] = static_cast<float>(line[x].imag());
    }
  });
}

/// Columns of two neighbouring floats: complex numbers, or two columns of real ones.
template <class Transform, class Op>
void each_column_pair(float* values, std::size_t row_floats, std::size_t height, const Op& op) {
  constexpr std::size_t together = 8; // pairs that fill a cache line
  tbb::enumerable_thread_specific<Transform> transforms(height);
  const std::size_t pairs = (row_floats + 1) / 2;
  image::in_parallel(
      (pairs + together - 1) / together, transform_texels * together * height, [&](std::size_t block) {
        thread_local std::vector<Complex> lines;
        lines.resize(together * height);
        const std::size_t first = block * together;
        const std::size_t count = std::min(together, pairs - first);
        const auto has_second = [&](std::size_t i) { return 2 * (first + i) + 1 < row_floats; };
        for (std::size_t y = 0; y < height; ++y) {
          const float* const row = values + y * row_floats + 2 * first;
          for (std::size_t i = 0; i < count; ++i)
            lines[i * height + y] = {row[2 * i], has_second(i) ? row[2 * i + 1] : 0.0f};
        }
        for (std::size_t i = 0; i < count; ++i) op(transforms.local(), lines.data() + i * height);
        for (std::size_t y = 0; y < height; ++y) {
          float* const row = values + y * row_floats + 2 * first;
          for (std::size_t i = 0; i < count; ++i) {
            row[2 * i] = static_cast<float>(lines[i * height + y].real());
            if (has_second(i)) row[2 * i + 1] = static_cast<float>(lines[i * height + y].imag());
          }
        }
      });
}

} // namespace surfgrad::maps
