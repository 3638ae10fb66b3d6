#pragma once

#include "image/image.hpp"

#include <surfgrad/scalar.hpp>

#include <cstdint>
#include <vector>

namespace surfgrad::image {

/// Which channels of a tangent-space normal map are believed.
enum class NormalChannels {
  automatic, ///< xy for two-channel images and for a constant third channel, else xyz
  xyz,       ///< three channels; the vector may have any length
  xy,        ///< two channels, z reconstructed for a unit vector
};

/// A map ready for sampling: float components, a full mip pyramid, whole 32-bit words.
///
/// What is filtered is what a level averages: slopes average linearly (a tilted map keeps its tilt
/// down to 1x1), normals do not, so normal maps become slopes before the pyramid is built.
struct Map {
  int components = 0;                       ///< floats a texel: 1 scalar, 2 slope, 3 direction
  int level_count = 0;                      ///< at least 1
  std::vector<std::uint32_t> words{};       ///< float bits, level after level, row 0 at the bottom
  std::vector<std::uint32_t> level_table{}; ///< width, height, first word: three words a level

  [[nodiscard]] int width(int level = 0) const { return static_cast<int>(level_table[3 * level]); }
  [[nodiscard]] int height(int level = 0) const { return static_cast<int>(level_table[3 * level + 1]); }
  [[nodiscard]] Words texels() const { return {words.data(), static_cast<std::int32_t>(words.size())}; }
  [[nodiscard]] Words levels() const {
    return {level_table.data(), static_cast<std::int32_t>(level_table.size())};
  }
};

/// A map together with what its texels were like.
struct SlopeMap {
  Map map{};
  NormalChannels channels = NormalChannels::xyz; ///< what `automatic` decided
  std::int64_t inward_texels = 0;                ///< z <= 0: no height field has them
};

/// Slopes of a tangent-space normal map (code values 0..1 mean -1..1).
///
/// image     at least two channels; three where `channels` is xyz
/// green_up  the map's green grows with t; false negates the second slope (section 2.1)
/// not finite texels of a float file are flat; with three channels they count as inward
/// source    derivative_from_normal, texel by texel
[[nodiscard]] SlopeMap make_slope_map(const Image& image, NormalChannels channels, bool green_up);

/// Which code of an integer derivative map means flat.
enum class NeutralCode {
  between, ///< 127.5 of 255 (32767.5 of 65535): codes span -range..range evenly, none is exactly flat
  whole,   ///< 128 (32768), as signed-normalised formats biased: (code - 128) / 127, code 0 as code 1
};

/// Slopes of a derivative map: its first two channels are (dh/ds, dh/dt) themselves.
///
/// image     at least two channels
/// range     slope of the largest code: integer files span -range..range. A float file's values are
///           slopes already, of either sign; they are multiplied by it.
/// green_up  the map's green grows with t; false negates the second slope
/// neutral   for integer files. `between` tilts a flat 8-bit map by range / 255; `whole` keeps it flat.
/// returns   slopes shortened along their direction to components within +-max_slope, as normal maps are;
///           not finite texels of a float file are flat
/// source    Mikkelsen 2019, section 2.1: what a normal map is converted to, stored as it is
[[nodiscard]] Map make_derivative_map(const Image& image, double range, bool green_up,
                                      NeutralCode neutral = NeutralCode::between);

/// Unit directions of an object- or world-space normal map; zero vectors stay zero, and so become
/// those that are not finite. The image must have at least three channels.
///
/// green_up  false negates the second component
[[nodiscard]] Map make_direction_map(const Image& image, bool green_up);

/// One channel as a map of weights within [0, 1]: a float file's values are clamped, NaN becomes 0. A
/// channel that the image lacks reads as the last one it has, except alpha, which reads as 1.
[[nodiscard]] Map make_channel_map(const Image& image, int channel);

} // namespace surfgrad::image
