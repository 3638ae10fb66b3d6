#pragma once

// Internal to src/io: one decoder a format, from memory, and what they share. Use io/image_file.hpp.

#include "image/image.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::io::codec {

// Larger sides than any graphics device accepts; 2^28 texels of four floats fill 4 GiB.
inline constexpr std::uint64_t max_side = 65536;
inline constexpr std::uint64_t max_texels = std::uint64_t{1} << 28;

// Deflate turns one byte into at most 1032; the rest allows for headers and padding.
inline constexpr std::uint64_t deflate_expansion = 1100;

/// The content of one file, with what its error messages have in common.
struct Source {
  std::span<const std::byte> bytes;
  const std::filesystem::path& file; ///< for messages only: nothing is opened
  std::string_view format;           ///< as users call it, e.g. `PNG`

  /// Throws InputError. `problem` completes a sentence that begins with the format.
  [[noreturn]] void fail(std::string_view problem, std::string remedy, std::string place = {}) const;

  /// Throws InputError for content that breaks off or breaks its format's rules; `detail` says how.
  [[noreturn]] void fail_damaged(std::string_view detail) const;

  /// Throws InputError unless both sides lie in [1, max_side] and the area within max_texels.
  void check_size(std::uint64_t width, std::uint64_t height) const;

  /// Throws InputError where `raw_bytes` of pixel data cannot have been packed into this file by a
  /// compression that shrinks at most `max_expansion` times. Call it before allocating.
  void check_plausible(std::uint64_t raw_bytes, std::uint64_t max_expansion) const;

  [[nodiscard]] std::uint8_t byte(std::size_t i) const { return std::to_integer<std::uint8_t>(bytes[i]); }
};

/// Row of the image (0 at the bottom) that holds row `file_row` of a file (0 at the top), and back.
[[nodiscard]] inline int flipped(const image::Image& image, int file_row) {
  return image.height - 1 - file_row;
}

/// One row of values that are to be an image's texels: width * channels.
template <class Value>
[[nodiscard]] std::span<Value> row(std::vector<Value>& values, const image::Image& image, int y) {
  return {values.data() + image.index(0, y), image.index(image.width, 0)};
}

/// Turns rows in the order of files into rows in the order of images, and back.
template <class Value>
void flip_rows(std::vector<Value>& values, const image::Image& image) {
  for (int y = 0; y < image.height / 2; ++y) {
    const auto lower = row(values, image, y);
    std::swap_ranges(lower.begin(), lower.end(), row(values, image, flipped(image, y)).begin());
  }
}

// Each decoder throws InputError for content it cannot turn into a whole image, std::bad_alloc
// where memory runs out. Content whose magic it does not know never reaches it.
[[nodiscard]] image::Image decode_png(const Source& source);
[[nodiscard]] image::Image decode_tiff(const Source& source);
[[nodiscard]] image::Image decode_exr(const Source& source);
[[nodiscard]] image::Image decode_jpeg(const Source& source);
[[nodiscard]] image::Image decode_hdr(const Source& source);
[[nodiscard]] image::Image decode_tga(const Source& source);

/// TGA has no magic: whether the first bytes can be the header of one.
[[nodiscard]] bool could_be_tga(std::span<const std::byte> bytes);

} // namespace surfgrad::io::codec
