#pragma once

/// Image files put together byte by byte from the formats' specifications, so that the readers are
/// tested against something other than the project's own writers.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

namespace surfgrad::test {

/// Bytes of a file under construction.
class Bytes {
 public:
  Bytes() = default;
  Bytes(std::initializer_list<int> list) {
    for (const int value : list) u8(static_cast<std::uint32_t>(value));
  }

  Bytes& u8(std::uint32_t value) {
    data_.push_back(static_cast<std::byte>(value & 255));
    return *this;
  }
  Bytes& text(std::string_view text) {
    for (const char c : text) u8(static_cast<unsigned char>(c));
    return *this;
  }
  Bytes& add(const Bytes& other) {
    data_.insert(data_.end(), other.data_.begin(), other.data_.end());
    return *this;
  }
  Bytes& u16_little(std::uint32_t value) { return u8(value).u8(value >> 8); }
  Bytes& u16_big(std::uint32_t value) { return u8(value >> 8).u8(value); }
  Bytes& u32_little(std::uint32_t value) { return u16_little(value).u16_little(value >> 16); }
  Bytes& u32_big(std::uint32_t value) { return u16_big(value >> 16).u16_big(value); }

  [[nodiscard]] std::size_t size() const { return data_.size(); }
  [[nodiscard]] std::span<const std::byte> span() const { return data_; }
  [[nodiscard]] std::span<const std::byte> first(std::size_t count) const { return span().first(count); }
  std::byte& operator[](std::size_t i) { return data_[i]; }

 private:
  std::vector<std::byte> data_{};
};

// --- PNG ---

inline std::uint32_t png_crc(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const std::byte b : bytes) {
    crc ^= std::to_integer<std::uint32_t>(b);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

inline Bytes png_chunk(std::string_view type, const Bytes& data) {
  Bytes body;
  body.text(type).add(data);
  Bytes chunk;
  chunk.u32_big(static_cast<std::uint32_t>(data.size())).add(body);
  return chunk.u32_big(png_crc(body.span()));
}

struct PngShape {
  std::uint32_t width = 1, height = 1;
  int bits = 8;
  int color_type = 0; ///< 0 grey, 2 RGB, 3 palette, 4 grey+alpha, 6 RGBA
  int interlaced = 0;
};

/// `scanlines` holds the rows from the top, each after its filter byte, in one stored deflate block.
/// `extra` holds whole chunks that go before the pixels.
inline Bytes png_file(const PngShape& shape, const Bytes& scanlines, const Bytes& extra = {}) {
  std::uint32_t a = 1, b = 0; // Adler-32
  for (const std::byte value : scanlines.span()) {
    a = (a + std::to_integer<std::uint32_t>(value)) % 65521;
    b = (b + a) % 65521;
  }
  const auto length = static_cast<std::uint32_t>(scanlines.size());
  Bytes stream{0x78, 0x01, 1}; // zlib header; last block, stored
  stream.u16_little(length).u16_little(~length).add(scanlines).u16_big(b).u16_big(a);
  Bytes header;
  header.u32_big(shape.width).u32_big(shape.height);
  header.add(Bytes{shape.bits, shape.color_type, 0, 0, shape.interlaced});
  Bytes file;
  file.text("\x89PNG\r\n\x1a\n").add(png_chunk("IHDR", header)).add(extra);
  return file.add(png_chunk("IDAT", stream)).add(png_chunk("IEND", {}));
}

// --- TIFF ---

struct TiffTag {
  std::uint32_t tag;
  std::uint32_t value;
};

/// A little-endian file of one directory whose values are all 32-bit integers. `tags` lacks the
/// offsets and byte counts of the blocks, which are strips (tags 273, 279) or tiles (324, 325).
inline Bytes tiff_file(std::vector<TiffTag> tags, const std::vector<Bytes>& blocks, bool tiled = false) {
  const std::uint32_t offset_tag = tiled ? 324 : 273;
  const std::uint32_t count_tag = tiled ? 325 : 279;
  const auto count = static_cast<std::uint32_t>(blocks.size());
  const std::uint32_t arrays_at = 8 + 2 + (static_cast<std::uint32_t>(tags.size()) + 2) * 12 + 4;
  const std::uint32_t blocks_at = arrays_at + 8 * count;
  Bytes offsets, lengths, pixels;
  for (const Bytes& block : blocks) {
    offsets.u32_little(blocks_at + static_cast<std::uint32_t>(pixels.size()));
    lengths.u32_little(static_cast<std::uint32_t>(block.size()));
    pixels.add(block);
  }
  // An array of one value stands in the directory itself.
  tags.push_back({offset_tag, count == 1 ? blocks_at : arrays_at});
  tags.push_back(
      {count_tag, count == 1 ? static_cast<std::uint32_t>(blocks[0].size()) : arrays_at + 4 * count});
  std::sort(tags.begin(), tags.end(), [](TiffTag a, TiffTag b) { return a.tag < b.tag; });
  constexpr std::uint32_t long_type = 4;
  Bytes file;
  file.text("II").u16_little(42).u32_little(8).u16_little(static_cast<std::uint32_t>(tags.size()));
  for (const TiffTag& tag : tags) {
    const bool array = tag.tag == offset_tag || tag.tag == count_tag;
    file.u16_little(tag.tag).u16_little(long_type).u32_little(array ? count : 1).u32_little(tag.value);
  }
  return file.u32_little(0).add(offsets).add(lengths).add(pixels);
}

/// The usual tags of an uncompressed file in one strip. Photometric: 0 white is zero, 1 grey, 2 RGB.
inline std::vector<TiffTag> tiff_tags(std::uint32_t width, std::uint32_t height, std::uint32_t bits,
                                      std::uint32_t samples, std::uint32_t photometric) {
  return {{256, width},       {257, height},  {258, bits},  {259, 1},
          {262, photometric}, {277, samples}, {278, height}};
}

// --- EXR ---

struct ExrChannel {
  std::string_view name;
  std::uint32_t type = 2; ///< 0 unsigned integer, 1 half, 2 float
  std::uint32_t sampling = 1;
};

struct ExrShape {
  std::vector<ExrChannel> channels;                        ///< sorted by name
  std::int32_t min_x = 0, min_y = 0, max_x = 0, max_y = 0; ///< data window, ends included
  std::uint32_t tile = 0;                                  ///< side of a tile; 0 for scan lines
  std::uint32_t version_flags = 0;
};

inline Bytes exr_attribute(std::string_view name, std::string_view type, const Bytes& value) {
  Bytes attribute;
  attribute.text(name).u8(0).text(type).u8(0).u32_little(static_cast<std::uint32_t>(value.size()));
  return attribute.add(value);
}

inline Bytes exr_header(const ExrShape& shape, const Bytes& extra = {}) {
  Bytes channels;
  for (const ExrChannel& channel : shape.channels)
    channels.text(channel.name)
        .u8(0)
        .u32_little(channel.type)
        .u32_little(0)
        .u32_little(channel.sampling)
        .u32_little(channel.sampling);
  channels.u8(0);
  Bytes window;
  for (const std::int32_t value : {shape.min_x, shape.min_y, shape.max_x, shape.max_y})
    window.u32_little(static_cast<std::uint32_t>(value));
  Bytes display; // not the data window: readers must not mix them up
  display.u32_little(0).u32_little(0).u32_little(99).u32_little(99);
  constexpr std::uint32_t one = 0x3f800000; // 1.0f
  Bytes file;
  file.u32_little(0x01312f76).u32_little(2 | shape.version_flags | (shape.tile != 0 ? 0x200u : 0u));
  file.add(exr_attribute("channels", "chlist", channels))
      .add(exr_attribute("compression", "compression", {0}));
  file.add(exr_attribute("dataWindow", "box2i", window))
      .add(exr_attribute("displayWindow", "box2i", display));
  file.add(exr_attribute("lineOrder", "lineOrder", {0}));
  file.add(exr_attribute("pixelAspectRatio", "float", Bytes().u32_little(one)));
  file.add(exr_attribute("screenWindowCenter", "v2f", Bytes().u32_little(0).u32_little(0)));
  file.add(exr_attribute("screenWindowWidth", "float", Bytes().u32_little(one)));
  if (shape.tile != 0)
    file.add(exr_attribute("tiles", "tiledesc", Bytes().u32_little(shape.tile).u32_little(shape.tile).u8(0)));
  return file.add(extra).u8(0);
}

/// Uncompressed scan lines; `lines` holds one a row from the top: the samples of each channel in turn.
inline Bytes exr_file(const ExrShape& shape, const std::vector<Bytes>& lines) {
  Bytes file = exr_header(shape);
  Bytes table, chunks;
  const auto chunks_at = static_cast<std::uint32_t>(file.size() + 8 * lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    table.u32_little(chunks_at + static_cast<std::uint32_t>(chunks.size())).u32_little(0);
    chunks.u32_little(static_cast<std::uint32_t>(shape.min_y) + static_cast<std::uint32_t>(i));
    chunks.u32_little(static_cast<std::uint32_t>(lines[i].size())).add(lines[i]);
  }
  return file.add(table).add(chunks);
}

inline Bytes floats(std::initializer_list<float> values) {
  Bytes bytes;
  for (const float value : values) bytes.u32_little(std::bit_cast<std::uint32_t>(value));
  return bytes;
}

// --- JPEG ---

/// A quantization table of ones: the coefficients are kept as they are.
inline Bytes jpeg_quantization(int table) {
  Bytes bytes{0xff, 0xdb, 0x00, 0x43, table};
  for (int i = 0; i < 64; ++i) bytes.u8(1);
  return bytes;
}

/// A Huffman table: the number of codes of 1, 2, 3 ... bits, and what they mean in that order.
inline Bytes jpeg_huffman(int table, const Bytes& counts, const Bytes& meanings) {
  Bytes bytes{0xff, 0xc4};
  bytes.u16_big(static_cast<std::uint32_t>(2 + 1 + 16 + meanings.size())).add({table}).add(counts);
  for (std::size_t i = counts.size(); i < 16; ++i) bytes.u8(0);
  return bytes.add(meanings);
}

/// 8 x 16 grey: the upper block has the code 200 everywhere, the lower one 40.
inline Bytes jpeg_grey() {
  Bytes file{0xff, 0xd8};
  return file.add(jpeg_quantization(0))
      .add({0xff, 0xc0, 0x00, 0x0b, 0x08, 0x00, 0x10, 0x00, 0x08, 0x01, 0x01, 0x11, 0x00})
      .add(jpeg_huffman(0x00, {1, 1}, {0x0a, 0x0b}))
      .add(jpeg_huffman(0x10, {1}, {0x00}))
      .add({0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0x48, 0x09, 0x7f, 0xbf, 0xff, 0xd9});
}

/// 8 x 16 in full-resolution YCbCr: the upper block is red, the lower one blue.
inline Bytes jpeg_color() {
  Bytes file{0xff, 0xd8};
  return file.add(jpeg_quantization(0))
      .add(jpeg_quantization(1))
      .add({0xff, 0xc0, 0x00, 0x11, 0x08, 0x00, 0x10, 0x00, 0x08, 0x03, 1, 0x11, 0, 2, 0x11, 1, 3, 0x11, 1})
      .add(jpeg_huffman(0x00, {1}, {0x09}))
      .add(jpeg_huffman(0x10, {1}, {0x00}))
      .add(jpeg_huffman(0x01, {1, 1, 1}, {0x0b, 0x09, 0x0a}))
      .add(jpeg_huffman(0x11, {1}, {0x00}))
      .add({0xff, 0xda, 0x00, 0x0c, 0x03, 1, 0x00, 2, 0x11, 3, 0x11, 0x00, 0x3f, 0x00})
      .add({0x17, 0xd2, 0x9d, 0xbf, 0x81, 0x0e, 0x55, 0x01, 0xaf, 0xbf, 0xff, 0xd9});
}

/// 8 x 8 in four inks.
inline Bytes jpeg_cmyk() {
  Bytes file{0xff, 0xd8};
  return file.add({0xff, 0xee, 0x00, 0x0e, 0x41, 0x64, 0x6f, 0x62, 0x65, 0x00, 0x64, 0, 0, 0, 0, 0})
      .add(jpeg_quantization(0))
      .add({0xff, 0xc0, 0x00, 0x14, 0x08, 0,    8,    0, 8,    4,    0x43,
            0x11, 0,    0x4d, 0x11, 0,    0x59, 0x11, 0, 0x4b, 0x11, 0})
      .add(jpeg_huffman(0x00, {1}, {0x08}))
      .add(jpeg_huffman(0x10, {1}, {0x00}))
      .add({0xff, 0xda, 0x00, 0x0e, 4, 0x43, 0, 0x4d, 0, 0x59, 0, 0x4b, 0, 0, 0x3f, 0})
      .add({0x0f, 0x83, 0xe0, 0xf8, 0x3e, 0xff, 0xd9});
}

// --- TGA and HDR ---

struct TgaShape {
  std::uint32_t width = 1, height = 1;
  int type = 2; ///< 1 palette, 2 colour, 3 grey; plus 8 when run-length coded
  int bits = 24;
  int flags = 0; ///< 0x20: the first row is the top one
  std::uint32_t palette_count = 0;
};

/// `data` holds the palette, if any, and the pixels.
inline Bytes tga_file(const TgaShape& shape, const Bytes& data) {
  const bool palette = shape.palette_count > 0;
  Bytes file{0, palette ? 1 : 0, shape.type, 0, 0};
  file.u16_little(shape.palette_count).u8(palette ? 24 : 0).u32_little(0);
  return file.u16_little(shape.width).u16_little(shape.height).add({shape.bits, shape.flags}).add(data);
}

inline Bytes hdr_file(std::string_view size, const Bytes& data) {
  Bytes file;
  return file.text("#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n").text(size).text("\n").add(data);
}

} // namespace surfgrad::test
