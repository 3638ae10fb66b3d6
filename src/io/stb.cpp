#include "io/codecs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <memory>
#include <new>
#include <string_view>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_TGA
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace surfgrad::io::codec {
namespace {

using image::Depth;
using image::Image;

// stb_image reads zeros past the end of its input, and an HDR that ends in the wrong place keeps it
// in a loop for ever. So the pixel data is measured first, and only whole files reach it.

/// Walks through the bytes; taking more than there are throws InputError.
class Walk {
 public:
  explicit Walk(const Source& source) : source_(source) {}

  [[nodiscard]] std::size_t left() const { return source_.bytes.size() - position_; }
  void skip(std::uint64_t count) {
    if (count > left()) source_.fail_damaged("the data breaks off");
    position_ += static_cast<std::size_t>(count);
  }
  std::uint32_t byte() {
    skip(1);
    return source_.byte(position_ - 1);
  }
  [[nodiscard]] std::uint32_t peek(std::size_t ahead) const {
    if (ahead >= left()) source_.fail_damaged("the data breaks off");
    return source_.byte(position_ + ahead);
  }
  /// The next line of text, without its end. A zero byte, which ends a line for the decoder, is refused.
  std::string_view line() {
    const auto rest = source_.bytes.subspan(position_);
    const auto end = std::find(rest.begin(), rest.end(), std::byte{'\n'});
    const auto length = static_cast<std::size_t>(end - rest.begin());
    skip(length + 1);
    const std::string_view text(reinterpret_cast<const char*>(rest.data()), length);
    if (text.find('\0') != text.npos) source_.fail_damaged("the header is not text");
    return text;
  }

 private:
  const Source& source_;
  std::size_t position_ = 0;
};

struct FreePixels {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

const stbi_uc* data_for_stb(const Source& source) {
  if (source.bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    source.fail("has more than 2^31 bytes", "save it as EXR or TIFF");
  return reinterpret_cast<const stbi_uc*>(source.bytes.data());
}

/// Copies pixels as stb_image returns them, top row first.
template <class Sample>
Image to_image(const Source& source, const Sample* pixels, int width, int height, int channels, Depth depth) {
  if (!pixels) source.fail_damaged(stbi_failure_reason());
  Image image{width, height, channels, depth};
  image.has_alpha = channels == 2 || channels == 4;
  std::vector<Sample> values(pixels, pixels + image.index(0, height));
  flip_rows(values, image);
  image.texels = image::Texels(std::move(values));
  return image;
}

// --- TGA ---

constexpr std::size_t tga_header_bytes = 18;

struct TgaHeader {
  std::uint32_t id_bytes, palette_kind, type, palette_first, palette_count, palette_bits, width, height, bits,
      flags;
};

/// `bytes` holds at least tga_header_bytes.
TgaHeader tga_header(std::span<const std::byte> bytes) {
  const auto u8 = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
  const auto u16 = [&](std::size_t i) { return u8(i) | u8(i + 1) << 8; };
  return {u8(0), u8(1), u8(2), u16(3), u16(5), u8(7), u16(12), u16(14), u8(16), u8(17)};
}

bool is_one_of(std::uint32_t value, std::initializer_list<std::uint32_t> list) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

bool is_supported(const TgaHeader& header) {
  const bool palette = header.palette_kind == 1 && is_one_of(header.type, {1, 9}) &&
                       header.palette_first == 0 && header.palette_count > 0 &&
                       is_one_of(header.palette_bits, {15, 16, 24, 32}) && is_one_of(header.bits, {8, 16});
  const bool grey =
      header.palette_kind == 0 && is_one_of(header.type, {3, 11}) && is_one_of(header.bits, {8, 16});
  const bool colour =
      header.palette_kind == 0 && is_one_of(header.type, {2, 10}) && is_one_of(header.bits, {15, 16, 24, 32});
  constexpr std::uint32_t right_to_left_or_interleaved = 0x10 | 0xc0;
  return (palette || grey || colour) && (header.flags & right_to_left_or_interleaved) == 0;
}

/// Throws unless the file holds all the pixels its header declares.
void measure_tga(const Source& source, const TgaHeader& header) {
  Walk walk(source);
  walk.skip(tga_header_bytes + header.id_bytes);
  if (header.palette_kind == 1)
    walk.skip(std::uint64_t{header.palette_count} * ((header.palette_bits + 7) / 8));
  const std::uint64_t texel_bytes = (header.bits + 7) / 8;
  std::uint64_t texels = std::uint64_t{header.width} * header.height;
  constexpr std::uint32_t run_length_types = 8;
  if (header.type < run_length_types) return walk.skip(texels * texel_bytes);
  while (texels > 0) {
    const std::uint32_t packet = walk.byte();
    const std::uint64_t count = (packet & 127) + 1;
    walk.skip(texel_bytes * ((packet & 128) != 0 ? 1 : count));
    texels -= std::min(count, texels);
  }
}

// --- Radiance HDR ---

/// Reads `sign axis number` such as `-Y 512`, with the spaces after it.
int hdr_side(std::string_view& text, std::string_view axis) {
  if (!text.starts_with(axis)) return 0;
  text.remove_prefix(axis.size());
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return 0;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  while (text.starts_with(' ')) text.remove_prefix(1);
  return value;
}

/// Throws unless one run-length coded channel of a row is whole and exactly `width` long.
void measure_hdr_channel(const Source& source, Walk& walk, std::uint64_t width) {
  for (std::uint64_t done = 0; done < width;) {
    const std::uint32_t count = walk.byte();
    const std::uint32_t texels = count > 128 ? count - 128 : count;
    if (texels == 0 || texels > width - done) source.fail_damaged("a run does not fit its row");
    walk.skip(count > 128 ? 1 : texels);
    done += texels;
  }
}

/// Checks the header and throws unless the file holds all the pixels that it declares.
void measure_hdr(const Source& source) {
  // The longest line the decoder keeps whole.
  constexpr std::size_t longest_line = 1000;
  Walk walk(source);
  bool rgbe = false;
  for (auto line = walk.line(); !line.empty(); line = walk.line())
    rgbe = rgbe || line == "FORMAT=32-bit_rle_rgbe";
  std::string_view size = walk.line();
  const bool short_line = size.size() <= longest_line;
  const int height = hdr_side(size, "-Y ");
  const int width = hdr_side(size, "+X ");
  if (!rgbe || !short_line || !size.empty())
    source.fail("is not stored as RGBE with rows from the top and columns from the left",
                "expected FORMAT=32-bit_rle_rgbe and a size such as \"-Y 512 +X 1024\"");
  source.check_size(static_cast<std::uint64_t>(std::max(width, 0)),
                    static_cast<std::uint64_t>(std::max(height, 0)));

  const auto w = static_cast<std::uint64_t>(width);
  const auto h = static_cast<std::uint64_t>(height);
  constexpr int run_length_min = 8, run_length_max = 32767;
  const auto coded = [&] { return walk.peek(0) == 2 && walk.peek(1) == 2 && (walk.peek(2) & 128) == 0; };
  if (width < run_length_min || width > run_length_max || !coded()) return walk.skip(4 * w * h);
  for (std::uint64_t y = 0; y < h; ++y) {
    if (!coded() || (walk.peek(2) << 8 | walk.peek(3)) != w)
      source.fail_damaged("a row does not begin as it should");
    walk.skip(4);
    for (int channel = 0; channel < 4; ++channel) measure_hdr_channel(source, walk, w);
  }
}

} // namespace

bool could_be_tga(std::span<const std::byte> bytes) {
  if (bytes.size() < tga_header_bytes) return false;
  const TgaHeader header = tga_header(bytes);
  return is_supported(header) && header.width > 0 && header.height > 0;
}

Image decode_tga(const Source& source) {
  if (source.bytes.size() < tga_header_bytes) source.fail_damaged("the header breaks off");
  const TgaHeader header = tga_header(source.bytes);
  if (!is_supported(header))
    source.fail(fmt::format("has type {} with {} bits and flags {:#x}, or is no TGA at all", header.type,
                            header.bits, header.flags),
                "save it as grey, RGB, RGBA or palette with columns from the left, or as PNG");
  source.check_size(header.width, header.height);
  measure_tga(source, header);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, FreePixels> pixels(stbi_load_from_memory(
      data_for_stb(source), static_cast<int>(source.bytes.size()), &width, &height, &channels, 0));
  return to_image(source, pixels.get(), width, height, channels, Depth::unorm8);
}

Image decode_hdr(const Source& source) {
  measure_hdr(source);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<float, FreePixels> pixels(stbi_loadf_from_memory(
      data_for_stb(source), static_cast<int>(source.bytes.size()), &width, &height, &channels, 0));
  return to_image(source, pixels.get(), width, height, channels, Depth::float32);
}

} // namespace surfgrad::io::codec
