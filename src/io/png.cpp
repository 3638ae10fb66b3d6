#include "diagnostic/error.hpp"
#include "io/codecs.hpp"

#include <fmt/format.h>
#include <spng.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace surfgrad::io::codec {
namespace {

using image::Depth;
using image::Image;

struct FreeContext {
  void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

Context new_context(int flags) {
  Context context(spng_ctx_new(flags));
  if (!context) throw std::bad_alloc();
  return context;
}

/// How the library is asked to deliver a file, and which of its samples are kept.
struct Layout {
  int format = SPNG_FMT_PNG;
  int flags = 0;
  int stored = 0;                      ///< samples a texel in the decoded buffer
  int channels = 0;                    ///< samples a texel in the image
  std::array<int, 4> kept{0, 1, 2, 3}; ///< which stored sample becomes each channel
};

Layout choose_layout(const spng_ihdr& header, bool transparent) {
  const bool deep = header.bit_depth == 16;
  switch (header.color_type) {
  case SPNG_COLOR_TYPE_GRAYSCALE:
    // The library expands grey transparency only to RGBA at every bit depth.
    if (transparent) return {deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, SPNG_DECODE_TRNS, 4, 2, {0, 3}};
    return {deep ? SPNG_FMT_PNG : SPNG_FMT_G8, 0, 1, 1};
  case SPNG_COLOR_TYPE_TRUECOLOR:
    if (transparent) return {deep ? SPNG_FMT_RGBA16 : SPNG_FMT_RGBA8, SPNG_DECODE_TRNS, 4, 4};
    return {SPNG_FMT_PNG, 0, 3, 3};
  case SPNG_COLOR_TYPE_INDEXED:
    if (transparent) return {SPNG_FMT_RGBA8, SPNG_DECODE_TRNS, 4, 4};
    return {SPNG_FMT_RGB8, 0, 3, 3};
  case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
    return {SPNG_FMT_PNG, 0, 2, 2};
  default:
    return {SPNG_FMT_PNG, 0, 4, 4}; // RGBA: the library refuses other types with the header
  }
}

/// Leaves only those samples of each texel that are kept.
template <class Code>
void pack(std::vector<Code>& codes, const Layout& layout) {
  if (layout.stored == layout.channels) return; // all are kept, in their order
  auto out = codes.begin();
  for (auto texel = codes.cbegin(); texel != codes.cend(); texel += layout.stored)
    for (int channel = 0; channel < layout.channels; ++channel) *out++ = texel[layout.kept[channel]];
  codes.erase(out, codes.end());
  codes.shrink_to_fit();
}

} // namespace

Image decode_png(const Source& source) {
  const Context context = new_context(0);
  const auto check = [&](int error) {
    if (error == SPNG_EMEM) throw std::bad_alloc();
    if (error != 0) source.fail_damaged(spng_strerror(error));
  };
  check(spng_set_png_buffer(context.get(), source.bytes.data(), source.bytes.size()));
  // Colour profiles and texts may unfold to more than the file, but not to more than any real one.
  const std::size_t chunk_limit = std::max<std::size_t>(source.bytes.size(), std::size_t{16} << 20);
  check(spng_set_chunk_limits(context.get(), chunk_limit, chunk_limit));

  spng_ihdr header{};
  check(spng_get_ihdr(context.get(), &header));
  source.check_size(header.width, header.height);
  const std::uint64_t file_samples = header.color_type == SPNG_COLOR_TYPE_TRUECOLOR         ? 3
                                     : header.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA ? 2
                                     : header.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA ? 4
                                                                                            : 1;
  const std::uint64_t row_bytes = (header.width * file_samples * header.bit_depth + 7) / 8;
  source.check_plausible(row_bytes * header.height, deflate_expansion);

  spng_trns transparency{};
  const int transparency_error = spng_get_trns(context.get(), &transparency);
  if (transparency_error != SPNG_ECHUNKAVAIL) check(transparency_error);
  const Layout layout = choose_layout(header, transparency_error == 0);

  std::size_t size = 0;
  check(spng_decoded_image_size(context.get(), layout.format, &size));
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), layout.channels};
  image.has_alpha = layout.channels == 2 || layout.channels == 4;
  const auto decode = [&]<class Code>(std::vector<Code> codes) {
    codes.resize(size / sizeof(Code));
    check(spng_decode_image(context.get(), codes.data(), size, layout.format, layout.flags));
    check(spng_decode_chunks(context.get())); // to the end: a file that lacks it was cut short
    pack(codes, layout);
    flip_rows(codes, image);
    image.texels = image::Texels(std::move(codes));
  };
  if (header.bit_depth == 16) {
    image.depth = Depth::unorm16;
    decode(std::vector<std::uint16_t>());
  } else {
    decode(std::vector<std::uint8_t>());
  }
  return image;
}

} // namespace surfgrad::io::codec
