#pragma once

#include "image/texels.hpp"

#include <cstddef>

namespace surfgrad::image {

/// Sample precision of the file an image came from, or should be written with.
enum class Depth { unorm8, unorm16, half, float32 };

[[nodiscard]] constexpr bool is_integer(Depth depth) {
  return depth == Depth::unorm8 || depth == Depth::unorm16;
}

/// A picture as loaded: interleaved channels, before it becomes slopes, masks or heights.
///
/// Row 0 is the bottom row (texture origin lower left, t up); readers and writers flip at the edge.
/// Values of integer files are scaled to [0, 1] (code / 255 or code / 65535); those of float files are kept
/// as they are. No colour transform is ever applied: normal maps, heights and masks are data.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 0;            ///< 1 grey, 2 rg or grey+alpha, 3 rgb, 4 rgba
  Depth depth = Depth::unorm8; ///< precision of the source file
  bool has_alpha = false;      ///< the last channel is opacity: 2 is grey+alpha, else two data channels
  Texels texels{};             ///< width * height * channels, row 0 at the bottom

  [[nodiscard]] std::size_t index(int x, int y, int channel = 0) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(channel);
  }
  /// The channel that a request for r, g, b or a (0 to 3) reads: the last colour channel where the image
  /// lacks it; -1 for an alpha that it lacks, which reads as 1.
  [[nodiscard]] int source_of(int channel) const {
    const int colors = has_alpha ? channels - 1 : channels;
    if (channel == 3) return has_alpha ? channels - 1 : channels == 4 ? 3 : -1;
    return channel < colors ? channel : colors - 1;
  }
  [[nodiscard]] float& at(int x, int y, int channel) { return texels[index(x, y, channel)]; }
  [[nodiscard]] float at(int x, int y, int channel) const { return texels[index(x, y, channel)]; }
};

/// A black image of the given shape, in floats.
[[nodiscard]] inline Image make_image(int width, int height, int channels, Depth depth = Depth::unorm8) {
  Image image{width, height, channels, depth, false, {}};
  image.texels.floats().resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                               static_cast<std::size_t>(channels));
  return image;
}

} // namespace surfgrad::image
