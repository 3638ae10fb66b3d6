#pragma once

#include "image/image.hpp"
#include "stack/words.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace surfgrad::maps {

/// What the texels of a map are.
enum class Kind {
  height,
  normal,     ///< tangent-space normals n, as n / 2 + 1/2
  derivative, ///< slopes
};

/// Channels of a file by their numbers, r to a as 0 to 3.
struct Channels {
  int count = 0; ///< up to 3; 0: not said
  std::array<int, 3> channel{};
};

/// Up to three different letters of r, g, b and a. Throws std::invalid_argument for anything else.
[[nodiscard]] Channels channels_of(std::string_view letters);

/// How a file holds them.
struct Form {
  Kind kind = Kind::normal;
  /// Those of x and y, of x, y and z, or of the height. Not said: in order; z is then reconstructed where a
  /// map that is read has two channels or a constant third one.
  Channels channels{};
  stack::Green green = stack::Green::up; ///< whether y grows with its channel
  bool flips_x = false;                  ///< x grows against its channel
  bool is_depth = false;                 ///< heights: 1 lies deepest
  /// Writing: channels up to the third are there, for files whose two are grey and opacity.
  bool is_filled = false;
  double range = 1; ///< derivatives: slope of the largest code
  stack::NeutralCode neutral = stack::NeutralCode::between;
};

/// Slopes of a map, and what was odd about it.
struct Slopes {
  image::Image map{};      ///< (dh/ds, dh/dt), two channels of floats
  std::int64_t inward = 0; ///< texels of normals with z <= 0, which no surface has
};

/// Slopes of a map of normals or derivatives. `file` names it in errors.
///
/// source  derivative_from_normal
/// errors  InputError for channels that the map lacks and for values that are not finite, with the texel
[[nodiscard]] Slopes read_slopes(const image::Image& map, const Form& form,
                                 const std::filesystem::path& file);

/// Vectors of normal maps are near unit length, within this of 1, but for somewhat short ones, where they
/// were filtered, and backgrounds: 0.7 to 1 of them in maps that are known, where colours have up to 0.66.
inline constexpr double near_unit = 0.2;
inline constexpr double least_unit_share = 0.6;

/// Whether vectors that point into the surface are those of a map.
enum class Inward {
  allowed, ///< in object space
  refused, ///< but for a few texels
};

/// Refuses a picture whose three channels are no normals: most of its vectors are far from unit length, or
/// point into the surface. What holds no three components of normals passes. Errors else as read_slopes.
void require_normals(const image::Image& map, const Form& form, Inward inward,
                     const std::filesystem::path& file);

/// Heights of a map, one channel of floats: 0 to 1 in integer files, as they are in float files. Errors as
/// above.
[[nodiscard]] image::Image read_heights(const image::Image& map, const Form& form,
                                        const std::filesystem::path& file);

/// What a file is to hold its values with.
struct Precision {
  image::Depth depth = image::Depth::unorm16;
  bool dithers = false; ///< of 8 bits: blue noise in place of terraces, but for flat texels
};

/// A map to be written.
struct Written {
  image::Image map{}; ///< codes, of integer depths
  std::int64_t clamped =
      0; ///< texels beyond what the form can hold: steeper than the range, heights outside 0 to 1
  double steepest = 0; ///< largest slope along an axis
};

/// Slopes as normals or derivatives.
[[nodiscard]] Written write_slopes(const image::Image& slopes, const Form& form, Precision precision);
/// Heights, one channel.
[[nodiscard]] Written write_heights(const image::Image& heights, const Form& form, Precision precision);

/// Where the channels of a map go that is only rearranged.
struct Arrangement {
  struct Source {
    int channel = -1;   ///< of the map that is read; -1: white
    bool flips = false; ///< against the middle of the values
  };
  bool is_only_that = false; ///< else the forms hold different things, and the rest says nothing
  int channels = 0;
  bool has_alpha = false; ///< the opacity of a map of normals, which stays where no form says its channels
  std::array<Source, 4> sources{};
};

/// Throws InputError for channels that the map lacks, for values that are not finite, and where it holds
/// three channels that are no normals: most vectors are far from unit length.
[[nodiscard]] Arrangement arrangement_of(const image::Image& map, const Form& from, const Form& to,
                                         const std::filesystem::path& file);

/// Normals in another arrangement of channels and with another direction of x and y, their vectors as they
/// are: the same texels. Flips of codes are their own inverses.
///
/// to  as arrangement_of was asked
[[nodiscard]] image::Image rearranged(const image::Image& map, const Arrangement& arrangement, const Form& to,
                                      Precision precision);

} // namespace surfgrad::maps
