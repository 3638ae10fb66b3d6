#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"
#include "stage/backend.hpp"
#include "stage/bands.hpp"

#include <cstdint>

namespace surfgrad::bake {

/// Space of the baked normals.
enum class Space {
  tangent, ///< MikkTSpace of UV set 0, green up: what engines decode with the mesh's tangents
  object,
  world,
};

struct Options {
  int width = 1024;
  int height = 1024;
  Space space = Space::tangent;
  const stage::Backend* backend = nullptr; ///< composes in the engine's stead
};

/// What was odd about a bake.
struct Counts {
  std::int64_t covered = 0;
  std::int64_t outside = 0;     ///< triangles that reach beyond [0, 1]^2: what lies there is not in the map
  std::int64_t overlapping = 0; ///< texels that more than one triangle covers; the lowest index wins
  /// Texels whose vertex frame (or, in object space, transform) cannot be inverted: (0, 0, 1).
  std::int64_t singular = 0;
  std::int64_t clamped = 0;    ///< texels whose normal lies below the tangent plane: steepest slope
  std::int64_t degenerate = 0; ///< texels without a normal, or where a layer found no frame: it is flat
};

/// A map and what was odd about it.
struct Baked : Counts {
  image::Image map; ///< rgb, n / 2 + 1/2; (0, 0, 1) where no surface lies
};

/// Bakes a scene's stack into one normal map over UV set 0, at texel centres; of a scene with a
/// displacement it is a map for the displaced mesh. Back faces do not occur: the surface is seen from its
/// front.
///
/// Throws InputError when a mesh has no UV set 0 or nothing lies in [0, 1]^2. Same bytes for any
/// number of threads.
[[nodiscard]] Baked bake(scene::Scene scene, const Options& options, const Report& report = {});

/// The same band by band, as they are done: memory does not grow with the map. A scene that is moved here
/// loses each image as soon as the last map is made of it. What throws because nothing is covered does so
/// after the last band.
Counts bake_bands(scene::Scene scene, const Options& options, const stage::BandSink& take,
                  const Report& report = {});

} // namespace surfgrad::bake
