#pragma once

#include "bake/roughness.hpp"
#include "image/image.hpp"
#include "maps/differentiate.hpp"
#include "maps/form.hpp"

#include <surfgrad/vec.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace surfgrad::maps {

/// What becomes of a map.
struct Conversion {
  Form from{};
  Form to{};
  Kernel kernel = Kernel::bspline;
  Border border = Border::repeat;
  /// Slope of heights that rise by 1 (from black to white) within a texel. Without it height maps rise by
  /// 0.02 of their width, and heights that are made fill 0 to 1.
  std::optional<double> slope_scale{};
  bool retile = false; ///< the mean slope goes
  int width = 0;       ///< 0: as it is
  int height = 0;
  image::Depth depth = image::Depth::unorm16; ///< of the file to be
  bool dither = false;                        ///< to unorm8, where a texel is not flat
  bool mips = false;                          ///< also every half of the size, down to 1x1
  /// Also the roughness that the slopes lost within texels amount to, on top of this one.
  std::optional<bake::BaseRoughness> base_roughness{};
};

/// A converted map, and what was odd about it.
struct Converted {
  image::Image map{};
  std::vector<image::Image> mips{};      ///< of mean slopes or heights: levels 1, 2, ...
  std::vector<image::Image> roughness{}; ///< of each level, one channel; where slopes are written
  double slope_scale = 0; ///< that was used between heights and slopes, or found; 0 where neither has heights
  std::int64_t inward = 0;  ///< texels of normals with z <= 0: read as if it was positive
  std::int64_t clamped = 0; ///< beyond what the new form can hold
  double steepest = 0;      ///< largest slope along an axis, where there are slopes
  /// Heights made of slopes: see Integrated.
  std::optional<double> not_integrable{};
  std::optional<vec2<double>> tilt{}; ///< mean slope that was left out
  bool is_rearranged = false;         ///< vectors are as they were, whatever their length
};

/// Converts between heights, tangent-space normals and derivatives, through slopes. Where nothing but the
/// arrangement of a normal or height map changes, its texels are kept as they are: a flip of green is its own
/// inverse, 8-bit codes stay exact in 16 bits.
///
/// source  of the roughness: bake::widened_alpha of all normals in a texel's area
/// file    that the map came from, for messages
/// Same result for any number of threads. Throws InputError as read_slopes and read_heights do.
[[nodiscard]] Converted convert(const image::Image& map, const Conversion& conversion,
                                const std::filesystem::path& file);
/// The same, for a map whose texels are needed no more: they go as soon as they are read.
[[nodiscard]] Converted convert(image::Image&& map, const Conversion& conversion,
                                const std::filesystem::path& file);

} // namespace surfgrad::maps
