#include "diagnostic/error.hpp"
#include "io/encoders.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <array>
#include <memory>
#include <new>
#include <vector>

namespace surfgrad::io::codec {
namespace {

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};

int write_to_sink(spng_ctx*, void* sink, void* source, std::size_t count) {
  const std::span bytes(static_cast<const std::byte*>(source), count);
  return static_cast<QuietSink*>(sink)->write(bytes) ? SPNG_OK : SPNG_IO_ERROR;
}

class PngEncoder : public Encoder {
 public:
  PngEncoder(const Order& order, ByteSink& sink)
      : sink_(sink), context_(spng_ctx_new(SPNG_CTX_ENCODER)), deep_(order.depth == image::Depth::unorm16) {
    if (!context_) throw std::bad_alloc();
    constexpr std::array<std::uint8_t, 4> color_types{
        SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, SPNG_COLOR_TYPE_TRUECOLOR,
        SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
    spng_ihdr header{.width = static_cast<std::uint32_t>(order.shape.width),
                     .height = static_cast<std::uint32_t>(order.shape.height),
                     .bit_depth = static_cast<std::uint8_t>(deep_ ? 16 : 8),
                     .color_type = color_types[order.shape.channels - 1],
                     .compression_method = 0,
                     .filter_method = 0,
                     .interlace_method = SPNG_INTERLACE_NONE};
    check(spng_set_png_stream(context_.get(), write_to_sink, &sink_));
    set_compression(order.compression);
    check(spng_set_ihdr(context_.get(), &header));
    check(spng_encode_image(context_.get(), nullptr, 0, SPNG_FMT_PNG,
                            SPNG_ENCODE_PROGRESSIVE | SPNG_ENCODE_FINALIZE));
  }

  void encode(Rows& rows) override {
    if (deep_)
      encode(rows, deep_codes_);
    else
      encode(rows, codes_);
  }

  /// The last row has completed the file.
  void finish() override { sink_.check(); }

 private:
  void set_compression(Compression compression) {
    constexpr int zlib_filtered = 1, zlib_huffman_only = 2, zlib_rle = 3;
    const bool small = compression == Compression::small;
    // Level 9 takes up to six times as long as level 6 to save a thirtieth.
    check(spng_set_option(context_.get(), SPNG_IMG_COMPRESSION_LEVEL, small ? 6 : 1));
    check(spng_set_option(context_.get(), SPNG_FILTER_CHOICE,
                          small ? SPNG_FILTER_CHOICE_ALL : SPNG_FILTER_CHOICE_SUB));
    // Hardly a string of bytes comes back in 16-bit normals and heights: searching for one costs three
    // times the time and saves nothing. Pictures of 8 bits have backgrounds, where runs save a quarter.
    const int quick = deep_ ? zlib_huffman_only : zlib_rle;
    check(spng_set_option(context_.get(), SPNG_IMG_COMPRESSION_STRATEGY, small ? zlib_filtered : quick));
  }

  template <class Code>
  void encode(Rows& rows, std::vector<Code>& codes) {
    for (int y = 0; y < rows.count(); ++y) {
      codes.resize(rows[y].size());
      to_codes(rows[y], codes.data());
      const int error = spng_encode_row(context_.get(), codes.data(), codes.size() * sizeof(Code));
      if (error != SPNG_EOI) check(error);
    }
  }

  void check(int error) const {
    sink_.check();
    if (error == SPNG_EMEM) throw std::bad_alloc();
    if (error != 0) throw MachineError(fmt::format("cannot encode PNG: {}", spng_strerror(error)));
  }

  QuietSink sink_;
  std::unique_ptr<spng_ctx, FreeContext> context_;
  bool deep_;
  std::vector<std::uint8_t> codes_{};
  std::vector<std::uint16_t> deep_codes_{};
};

} // namespace

std::unique_ptr<Encoder> make_png_encoder(const Order& order, ByteSink& sink) {
  return std::make_unique<PngEncoder>(order, sink);
}

} // namespace surfgrad::io::codec
