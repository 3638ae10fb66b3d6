#include "diagnostic/error.hpp"
#include "io/codecs.hpp"

#include <fmt/format.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace surfgrad::io::codec {
namespace {

using image::Depth;
using image::Image;

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::span<const std::byte> bytes) : IStream(""), bytes_(bytes) {}

  bool read(char target[], int count) override {
    if (count < 0 || position_ > bytes_.size() ||
        static_cast<std::uint64_t>(count) > bytes_.size() - position_)
      throw std::runtime_error("unexpected end of file");
    std::memcpy(target, bytes_.data() + position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::uint64_t>(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t position_ = 0;
};

/// Reads the little-endian fields of a header in order; every read is checked against the end.
class HeaderScan {
 public:
  explicit HeaderScan(const Source& source) : source_(source) {}

  std::span<const std::byte> take(std::uint64_t count) {
    if (count > source_.bytes.size() - position_) source_.fail_damaged("the header breaks off");
    const auto taken = source_.bytes.subspan(position_, static_cast<std::size_t>(count));
    position_ += static_cast<std::size_t>(count);
    return taken;
  }
  std::uint32_t u32() { return u32(take(4), 0); }
  std::string_view text() {
    const auto rest = source_.bytes.subspan(position_);
    const auto end = std::find(rest.begin(), rest.end(), std::byte{0});
    const auto length = static_cast<std::size_t>(end - rest.begin());
    take(length + 1);
    return {reinterpret_cast<const char*>(rest.data()), length};
  }

  static std::uint32_t u32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    return value;
  }

 private:
  const Source& source_;
  std::size_t position_ = 0;
};

/// Walks the header before the library does: the library allocates whatever an attribute, a data
/// window, a tile or a preview declares.
void check_header(const Source& source) {
  constexpr std::uint32_t deep_flag = 0x800, multipart_flag = 0x1000;
  HeaderScan scan(source);
  scan.u32(); // magic
  if ((scan.u32() & (deep_flag | multipart_flag)) != 0)
    source.fail("is deep or has several parts", "save one flat part");

  std::uint64_t width = 0, height = 0, tile_width = 0, tile_height = 0, channel_count = 0;
  std::uint32_t compression = 0;
  for (auto name = scan.text(); !name.empty(); name = scan.text()) {
    const auto type = scan.text();
    const auto value = scan.take(scan.u32());
    const auto number = [&](std::size_t index) {
      if (value.size() < 4 * (index + 1))
        source.fail_damaged(fmt::format("attribute \"{}\" is too short", name));
      return HeaderScan::u32(value, 4 * index);
    };
    // Signed ends of a window: their difference is exact in 64 bits.
    const auto extent = [&](std::size_t first) {
      return static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(number(first + 2))} -
                                        static_cast<std::int32_t>(number(first)) + 1);
    };
    if (type == "box2i" && name == "dataWindow") {
      width = extent(0);
      height = extent(1);
    } else if (type == "tiledesc") {
      tile_width = number(0);
      tile_height = number(1);
    } else if (type == "compression") {
      if (value.empty()) source.fail_damaged("attribute \"compression\" is empty");
      compression = std::to_integer<std::uint32_t>(value[0]);
    } else if (type == "chlist") {
      channel_count = std::max<std::uint64_t>(1, value.size() / 18); // name, end, type, flags, sampling
    } else if (type == "preview" && 4 * std::uint64_t{number(0)} * number(1) + 8 != value.size()) {
      source.fail_damaged("the size of the preview does not match its data");
    }
  }
  source.check_size(width, height);

  // DWA keeps one 16-bit mean of 64 equal values and deflates that; the other methods deflate, or
  // pack less, after dropping at most a quarter of each value.
  constexpr std::uint32_t dwaa = 8;
  const std::uint64_t max_expansion =
      compression >= dwaa ? 128 * deflate_expansion : 4 * deflate_expansion / 3;
  constexpr std::uint64_t half_bytes = 2;
  source.check_plausible(width * height * half_bytes * std::max<std::uint64_t>(channel_count, 1),
                         max_expansion);
  if (tile_width != 0 || tile_height != 0) {
    source.check_size(tile_width, tile_height);
    // Tiles are unpacked whole. Small images in tiles of an ordinary size are fine.
    constexpr std::uint64_t ordinary_tile = 2048 * 2048;
    if (tile_width * tile_height > std::max(ordinary_tile, width * height))
      source.fail(
          fmt::format("has tiles of {} x {} texels around {} x {}", tile_width, tile_height, width, height),
          "save it with tiles no larger than the image");
    const std::uint64_t tiles = ((width - 1) / tile_width + 1) * ((height - 1) / tile_height + 1);
    if (tiles * sizeof(std::uint64_t) > source.bytes.size())
      source.fail_damaged(fmt::format("declares {} tiles", tiles));
  }
}

/// The channels to keep, in the order of the image's: R,G,B,A, else Y,A, else the first of the file
/// up to four; all from the unnamed layer, or from the first layer where that has none.
std::vector<std::string> choose_channels(const Imf::ChannelList& list) {
  const auto layer_of = [](const std::string& name) { return name.substr(0, name.rfind('.') + 1); };
  std::optional<std::string> layer;
  for (auto i = list.begin(); i != list.end(); ++i)
    if (!layer || layer_of(i.name()).empty()) layer = layer_of(i.name());
  if (!layer) return {};

  const auto present = [&](std::initializer_list<const char*> wanted) {
    std::vector<std::string> names;
    for (const char* name : wanted)
      if (list.findChannel(*layer + name)) names.push_back(*layer + name);
    return names;
  };
  if (list.findChannel(*layer + "R")) return present({"R", "G", "B", "A"});
  if (list.findChannel(*layer + "Y") && !list.findChannel(*layer + "X")) return present({"Y", "A"});
  std::vector<std::string> names;
  for (auto i = list.begin(); i != list.end() && names.size() < 4; ++i)
    if (layer_of(i.name()) == *layer) names.emplace_back(i.name());
  return names;
}

Image read_pixels(const Source& source) {
  MemoryInput stream(source.bytes);
  constexpr int no_threads = 0; // callers decide about threads, not the library
  Imf::InputFile file(stream, no_threads);
  const Imf::ChannelList& list = file.header().channels();
  const std::vector<std::string> names = choose_channels(list);
  if (names.empty()) source.fail("has no channels", "save it with channels R, G, B or Y");

  Depth depth = Depth::half;
  for (const std::string& name : names) {
    const Imf::Channel& channel = *list.findChannel(name);
    if (channel.xSampling != 1 || channel.ySampling != 1)
      source.fail("is subsampled", "save it with every channel at full resolution",
                  fmt::format("channel \"{}\"", name));
    if (channel.type == Imf::UINT)
      source.fail("holds integers", "save it as half or float", fmt::format("channel \"{}\"", name));
    if (channel.type == Imf::FLOAT) depth = Depth::float32;
  }

  const Imath::Box2i window = file.header().dataWindow();
  const int width = window.max.x - window.min.x + 1;
  const int height = window.max.y - window.min.y + 1;
  const int channels = static_cast<int>(names.size());
  Image image = image::make_image(width, height, channels, depth);
  image.has_alpha = names.back() == "A" || names.back().ends_with(".A");
  Imf::FrameBuffer target;
  const std::size_t texel_bytes = sizeof(float) * names.size();
  for (std::size_t i = 0; i < names.size(); ++i)
    target.insert(names[i], Imf::Slice::Make(Imf::FLOAT, image.texels.floats().data() + i, window,
                                             texel_bytes, texel_bytes * static_cast<std::size_t>(width)));
  file.setFrameBuffer(target);
  file.readPixels(window.min.y, window.max.y);
  flip_rows(image.texels.floats(), image);
  return image;
}

} // namespace

Image decode_exr(const Source& source) {
  check_header(source);
  try {
    return read_pixels(source);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    source.fail_damaged(error.what());
  }
}

} // namespace surfgrad::io::codec
