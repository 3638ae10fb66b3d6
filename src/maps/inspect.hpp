#pragma once

#include "image/image.hpp"
#include "maps/form.hpp"

#include <surfgrad/vec.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace surfgrad::maps {

/// How sure a finding is. Where data cannot tell, nothing is said.
enum class Confidence { cannot_tell, likely, certain };

/// What the texels of a map look like.
enum class Look {
  tangent_normals, ///< vectors of unit length about +z
  other_normals,   ///< of unit length in other directions: object or world space
  heights,         ///< one channel
  no_normals,      ///< vectors of any length: no normal map
};

/// Which way the green channel grows, found by what slopes have in common: a surface has no curl, d(dh/ds)/dt
/// = d(dh/dt)/ds, and a map whose green is turned over has both of opposite sign.
struct GreenFinding {
  Confidence confidence = Confidence::cannot_tell;
  stack::Green green = stack::Green::up; ///< relative to red: a relief that is turned over has the same curl
  /// 2 sum(a b) / sum(a^2 + b^2) of both derivatives, from -1 to 1: 1 for a surface, -1 for one whose green
  /// is turned over; the largest in magnitude of the map and of its halves and quarters.
  double agreement = 0;
  /// That over its standard error, which 8 by 8 parts of the map give.
  double certainty = 0;
};

/// Whether a map meets itself at its border.
struct Tiling {
  Confidence confidence = Confidence::cannot_tell;
  bool repeats = false;
  double seam =
      0; ///< root of the mean square step over the border, over the largest between two columns or rows
};

/// A map of normals beside the heights that it may have been made of.
struct AgainstHeights {
  Confidence confidence = Confidence::cannot_tell;
  vec2<double> correlation{0, 0}; ///< of the slopes, green as the map has it up
  double scale = 0;               ///< slope a unit of height per texel that fits best, of the axes together
  bool is_inverted = false;       ///< white is deep, or red grows to the left
  stack::Green green = stack::Green::up;
};

/// What there is to say of a map. What does not apply is empty or 0.
struct Inspection {
  Look look = Look::no_normals;
  Confidence look_confidence = Confidence::certain;
  double mean_length = 0;
  double length_deviation = 0; ///< root of the mean square
  double unit_share = 0;       ///< of texels with a length within 0.2 of 1
  std::int64_t inward = 0;     ///< z <= 0
  std::vector<int> constant_channels{};
  bool is_banded = false; ///< a file of 16 bits whose codes are those of 8
  // Of tangent-space normals, slopes being those of green up unless it is certain that it is down:
  GreenFinding green{};
  vec2<double> tilt{0, 0};    ///< mean slope
  double root_mean_slope = 0; ///< root of the mean square
  double steepest = 0;        ///< largest along an axis
  std::vector<double>
      hidden_roughness{}; ///< roughness that the slopes hidden by mip level 1, 2 ... amount to
  // Of all maps:
  Tiling along_s{};
  Tiling along_t{};
  std::optional<AgainstHeights> heights{};
};

/// Looks at a map. File names are no evidence.
///
/// heights  one channel that the map may have been made of, of any size; null: none is at hand
/// Throws InputError for values that are not finite. Same result for any number of threads.
[[nodiscard]] Inspection inspect(const image::Image& map, const image::Image* heights,
                                 const std::filesystem::path& file);

} // namespace surfgrad::maps
