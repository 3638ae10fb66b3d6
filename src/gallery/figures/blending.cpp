// Surface gradients added, beside the older ways to make one normal map of two.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

/// A ball under some maps, all laid alike.
std::function<scene::Scene()> ball_under(const Shared& maps, std::vector<const char*> names) {
  return [maps, names = std::move(names)] {
    scene::Scene scene = scene_of(closed_surface(32, ball_point));
    look_from(scene, 0, 0, 1.35);
    light_from(scene, {-0.8, 0.7, 0.7});
    for (const char* name : names)
      scene.materials[0].layers.push_back(normal_map(scene, *maps, name, {.uv = 1, .tile = {3, 3}}));
    return scene;
  };
}

Figure blending(const Shared& maps) {
  return {
      "blending",
      "Two detail maps, blended five ways",
      "Steep domes and fine ripples that cross them. The older ways turn two normal maps into one and "
      "need both on one texture coordinate; surface gradients are added on the surface. Look at the "
      "flanks of the domes and at the ripples on their steepest part.",
      {{"linear", "linear", "Mean of the vectors: domes and ripples both lose half their height.", Way::older,
        "surface-gradient", ball_under(maps, {"linear"})},
       {"udn", "UDN",
        "Over the first map's z alone: the ripples are too weak on the ground and too strong on the flanks.",
        Way::older, "surface-gradient", ball_under(maps, {"udn"})},
       {"whiteout", "whiteout",
        "Over the product of both z: on the flanks domes and ripples steepen each other beyond what either "
        "map says.",
        Way::older, "surface-gradient", ball_under(maps, {"whiteout"})},
       {"reoriented", "RNM",
        "The ripples are turned with the dome they lie on. That is a second surface on top of the first, "
        "and the order matters: see post-resolve bumps for the same wish.",
        Way::older, "surface-gradient", ball_under(maps, {"reoriented"})},
       {"surface-gradient", "surface gradient",
        "The sum of both heights: ripples of one size everywhere, domes as high as they were.", Way::right,
        "", ball_under(maps, {"studs", "ripples"})}}};
}

Figure blending_flat(const Shared& maps) {
  return {"blending-flat",
          "A flat layer must change nothing",
          "The domes alone, blended onto a map that is flat everywhere. A layer without relief has nothing "
          "to say, so every picture should look like the last one.",
          {{"linear", "linear, under a flat map", "The domes have sunk to half their slope.", Way::older,
            "surface-gradient", ball_under(maps, {"flat linear"})},
           {"udn", "UDN, under a flat map", "The rims of the domes, their steepest part, are flattened.",
            Way::older, "surface-gradient", ball_under(maps, {"flat udn"})},
           {"whiteout", "whiteout, under a flat map", "Unchanged: whiteout passes this test.", Way::choice,
            "", ball_under(maps, {"flat whiteout"})},
           {"reoriented", "RNM, under a flat map", "Unchanged: so does reoriented normal mapping.",
            Way::choice, "", ball_under(maps, {"flat reoriented"})},
           {"surface-gradient", "surface gradient, with a flat layer",
            "Unchanged, and in any order: a flat map's surface gradient is zero.", Way::right, "",
            ball_under(maps, {"flat", "studs"})}}};
}

} // namespace

std::vector<Figure> blending_figures(const Shared& maps) { return {blending(maps), blending_flat(maps)}; }

} // namespace surfgrad::gallery
