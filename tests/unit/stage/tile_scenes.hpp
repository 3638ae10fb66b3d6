#pragma once

/// Scenes that tiles are tried on, and all that their pixels show on one instruction set.

#include "scene/scene.hpp"
#include "simd/isa.hpp"
#include "support/random.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace surfgrad::stage::test {

/// A scene and the raster that it is composed on.
struct TileCase {
  std::string name{};
  scene::Scene scene{};
  bool texture = false; ///< as a bake, over UV set 0; else as a screen
  int side = 16;        ///< of the raster, in pixels
  int tile_side = 16;
};

/// Results of one number a pixel, as TileWork::Results has them.
inline constexpr std::array channels{"normal.x",
                                     "normal.y",
                                     "normal.z",
                                     "base_normal.x",
                                     "base_normal.y",
                                     "base_normal.z",
                                     "surfgrad.x",
                                     "surfgrad.y",
                                     "surfgrad.z",
                                     "to_viewer.x",
                                     "to_viewer.y",
                                     "to_viewer.z",
                                     "mesh_normal.x",
                                     "mesh_normal.y",
                                     "mesh_normal.z",
                                     "tangent.x",
                                     "tangent.y",
                                     "tangent.z",
                                     "sunlight",
                                     "degenerate",
                                     "sign",
                                     "s",
                                     "t"};

struct Composed {
  std::vector<std::int32_t> pixel{}; ///< number in the raster, tile by tile
  std::array<std::vector<float>, channels.size()> values{};

  [[nodiscard]] vec3<double> normal(std::size_t i) const {
    return {values[0][i], values[1][i], values[2][i]};
  }
};

/// Every output of every pixel, one tile after another.
[[nodiscard]] Composed composed_on(simd::Isa isa, const TileCase& tiles);

/// Objects of many triangles and of few, mirrored and stretched, one without a second UV set, one whose
/// normals cancel; the triangles of each take turns in two materials, of these layers and of none.
[[nodiscard]] TileCase case_of(std::vector<stack::Layer> layers, stack::BackFaces back_faces, bool texture);

/// Layers of every kind and in every way that a program treats differently; each alone is a stack.
struct NamedLayers {
  std::string name;
  std::vector<stack::Layer> layers;
};
[[nodiscard]] std::vector<NamedLayers> every_kind_alone();

/// All of them in one stack of several passes.
[[nodiscard]] std::vector<stack::Layer> every_kind_together();

/// Up to six of the layers above with other numbers on a small scene seen from anywhere.
[[nodiscard]] TileCase random_case(surfgrad::test::Random& random);

} // namespace surfgrad::stage::test
