#pragma once

#include "image/image.hpp"
#include "image/uninitialised.hpp"

#include <surfgrad/scalar.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace surfgrad::image {

/// Which channels of a tangent-space normal map are believed.
enum class NormalChannels {
  automatic, ///< xy for two-channel images and for a constant third channel, else xyz
  xyz,       ///< three channels; the vector may have any length
  xy,        ///< two channels, z reconstructed for a unit vector
};

/// How a texel lies in the words of a map.
enum class TexelFormat {
  floats,  ///< a word a component
  slope16, ///< one word: two signed 16-bit codes, ds in the low half
  unorm16, ///< one word: the texel's unsigned code in the low half, its right neighbour's in the high half
};

/// A map ready for sampling: a full mip pyramid of texels in one format, whole 32-bit words.
///
/// What is filtered is what a level averages: slopes average linearly (a tilted map keeps its tilt
/// down to 1x1), normals do not, so normal maps become slopes before the pyramid is built.
///
/// Every row of texels ends with a copy of its first, and every level with a copy of its first row (the
/// right neighbour of that copy is the row's first texel again). So the four texels of a linear filter lie
/// at the same distances everywhere, over the border of a map that repeats too; for other wraps the copies
/// have no weight.
struct Map {
  int components = 0; ///< 1 scalar, 2 slope, 3 direction, at most 4
  TexelFormat format = TexelFormat::floats;
  double scale = 1;     ///< value of the code 1; of slopes a power of two
  bool encoded = false; ///< texels are normals, to become slopes after they are filtered
  int level_count = 0;  ///< at least 1
  UninitialisedVector<std::uint32_t> words{}; ///< level after level, row 0 at the bottom
  std::vector<std::uint32_t> level_table{};   ///< width, height, first word: three words a level

  [[nodiscard]] int width(int level = 0) const { return static_cast<int>(level_table[3 * level]); }
  [[nodiscard]] int height(int level = 0) const { return static_cast<int>(level_table[3 * level + 1]); }
  [[nodiscard]] int texel_words() const { return format == TexelFormat::floats ? components : 1; }
  /// Word of a texel; x up to width and y up to height, the copies.
  [[nodiscard]] std::size_t word(int level, int x, int y) const {
    const std::size_t row = static_cast<std::size_t>(y) * (static_cast<std::size_t>(width(level)) + 1);
    return level_table[3 * static_cast<std::size_t>(level) + 2] +
           (row + static_cast<std::size_t>(x)) * static_cast<std::size_t>(texel_words());
  }
  /// A component of a texel, as the sampler in double reads it.
  [[nodiscard]] double value(int level, int x, int y, int component = 0) const;
  [[nodiscard]] Words texels() const { return {words.data(), static_cast<std::int32_t>(words.size())}; }
  [[nodiscard]] Words levels() const {
    return {level_table.data(), static_cast<std::int32_t>(level_table.size())};
  }
};

/// No side of a map is longer: texel positions and their halves are then exact in float.
inline constexpr int map_most_texels = 1 << 22;

/// Words of a map with its pyramid. They are counted by 32-bit integers: a map that needs more than 2^31 - 1
/// cannot be made.
[[nodiscard]] std::int64_t words_of_map(int width, int height, int texel_words);

/// A map together with what its texels were like.
struct SlopeMap {
  Map map{};                                     ///< of slopes, or of encoded normals
  NormalChannels channels = NormalChannels::xyz; ///< what `automatic` decided
  std::int64_t inward_texels = 0;                ///< z <= 0: no height field has them
};

/// Called with rows of an image, first to end - 1, that have been read for the last time, from any thread;
/// not for every row.
using RowsRead = std::function<void(int first, int end)>;

/// Slopes of a tangent-space normal map (code values 0..1 mean -1..1).
///
/// image     at least two channels; three where `channels` is xyz
/// green_up  the map's green grows with t; false negates the second slope (section 2.1)
/// not finite texels of a float file are flat; with three channels they count as inward
/// returns   slope16 for 8-bit files without slopes of 4 or more, else floats. slope16 rounds a component by
///           at most 2^-14 (6.1e-5), less than a hundredth of the step from code to code.
/// source    derivative_from_normal, texel by texel
[[nodiscard]] SlopeMap make_slope_map(const Image& image, NormalChannels channels, bool green_up,
                                      const RowsRead& read = {});

/// The same normal map kept as it is encoded, components from -1 to 1 and levels that average those: what
/// graphics hardware filters. It flattens tilted bumps and lets long vectors outweigh short ones; it is
/// here to show what others show.
[[nodiscard]] SlopeMap make_encoded_map(const Image& image, NormalChannels channels, bool green_up);

/// Second moments of a map of slopes, beside its means: components (ds^2, dt^2, ds * dt), each level
/// averaging them as it averages slopes. So a sample of both is SlopeMoments of what was filtered together.
///
/// slopes  two components, not encoded. Its own texels are squared: level 0 has no variance.
[[nodiscard]] Map make_slope_moments(const Map& slopes);

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
///           not finite texels of a float file are flat. In the formats of make_slope_map.
/// source    Mikkelsen 2019, section 2.1: what a normal map is converted to, stored as it is
[[nodiscard]] Map make_derivative_map(const Image& image, double range, bool green_up,
                                      NeutralCode neutral = NeutralCode::between, const RowsRead& read = {});

/// Unit directions of an object- or world-space normal map; zero vectors stay zero, and so become
/// those that are not finite. The image must have at least three channels.
///
/// green_up  false negates the second component
[[nodiscard]] Map make_direction_map(const Image& image, bool green_up);

/// One channel as a map of weights within [0, 1]: a float file's values are clamped, NaN becomes 0. A
/// channel that the image lacks reads as the last one it has, except alpha, which reads as 1. Integer files
/// become unorm16, which holds their codes exactly and rounds coarser levels by at most 2^-17.
[[nodiscard]] Map make_channel_map(const Image& image, int channel);

} // namespace surfgrad::image
