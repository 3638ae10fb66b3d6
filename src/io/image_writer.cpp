#include "io/image_writer.hpp"

#include "diagnostic/error.hpp"
#include "io/codecs.hpp"
#include "io/encoders.hpp"
#include "io/extension.hpp"
#include "io/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace fs = std::filesystem;

namespace surfgrad::io {
namespace {

using image::Depth;
using image::Image;

struct Format {
  std::string_view name;
  ImageFormat format;
  std::array<std::string_view, 2> extensions;
  std::array<std::optional<Depth>, 3> depths;
  std::string_view depth_names;
  std::unique_ptr<codec::Encoder> (*make_encoder)(const codec::Order&, ByteSink&);
};

constexpr std::array formats{
    Format{"PNG",
           ImageFormat::png,
           {".png"},
           {Depth::unorm8, Depth::unorm16},
           "8-bit or 16-bit integers",
           codec::make_png_encoder},
    Format{"TIFF",
           ImageFormat::tiff,
           {".tif", ".tiff"},
           {Depth::unorm8, Depth::unorm16, Depth::float32},
           "8-bit integers, 16-bit integers or 32-bit floats",
           codec::make_tiff_encoder},
    Format{"EXR",
           ImageFormat::exr,
           {".exr"},
           {Depth::half, Depth::float32},
           "16-bit or 32-bit floats",
           codec::make_exr_encoder},
};

std::string_view depth_name(Depth depth) {
  switch (depth) {
  case Depth::unorm8:
    return "8-bit integers";
  case Depth::unorm16:
    return "16-bit integers";
  case Depth::half:
    return "16-bit floats";
  case Depth::float32:
    return "32-bit floats";
  }
  return "values of an unknown kind";
}

const Format& find_format(const fs::path& file) {
  const std::string extension = lower_extension(file);
  const auto takes = [&](const Format& format) {
    return !extension.empty() &&
           std::count(format.extensions.begin(), format.extensions.end(), extension) > 0;
  };
  const auto format = std::find_if(formats.begin(), formats.end(), takes);
  if (format == formats.end())
    throw InputError({.file = file,
                      .problem = fmt::format("no image format for the extension \"{}\"", extension),
                      .remedy = "expected one of: .png, .tif, .tiff, .exr"});
  return *format;
}

const Format& find_format(ImageFormat wanted) {
  const auto format =
      std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return f.format == wanted; });
  if (format == formats.end()) throw std::invalid_argument("encode_image: unknown format");
  return *format;
}

void require_depth(const Format& format, Depth depth, const fs::path& file) {
  if (std::count(format.depths.begin(), format.depths.end(), std::optional(depth)) > 0) return;
  throw InputError({.file = file,
                    .problem = fmt::format("{} cannot hold {}", format.name, depth_name(depth)),
                    .remedy = fmt::format("{} holds {}", format.name, format.depth_names)});
}

void require_shape(const Format& format, const ImageShape& shape, const fs::path& file) {
  if (shape.channels < 1 || shape.channels > 4)
    throw InputError({.file = file,
                      .problem = fmt::format("cannot write an image of {} channels", shape.channels),
                      .remedy = "an image file has 1 to 4 channels"});
  codec::Source{{}, file, format.name}.check_size(static_cast<std::uint64_t>(std::max(shape.width, 0)),
                                                  static_cast<std::uint64_t>(std::max(shape.height, 0)));
}

void require_whole(const Image& image) {
  if (image.texels.size() != image.index(0, image.height))
    throw std::invalid_argument("image to write: texel count does not match its shape");
}

template <class Work>
auto with_memory_for(const ImageShape& shape, const fs::path& file, const Work& work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("{}: not enough memory to encode {} x {} texels", file.string(),
                                   shape.width, shape.height));
  }
}

/// A file in memory.
class MemorySink : public ByteSink {
 public:
  void write(std::span<const std::byte> source) override {
    const std::size_t end = position_ + source.size();
    if (end > bytes.size()) bytes.resize(end);
    if (!source.empty()) std::memcpy(bytes.data() + position_, source.data(), source.size());
    position_ = end;
  }
  void seek(std::uint64_t position) override { position_ = static_cast<std::size_t>(position); }
  [[nodiscard]] std::uint64_t position() const override { return position_; }

  std::vector<std::byte> bytes{};

 private:
  std::size_t position_ = 0;
};

} // namespace

std::vector<std::byte> encode_image(const Image& image, Depth depth, ImageFormat wanted,
                                    Compression compression) {
  const Format& format = find_format(wanted);
  const ImageShape shape = shape_of(image);
  require_depth(format, depth, {});
  require_shape(format, shape, {});
  require_whole(image);
  return with_memory_for(shape, {}, [&] {
    MemorySink sink;
    const auto encoder = format.make_encoder({shape, depth, compression}, sink);
    codec::Rows rows(image, 0, image.height);
    encoder->encode(rows);
    encoder->finish();
    return std::move(sink.bytes);
  });
}

void write_image(const fs::path& file, const Image& image, Depth depth, Compression compression) {
  require_whole(image);
  ImageWriter writer(file, shape_of(image), depth, compression);
  writer.write_rows(image);
  writer.commit();
}

void check_image_output(const fs::path& file, Depth depth) {
  require_depth(find_format(file), depth, file);
  check_writable(file);
}

ImageWriter::ImageWriter(const fs::path& file, const ImageShape& shape, Depth depth, Compression compression)
    : name_(file), shape_(shape), rows_left_(shape.height) {
  const Format& format = find_format(file);
  require_depth(format, depth, file);
  require_shape(format, shape, file);
  file_ = std::make_unique<OutputFile>(file);
  with_memory_for(shape, file, [&] { encoder_ = format.make_encoder({shape, depth, compression}, *file_); });
}

ImageWriter::~ImageWriter() = default;

void ImageWriter::write_rows(const Image& band) { write_rows(band, 0, band.height); }

void ImageWriter::write_rows(const Image& image, int bottom, int count) {
  require_whole(image);
  if (image.width != shape_.width || image.channels != shape_.channels)
    throw std::invalid_argument("ImageWriter: a band of another width or channel count");
  if (bottom < 0 || count < 0 || count > rows_left_ || count > image.height - bottom)
    throw std::invalid_argument("ImageWriter: more rows than there are");
  codec::Rows rows(image, bottom, count);
  with_memory_for(shape_, name_, [&] { encoder_->encode(rows); });
  rows_left_ -= count;
}

void ImageWriter::commit() {
  if (rows_left_ != 0) throw std::logic_error("ImageWriter: rows are missing");
  with_memory_for(shape_, name_, [&] { encoder_->finish(); });
  file_->commit();
}

} // namespace surfgrad::io
