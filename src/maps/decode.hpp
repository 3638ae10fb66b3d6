#pragma once

#include "image/image.hpp"
#include "image/map.hpp"

#include <surfgrad/vec.hpp>

#include <cstdint>
#include <filesystem>

namespace surfgrad::maps {

/// What the texels of a map are.
enum class Holds {
  height,
  normal,        ///< of a tangent space
  derivative,    ///< slopes themselves
  object_normal, ///< of an object
};

/// How a map is read.
struct Reading {
  Holds holds = Holds::normal;
  image::NormalChannels channels = image::NormalChannels::automatic; ///< of normals
  bool green_up = true;
  bool flip_x = false;
  /// Of derivative maps: see image::make_derivative_map.
  double range = 1;
  image::NeutralCode neutral = image::NeutralCode::between;
  int height_channel = 0;       ///< 0 to 3 for r, g, b, a
  bool depth = false;           ///< heights count downwards: white is deep
  std::filesystem::path name{}; ///< for messages
};

/// Slopes read from a map.
struct ReadSlopes {
  image::Image slopes;            ///< two channels in floats: (dh/ds, dh/dt)
  std::int64_t inward_texels = 0; ///< z <= 0: no height field has them
};

/// Throws InputError for a map of fewer channels than what it holds needs, for values that are no numbers,
/// and for three-channel normals most of which no tangent-space normal map has: inward, or far from unit.
[[nodiscard]] ReadSlopes read_slopes(const image::Image& map, const Reading& reading);

/// The heights of a map, one channel in floats: 0 to 1 of integer files.
///
/// Throws InputError for values that are no numbers.
[[nodiscard]] image::Image read_heights(const image::Image& map, const Reading& reading);

/// Mean of the slopes.
[[nodiscard]] vec2<double> mean_slope(const image::Image& slopes);

/// Takes the mean slope away: the heights of a map that tiles do not rise from one side to the other.
void remove_mean_slope(image::Image& slopes);

} // namespace surfgrad::maps
