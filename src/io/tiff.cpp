#include "diagnostic/error.hpp"
#include "io/codecs.hpp"
#include "io/tiff_library.hpp"

#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

namespace surfgrad::io::codec {
namespace {

using image::Depth;
using image::Image;

/// What the library reads.
struct Memory {
  std::span<const std::byte> bytes{};
  std::uint64_t position = 0;
};

tmsize_t read_memory(thandle_t handle, void* target, tmsize_t count) {
  Memory& memory = *static_cast<Memory*>(handle);
  if (count <= 0 || memory.position >= memory.bytes.size()) return 0;
  const std::uint64_t available =
      std::min<std::uint64_t>(static_cast<std::uint64_t>(count), memory.bytes.size() - memory.position);
  std::memcpy(target, memory.bytes.data() + memory.position, available);
  memory.position += available;
  return static_cast<tmsize_t>(available);
}

tmsize_t write_nothing(thandle_t, void*, tmsize_t) { return 0; }

toff_t seek_memory(thandle_t handle, toff_t offset, int whence) {
  Memory& memory = *static_cast<Memory*>(handle);
  if (whence == SEEK_SET) memory.position = offset;
  if (whence == SEEK_CUR) memory.position += offset;
  if (whence == SEEK_END) memory.position = memory.bytes.size() + offset;
  return memory.position;
}

toff_t size_memory(thandle_t handle) { return static_cast<const Memory*>(handle)->bytes.size(); }

template <class T>
T field(TIFF* tiff, std::uint32_t tag, T fallback) {
  T value{};
  return TIFFGetFieldDefaulted(tiff, tag, &value) == 1 ? value : fallback;
}

/// Upper bounds of how many bytes one packed byte can become.
std::uint64_t expansion(std::uint16_t compression) {
  switch (compression) {
  case COMPRESSION_NONE:
    return 1;
  case COMPRESSION_LZW:
    return 3000; // a full table: 12 bits stand for at most 3837 bytes
  case COMPRESSION_PACKBITS:
  case COMPRESSION_DEFLATE:
  case COMPRESSION_ADOBE_DEFLATE:
    return deflate_expansion;
  default:
    return 40000; // Zstandard, the strongest: 4 bytes stand for at most 128 KiB
  }
}

/// How the samples of a file are stored, checked to be something decode_tiff understands.
struct Layout {
  Depth depth = Depth::unorm8;
  std::size_t sample_bytes = 1;
  int channels = 1;
  bool has_alpha = false;     ///< the last channel is opacity
  bool separate = false;      ///< one plane a channel
  bool bottom_up = false;     ///< row 0 of the file is the bottom row
  bool white_is_zero = false; ///< of the grey channel
};

Layout read_layout(TIFF* tiff, const Source& source) {
  Layout layout;
  const auto bits = field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  const auto kind = field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  const bool integer = kind == SAMPLEFORMAT_UINT || kind == SAMPLEFORMAT_VOID;
  if (integer && bits == 8)
    layout.depth = Depth::unorm8;
  else if (integer && bits == 16)
    layout.depth = Depth::unorm16;
  else if (kind == SAMPLEFORMAT_IEEEFP && bits == 16)
    layout.depth = Depth::half;
  else if (kind == SAMPLEFORMAT_IEEEFP && bits == 32)
    layout.depth = Depth::float32;
  else
    source.fail(fmt::format("has {}-bit samples of format {}", bits, kind),
                "save it with 8 or 16-bit unsigned or 16 or 32-bit float samples");
  layout.sample_bytes = bits / 8u;

  const auto samples = field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  if (samples < 1 || samples > 4)
    source.fail(fmt::format("has {} samples a pixel", samples), "save it with 1 to 4 channels");
  layout.channels = samples;
  std::uint16_t extra_count = 0;
  const std::uint16_t* extra = nullptr;
  if (TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extra_count, &extra) == 1 && extra_count > 0)
    layout.has_alpha = extra[extra_count - 1] != EXTRASAMPLE_UNSPECIFIED;

  const auto photometric = field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  layout.white_is_zero = photometric == PHOTOMETRIC_MINISWHITE;
  const bool grey = photometric == PHOTOMETRIC_MINISBLACK || (layout.white_is_zero && integer);
  if (!grey && !(photometric == PHOTOMETRIC_RGB && samples >= 3))
    source.fail(fmt::format("has the photometric interpretation {} with {} samples", photometric, samples),
                "save it as grey or RGB");

  const auto orientation = field<std::uint16_t>(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (orientation != ORIENTATION_TOPLEFT && orientation != ORIENTATION_BOTLEFT)
    source.fail(fmt::format("has the orientation {}", orientation),
                "save it with its first row at the top or bottom and its first column at the left");
  layout.bottom_up = orientation == ORIENTATION_BOTLEFT;
  layout.separate =
      field<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) == PLANARCONFIG_SEPARATE;

  const auto compression = field<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (!TIFFIsCODECConfigured(compression))
    source.fail(fmt::format("is compressed by method {}, which this build cannot unpack", compression),
                "save it uncompressed or with Deflate or LZW");
  return layout;
}

/// What a sample of a file becomes: a value of the image, of the type that its depth has.
template <class Value>
Value load_sample(const std::byte* at, Depth depth) {
  if (depth == Depth::half) {
    std::uint16_t half;
    std::memcpy(&half, at, sizeof half);
    return static_cast<Value>(imath_half_to_float(half)); // Value is float
  }
  Value value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// A rectangle of texels as the library unpacks it: a strip or a tile, of all channels or of one.
struct Block {
  std::span<const std::byte> bytes;
  int x, y;              ///< where it begins in the file's order of rows
  int width, height;     ///< the part inside the image
  std::size_t row_bytes; ///< of the whole block: tiles may reach past the image
  int first_channel, channels;
};

template <class Value>
void store(const Block& block, const Layout& layout, const Image& image, std::vector<Value>& values) {
  for (int i = 0; i < block.height; ++i) {
    const std::byte* next = block.bytes.data() + static_cast<std::size_t>(i) * block.row_bytes;
    const int y = layout.bottom_up ? block.y + i : flipped(image, block.y + i);
    for (int x = block.x; x < block.x + block.width; ++x)
      for (int channel = 0; channel < block.channels; ++channel, next += layout.sample_bytes) {
        const auto value = load_sample<Value>(next, layout.depth);
        const bool invert = layout.white_is_zero && block.first_channel + channel == 0; // of integers alone
        values[image.index(x, y, block.first_channel + channel)] =
            invert ? static_cast<Value>(std::numeric_limits<Value>::max() - value) : value;
      }
  }
}

} // namespace

Image decode_tiff(const Source& source) {
  Memory memory{.bytes = source.bytes};
  TiffError error{};
  // Pixels live in buffers of ours; what the library needs for itself is tables and one packed strip.
  const auto max_allocation = static_cast<tmsize_t>((std::uint64_t{64} << 20) + 2 * source.bytes.size());
  const Tiff tiff =
      open_tiff("rm", {&memory, read_memory, write_nothing, seek_memory, size_memory}, error, max_allocation);
  const auto fail = [&] { source.fail_damaged(error.data()); };
  if (!tiff) fail();

  const auto width = field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGEWIDTH, 0);
  const auto height = field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGELENGTH, 0);
  source.check_size(width, height);
  const Layout layout = read_layout(tiff.get(), source);
  const auto texel_bytes = layout.sample_bytes * static_cast<std::size_t>(layout.channels);
  const auto max_expansion =
      expansion(field<std::uint16_t>(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE));
  source.check_plausible(std::uint64_t{width} * height * texel_bytes, max_expansion);

  // A strip is a tile as wide as the image whose last one is cut off.
  const bool tiled = TIFFIsTiled(tiff.get()) != 0;
  std::uint32_t block_width = width;
  std::uint32_t block_height = 0;
  if (tiled) {
    block_width = field<std::uint32_t>(tiff.get(), TIFFTAG_TILEWIDTH, 0);
    block_height = field<std::uint32_t>(tiff.get(), TIFFTAG_TILELENGTH, 0);
    source.check_size(block_width, block_height);
  } else {
    block_height = std::min(field<std::uint32_t>(tiff.get(), TIFFTAG_ROWSPERSTRIP, height), height);
    if (block_height == 0) source.fail_damaged("strips of no rows");
  }
  const int channels_per_block = layout.separate ? 1 : layout.channels;
  const std::size_t row_bytes =
      block_width * layout.sample_bytes * static_cast<std::size_t>(channels_per_block);
  source.check_plausible(std::uint64_t{row_bytes} * block_height, max_expansion);
  std::vector<std::byte> bytes(row_bytes * block_height);

  Image image{static_cast<int>(width), static_cast<int>(height), layout.channels, layout.depth,
              layout.has_alpha};
  const auto read = [&]<class Value>(std::vector<Value> values) {
    values.resize(image.index(0, image.height));
    for (int channel = 0; channel < layout.channels; channel += channels_per_block)
      for (std::uint32_t y = 0; y < height; y += block_height)
        for (std::uint32_t x = 0; x < width; x += block_width) {
          const std::uint32_t inside_height = std::min(block_height, height - y);
          const std::size_t expected = row_bytes * (tiled ? block_height : inside_height);
          const auto plane = static_cast<std::uint16_t>(channel);
          const tmsize_t got =
              tiled ? TIFFReadEncodedTile(tiff.get(), TIFFComputeTile(tiff.get(), x, y, 0, plane),
                                          bytes.data(), static_cast<tmsize_t>(expected))
                    : TIFFReadEncodedStrip(tiff.get(), TIFFComputeStrip(tiff.get(), y, plane), bytes.data(),
                                           static_cast<tmsize_t>(expected));
          if (got < 0 || static_cast<std::size_t>(got) != expected) fail();
          store({bytes, static_cast<int>(x), static_cast<int>(y),
                 static_cast<int>(std::min(block_width, width - x)), static_cast<int>(inside_height),
                 row_bytes, channel, channels_per_block},
                layout, image, values);
        }
    image.texels = image::Texels(std::move(values));
  };
  if (layout.depth == Depth::unorm8)
    read(std::vector<std::uint8_t>());
  else if (layout.depth == Depth::unorm16)
    read(std::vector<std::uint16_t>());
  else
    read(std::vector<float>());
  return image;
}

} // namespace surfgrad::io::codec
