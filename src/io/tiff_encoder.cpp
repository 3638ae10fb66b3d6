#include "diagnostic/error.hpp"
#include "io/encoders.hpp"
#include "io/tiff_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

namespace surfgrad::io::codec {
namespace {

// A new file is never read back.
tmsize_t read_nothing(thandle_t, void*, tmsize_t) { return 0; }

tmsize_t write_to_sink(thandle_t handle, void* source, tmsize_t count) {
  const std::span bytes(static_cast<const std::byte*>(source),
                        static_cast<std::size_t>(std::max<tmsize_t>(count, 0)));
  return static_cast<QuietSink*>(handle)->write(bytes) ? count : 0;
}

toff_t seek_sink(thandle_t handle, toff_t offset, int whence) {
  QuietSink& sink = *static_cast<QuietSink*>(handle);
  const toff_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? sink.position() : sink.size();
  constexpr toff_t failed = ~toff_t{0};
  return sink.seek(from + offset) ? from + offset : failed;
}

toff_t size_of_sink(thandle_t handle) { return static_cast<const QuietSink*>(handle)->size(); }

class TiffEncoder : public Encoder {
 public:
  TiffEncoder(const Order& order, ByteSink& sink)
      : sink_(sink), sample_bytes_(order.depth == image::Depth::float32   ? 4
                                   : order.depth == image::Depth::unorm16 ? 2
                                                                          : 1),
        tiff_(open_tiff("w", {&sink_, read_nothing, write_to_sink, seek_sink, size_of_sink}, error_, 0)) {
    check(tiff_ != nullptr);
    const ImageShape& shape = order.shape;
    const bool floats = sample_bytes_ == 4;
    set(TIFFTAG_IMAGEWIDTH, shape.width);
    set(TIFFTAG_IMAGELENGTH, shape.height);
    set(TIFFTAG_SAMPLESPERPIXEL, shape.channels);
    set(TIFFTAG_BITSPERSAMPLE, sample_bytes_ * 8);
    set(TIFFTAG_SAMPLEFORMAT, floats ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    set(TIFFTAG_PHOTOMETRIC, shape.channels >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    set(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (shape.channels == 2 || shape.channels == 4) {
      std::uint16_t extra = shape.has_alpha ? EXTRASAMPLE_UNASSALPHA : EXTRASAMPLE_UNSPECIFIED;
      check(TIFFSetField(tiff_.get(), TIFFTAG_EXTRASAMPLES, 1, &extra) == 1);
    }
    set(TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    // Level 6 takes up to four times as long as level 1 to save at most a tenth.
    set(TIFFTAG_ZIPQUALITY, order.compression == Compression::fast ? 1 : 6);
    set(TIFFTAG_PREDICTOR, floats ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
    // Strips of about a quarter megabyte: large enough to pack well, small enough to read piecemeal.
    const int row_bytes = shape.width * shape.channels * sample_bytes_;
    set(TIFFTAG_ROWSPERSTRIP, std::clamp(262144 / row_bytes, 1, shape.height));
  }

  void encode(Rows& rows) override {
    for (int y = 0; y < rows.count(); ++y) {
      if (sample_bytes_ == 4)
        write_row(std::vector<float>(rows[y].begin(), rows[y].end()));
      else if (sample_bytes_ == 2)
        write_row(codes_of<std::uint16_t>(rows[y]));
      else
        write_row(codes_of<std::uint8_t>(rows[y]));
    }
  }

  void finish() override {
    check(TIFFWriteDirectory(tiff_.get()) == 1);
    check(TIFFFlush(tiff_.get()) == 1);
  }

 private:
  template <class Code>
  static std::vector<Code> codes_of(std::span<const float> values) {
    std::vector<Code> codes(values.size());
    to_codes(values, codes.data());
    return codes;
  }

  /// The library changes the samples it is given.
  template <class Sample>
  void write_row(std::vector<Sample> samples) {
    check(TIFFWriteScanline(tiff_.get(), samples.data(), next_row_++) == 1);
  }

  template <class Value>
  void set(std::uint32_t tag, Value value) {
    check(TIFFSetField(tiff_.get(), tag, value) == 1);
  }

  void check(bool ok) const {
    sink_.check();
    if (!ok) throw MachineError(fmt::format("cannot encode TIFF: {}", error_.data()));
  }

  QuietSink sink_;
  TiffError error_{};
  int sample_bytes_;
  std::uint32_t next_row_ = 0;
  Tiff tiff_;
};

} // namespace

std::unique_ptr<Encoder> make_tiff_encoder(const Order& order, ByteSink& sink) {
  return std::make_unique<TiffEncoder>(order, sink);
}

} // namespace surfgrad::io::codec
