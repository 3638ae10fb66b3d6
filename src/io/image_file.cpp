#include "io/image_file.hpp"

#include "diagnostic/error.hpp"
#include "io/codecs.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace fs = std::filesystem;

namespace surfgrad::io {
namespace codec {

void Source::fail(std::string_view problem, std::string remedy, std::string place) const {
  throw InputError({.file = file,
                    .place = std::move(place),
                    .problem = fmt::format("{} {}", format, problem),
                    .remedy = std::move(remedy)});
}

void Source::fail_damaged(std::string_view detail) const {
  fail(fmt::format("is damaged or truncated: {}", detail), "save or copy the file again");
}

void Source::check_size(std::uint64_t width, std::uint64_t height) const {
  if (width >= 1 && height >= 1 && width <= max_side && height <= max_side && width * height <= max_texels)
    return;
  fail(fmt::format("declares {} x {} texels", width, height),
       fmt::format("sides must lie in [1, {}] and the area within {} texels", max_side, max_texels));
}

void Source::check_plausible(std::uint64_t raw_bytes, std::uint64_t max_expansion) const {
  // Small images may be stored badly; below this an allocation does no harm.
  constexpr std::uint64_t slack = 65536;
  if (raw_bytes <= slack || (raw_bytes - slack) / max_expansion <= bytes.size()) return;
  fail_damaged(fmt::format("declares {} bytes of pixel data, more than {} bytes of file can hold", raw_bytes,
                           bytes.size()));
}

} // namespace codec

namespace {

using image::Depth;
using image::Image;

struct Reader {
  std::string_view name;
  std::string_view magic; ///< the first bytes of every such file
  Image (*decode)(const codec::Source&);
};

using namespace std::string_view_literals;

constexpr std::array readers{
    Reader{"PNG", "\x89PNG\r\n\x1a\n"sv, codec::decode_png},
    Reader{"TIFF", "II*\0"sv, codec::decode_tiff},
    Reader{"TIFF", "MM\0*"sv, codec::decode_tiff},
    Reader{"TIFF", "II+\0"sv, codec::decode_tiff}, // BigTIFF
    Reader{"TIFF", "MM\0+"sv, codec::decode_tiff},
    Reader{"EXR", "\x76\x2f\x31\x01"sv, codec::decode_exr},
    Reader{"JPEG", "\xff\xd8\xff"sv, codec::decode_jpeg},
    Reader{"HDR", "#?RADIANCE\n"sv, codec::decode_hdr},
    Reader{"HDR", "#?RGBE\n"sv, codec::decode_hdr},
};

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() &&
         std::equal(magic.begin(), magic.end(), bytes.begin(), [](char c, std::byte b) {
           return static_cast<std::byte>(static_cast<unsigned char>(c)) == b;
         });
}

Reader find_reader(std::span<const std::byte> bytes, const fs::path& name) {
  if (bytes.empty())
    throw InputError({.file = name, .problem = "is empty", .remedy = "give the name of an image file"});
  for (const Reader& reader : readers)
    if (starts_with(bytes, reader.magic)) return reader;
  if (lower_extension(name) == ".tga" || codec::could_be_tga(bytes)) return {"TGA", {}, codec::decode_tga};
  throw InputError({.file = name,
                    .problem = "is not an image in a known format",
                    .remedy = "expected one of: PNG, TIFF, OpenEXR, JPEG, Radiance HDR, TGA"});
}

} // namespace

Image read_image(const fs::path& file) { return decode_image(read_file(file), file); }

Image decode_image(std::span<const std::byte> bytes, const fs::path& name) {
  const Reader reader = find_reader(bytes, name);
  try {
    return reader.decode({bytes, name, reader.name});
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("{}: not enough memory to decode this image", name.string()));
  }
}

} // namespace surfgrad::io
