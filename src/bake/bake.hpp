#pragma once

#include "bake/udim.hpp"
#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"
#include "stack/words.hpp"
#include "stage/backend.hpp"
#include "stage/bands.hpp"
#include "stage/stage.hpp"

#include <cstdint>

namespace surfgrad::bake {

/// Space of the baked normals.
enum class Space {
  tangent, ///< MikkTSpace of the UV set: what engines decode with the mesh's tangents
  object,
  world,
};

/// How a texel stands for a normal n.
enum class Encoding {
  rgb,        ///< n / 2 + 1/2
  rg,         ///< the first two of these; readers reconstruct z. Tangent space alone
  derivative, ///< slopes, as a layer `derivative_map` reads them. Tangent space alone
};

struct Options {
  int width = 1024;
  int height = 1024;
  Space space = Space::tangent;
  const stage::Backend* backend = nullptr; ///< composes in the engine's stead
  int uv_set = 0;
  UdimTile tile{}; ///< unit square of the UV set that the map covers
  /// Samples along each side of a texel. Slopes are averaged, each sample's in its own frame; of object and
  /// world space the normals. A texel counts as covered where one of its samples is.
  int samples = 1;
  /// Texels that no surface covers take the value of the nearest covered one within so many texels; 0: none.
  int padding = 0;
  bool fill = false; ///< all of them do instead, by pull and push: bake::Fill
  stack::Green green = stack::Green::up;
  Encoding encoding = Encoding::rgb;
  /// Encoding derivative: slope of the largest code, and the code that means flat; see the layer.
  double range = 1;
  stack::NeutralCode neutral = stack::NeutralCode::between;
  /// Encodings of two channels: a third one of 1, for files whose two channels would be grey and opacity.
  bool full_blue = false;
  /// What the map is to be written with: slopes are codes in integer files only.
  image::Depth depth = image::Depth::unorm16;
  /// Depth unorm8: values are codes already, dithered with blue noise where they are not flat.
  bool dither = false;
};

/// What was odd about a bake. Those after `samples` count samples.
struct Counts {
  std::int64_t covered = 0;     ///< texels
  std::int64_t padded = 0;      ///< texels that no surface covers, with the value of one that it does
  std::int64_t outside = 0;     ///< triangles that reach beyond [0, 1]^2: what lies there is not in the map
  std::int64_t samples = 0;     ///< that a surface covers; as many as texels where there is one a texel
  std::int64_t touched = 0;     ///< whose centre none covers: the nearest point of one that reaches into them
  std::int64_t overlapping = 0; ///< that more than one triangle covers; the lowest index wins
  /// Whose vertex frame (or, in object space, transform) cannot be inverted: (0, 0, 1), left out of means.
  std::int64_t singular = 0;
  std::int64_t clamped = 0;    ///< whose normal lies below the tangent plane: steepest slope
  std::int64_t degenerate = 0; ///< without a normal, or where a layer found no frame: it is flat
  /// Texels whose slope is beyond the encoding's range: it keeps its direction.
  std::int64_t beyond_range = 0;
  double steepest = 0; ///< encoding derivative: the largest slope along an axis
};

/// A map and what was odd about it.
struct Baked : Counts {
  image::Image map; ///< flat where no surface lies, unless padded
};

/// Bakes a scene's stack into one normal map over a UV set, at texel centres, and where none is covered at
/// the nearest point that lies in the texel; of a scene with a displacement it is a map for the displaced
/// mesh. Back faces do not occur: the surface is seen from its front.
///
/// Throws InputError when a mesh lacks the UV set, nothing lies in [0, 1]^2 or a layer depends on the viewer.
/// Same bytes for any number of threads.
[[nodiscard]] Baked bake(scene::Scene scene, const Options& options, const Report& report = {});

/// The same band by band, as they are done: memory does not grow with the map. A scene that is moved here
/// loses each image as soon as the last map is made of it. What throws because nothing is covered does so
/// after the last band.
Counts bake_bands(scene::Scene scene, const Options& options, const stage::BandSink& take,
                  const Report& report = {});

/// A scene made ready for bakes of one UV set in one space by one backend, of any tile and size: slopes with
/// mip levels, tangents. Takes and throws as bake_bands.
[[nodiscard]] stage::Stage stage_of(scene::Scene scene, const Options& options, const Report& report = {});
/// The same as of its scene.
///
/// stage  of options with the same UV set, space and backend
Counts bake_bands(const stage::Stage& stage, const Options& options, const stage::BandSink& take,
                  const Report& report = {});

} // namespace surfgrad::bake
