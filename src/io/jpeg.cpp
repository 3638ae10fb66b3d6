#include "io/codecs.hpp"

#include <fmt/format.h>

#include <array>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <string_view>
#include <utility>

#include <jpeglib.h>

#include <jerror.h>

namespace surfgrad::io::codec {
namespace {

using image::Image;

// A Huffman-coded block of 64 samples costs at least one bit, in the densest of three components.
constexpr std::uint64_t jpeg_expansion = 64 * 8 * 3;

// Every scan passes over the whole image, so a few bytes a scan could keep the decoder busy for
// hours. Encoders use about ten.
constexpr int max_scans = 200;

/// Warnings that leave the pixels as they were meant; all others mean lost data.
bool is_harmless(int warning) {
  return warning == JWRN_EXTRANEOUS_DATA || warning == JWRN_JFIF_MAJOR || warning == JWRN_ADOBE_XFORM ||
         warning == JWRN_BOGUS_ICC;
}

/// The C library's decompressor over bytes in memory. It reports errors by a jump: each call of
/// the library starts from a landing place, and nothing on the way there owns anything.
class Decompressor {
 public:
  explicit Decompressor(std::span<const std::byte> bytes) {
    state_.err = jpeg_std_error(&errors_.base);
    errors_.base.error_exit = leave;
    errors_.base.emit_message = [](j_common_ptr state, int level) {
      if (level < 0 && !is_harmless(state->err->msg_code)) leave(state);
    };
    errors_.base.output_message = [](j_common_ptr) {};
    progress_.progress_monitor = [](j_common_ptr state) {
      if (reinterpret_cast<j_decompress_ptr>(state)->input_scan_number <= max_scans) return;
      Errors& errors = *reinterpret_cast<Errors*>(state->err);
      std::snprintf(errors.message.data(), errors.message.size(), "more than %d scans", max_scans);
      std::longjmp(errors.landing, 1);
    };
    ok_ = run([&] {
      jpeg_create_decompress(&state_);
      state_.progress = &progress_;
      jpeg_mem_src(&state_, reinterpret_cast<const unsigned char*>(bytes.data()),
                   static_cast<unsigned long>(bytes.size()));
    });
  }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;
  ~Decompressor() { jpeg_destroy_decompress(&state_); }

  /// Calls the library through `call(state)`. Throws what the library reports: InputError or bad_alloc.
  template <class Call>
  void operator()(const Source& source, Call call) {
    ok_ = ok_ && run([&] { call(&state_); });
    if (ok_) return;
    if (errors_.base.msg_code == JERR_OUT_OF_MEMORY) throw std::bad_alloc();
    source.fail_damaged(errors_.message.data());
  }

  [[nodiscard]] jpeg_decompress_struct& state() { return state_; }

 private:
  struct Errors {
    jpeg_error_mgr base{}; ///< first, so that the library's pointer to it is a pointer to this
    std::jmp_buf landing{};
    std::array<char, JMSG_LENGTH_MAX> message{};
  };

  [[noreturn]] static void leave(j_common_ptr state) {
    Errors& errors = *reinterpret_cast<Errors*>(state->err);
    errors.base.format_message(state, errors.message.data());
    std::longjmp(errors.landing, 1);
  }

  template <class Call>
  bool run(Call call) {
    if (setjmp(errors_.landing) != 0) return false;
    call();
    return true;
  }

  Errors errors_{};
  jpeg_progress_mgr progress_{};
  jpeg_decompress_struct state_{};
  bool ok_ = false;
};

} // namespace

Image decode_jpeg(const Source& source) {
  Decompressor decompress(source.bytes);
  jpeg_decompress_struct& state = decompress.state();
  decompress(source, [](j_decompress_ptr s) { jpeg_read_header(s, TRUE); });
  source.check_size(state.image_width, state.image_height);
  if (state.num_components != 1 && state.num_components != 3)
    source.fail(fmt::format("has {} components (CMYK or unknown)", state.num_components),
                "convert the image to grey or RGB");
  const int channels = state.num_components;
  source.check_plausible(std::uint64_t{state.image_width} * state.image_height *
                             static_cast<std::uint64_t>(channels),
                         jpeg_expansion);
  state.out_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
  state.dct_method = JDCT_ISLOW; // the accurate one, and the same on every processor

  Image image{static_cast<int>(state.image_width), static_cast<int>(state.image_height), channels};
  std::vector<std::uint8_t> codes(image.index(0, image.height));
  decompress(source, [](j_decompress_ptr s) { jpeg_start_decompress(s); });
  for (int y = 0; y < image.height; ++y) {
    JSAMPROW target = row(codes, image, flipped(image, y)).data();
    decompress(source, [&](j_decompress_ptr s) { jpeg_read_scanlines(s, &target, 1); });
  }
  decompress(source, [](j_decompress_ptr s) { jpeg_finish_decompress(s); });
  image.texels = image::Texels(std::move(codes));
  return image;
}

} // namespace surfgrad::io::codec
