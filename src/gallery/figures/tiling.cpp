// Large areas of a small map.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {

std::vector<Figure> tiling_figures(const std::shared_ptr<Maps>& maps) {
  const auto panel = [maps](stack::Tiling tiling, double turn_deg) {
    return [maps, tiling, turn_deg] {
      scene::Scene scene = scene_of(ground());
      scene.camera.position = vec3<double>{0, 4.2, 4.2};
      scene.camera.target = vec3<double>{0, 0, 0.6};
      light_from(scene, {-0.9, 0.5, 0.1});
      stack::NormalMapLayer layer =
          normal_map(scene, *maps, "crags", {.tile = {9, 9}, .basis = stack::Basis::derived});
      layer.map.tiling = tiling;
      layer.map.hex_turn_deg = turn_deg;
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  return {{"hex-tiling",
           "Hex tiling against repetition",
           "One small map of a rock face over a ground that takes 81 copies of it.",
           {{"plain", "repeated", "The same few crests stand in rows as far as one sees.", Way::older, "hex",
             panel(stack::Tiling::plain, 0)},
            {"hex", "hexagons, turned at random",
             "No rows. The sun is at the left for every hexagon: slopes are turned back after sampling.",
             Way::right, "", panel(stack::Tiling::hex, 180)},
            {"shifted", "hexagons, only shifted",
             "No rows either, but every crest runs in the few directions of the map: for maps with a grain.",
             Way::choice, "", panel(stack::Tiling::hex, 0)}}}};
}

} // namespace surfgrad::gallery
