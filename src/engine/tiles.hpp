#pragma once

#include "engine/program.hpp"
#include "raster/interpolate.hpp"
#include "raster/tile_scan.hpp"

#include <surfgrad/frame.hpp>

namespace surfgrad::engine {

/// Pixels of one surface and one material in a tile, and where what its layers make of them goes.
///
/// Arrays hold `count` values. Those of results have room for most_lanes more, which the last pack may fill.
struct TileWork {
  const Program* program = nullptr;
  const Placement* placement = nullptr;
  BackFaces back_faces = BackFaces::same;
  raster::Wanted wanted{};
  const raster::Surface* surface = nullptr;
  std::span<const raster::TileScan::Shown> shown{}; ///< triangles
  const raster::TriangleSetup* setups = nullptr;    ///< one for each of them
  int count = 0;
  const std::int32_t* which = nullptr; ///< the triangle of each pixel
  const float* x = nullptr;            ///< raster positions: pixel centres
  const float* y = nullptr;

  /// Results; null where not wanted.
  struct Results {
    vec3<float*> normal{};      ///< composed
    vec3<float*> base_normal{}; ///< the mesh's: Composition::base_normal
    vec3<float*> surfgrad{};    ///< Composition::surfgrad
    float* sunlight = nullptr;
    float* degenerate = nullptr; ///< 1 or 0
    // Of the fragment, before any layer moves it:
    vec3<float*> to_viewer{};
    vec3<float*> mesh_normal{}; ///< interpolated, any length; zero where it is absent
    vec3<float*> tangent{};     ///< of the texture coordinate `slot`, interpolated
    float* sign = nullptr;
    vec2<float*> st{};
    std::size_t slot = 0;
  } results{};
};

/// Composes the pixels with the instruction set in use. Same bytes on all of them but the reference, which
/// makes fragments and composes them in double, one at a time.
void compose_tile(const TileWork& work);

} // namespace surfgrad::engine
