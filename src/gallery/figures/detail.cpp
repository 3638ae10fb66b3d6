// What a second map, a second texture coordinate, masks and blends do.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

scene::Scene rock_scene(std::vector<stack::Layer> (*layers)(scene::Scene&, Maps&), const Shared& maps) {
  scene::Scene scene = scene_of(rock_mesh());
  look_from(scene, 40, 8);
  light_from(scene, {-0.9, 0.7, 0.6});
  scene.materials[0].layers = layers(scene, *maps);
  return scene;
}

constexpr Laid tiled{.uv = 1, .tile = {6, 6}, .basis = stack::Basis::derived};

Figure figure_2(const Shared& maps) {
  const auto panel = [maps](std::vector<stack::Layer> (*layers)(scene::Scene&, Maps&)) {
    return [maps, layers] { return rock_scene(layers, maps); };
  };
  return {
      "figure-2",
      "A baked map and a detail map on top (figure 2)",
      "A coarse rock takes its shape from a normal map baked over its first UV set. A second normal map, "
      "tiled over a second UV set, adds grain. Both become surface gradients and are simply added: the "
      "crests and clefts of the first stay as they are and carry the grain of the second.",
      {{"a", "(a) baked map and detail map", "Grain everywhere, equally strong on light and shaded flanks.",
        Way::right, "", panel([](scene::Scene& scene, Maps& m) {
          return std::vector<stack::Layer>{normal_map(scene, m, "rock"),
                                           normal_map(scene, m, "grain", tiled, 0.8)};
        })},
       {"b", "(b) baked map alone", "The same crests and clefts, smooth between them.", Way::choice, "",
        panel([](scene::Scene& scene, Maps& m) {
          return std::vector<stack::Layer>{normal_map(scene, m, "rock")};
        })},
       {"mesh", "the mesh itself", "All that is left without maps: 6912 triangles.", Way::choice, "",
        panel([](scene::Scene&, Maps&) { return std::vector<stack::Layer>{}; })}}};
}

Figure uv_sets(const Shared& maps) {
  const auto panel = [maps](const Laid& laid) {
    return [maps, laid] {
      scene::Scene scene = scene_of(rock_mesh());
      look_from(scene, 40, 8);
      light_from(scene, {-0.9, 0.7, 0.6});
      scene.materials[0].layers = {normal_map(scene, *maps, "rock", {}, 0.5),
                                   normal_map(scene, *maps, "plates", laid)};
      return scene;
    };
  };
  return {"uv-sets",
          "The unwrap against a second texture coordinate",
          "Where a renderer offers one tangent space, a detail map must lie on the unwrap that the baked map "
          "uses. A layer that derives its own frame can use any texture coordinate.",
          {{"unwrap", "detail on UV set 0, the unwrap",
            "The courses break off where two charts meet, and run another way on the other side.", Way::older,
            "tiling", panel({.uv = 0, .tile = {6, 4}, .basis = stack::Basis::mikktspace})},
           {"tiling", "detail on UV set 1, made for tiling", "Courses run around the whole rock.", Way::right,
            "", panel({.uv = 1, .tile = {8, 8}, .basis = stack::Basis::derived})}}};
}

Figure influences(const Shared& maps) {
  const auto panel = [maps](void (*change)(stack::NormalMapLayer&, scene::Scene&, Maps&)) {
    return [maps, change] {
      scene::Scene scene = scene_of(closed_surface(32, ball_point));
      look_from(scene, 0, 12);
      light_from(scene, {-0.8, 0.7, 0.7});
      const Laid plates{.uv = 1, .tile = {4, 4}};
      const Laid weave{.uv = 1, .tile = {12, 12}, .basis = stack::Basis::derived};
      stack::NormalMapLayer top = normal_map(scene, *maps, "weave", weave);
      change(top, scene, *maps);
      scene.materials[0].layers = {normal_map(scene, *maps, "plates", plates), top};
      return scene;
    };
  };
  const auto mask = [](stack::NormalMapLayer& top, scene::Scene& scene, Maps& m) {
    top.common.mask.emplace();
    top.common.mask->file = m.in(scene, "stripes");
    top.common.mask->uv = 1;
    top.common.mask->tile = {4, 1};
  };
  return {"influences",
          "Scale, mask and mix",
          "Plates with a weave on top. Surface gradients are vectors, so a layer is scaled, masked and mixed "
          "by plain arithmetic.",
          {{"add", "add", "The weave runs over the plates, their joints and rivets show through it.",
            Way::choice, "", panel([](stack::NormalMapLayer&, scene::Scene&, Maps&) {})},
           {"inverted", "add, scale -1",
            "Every thread of the weave has become a groove; the plates are as before.", Way::choice, "",
            panel([](stack::NormalMapLayer& top, scene::Scene&, Maps&) { top.common.scale = -1; })},
           {"masked", "add, masked", "The weave lies in bands. Between them the plates are untouched.",
            Way::choice, "", panel(+mask)},
           {"mixed", "mix, masked",
            "Where the mask is white the weave replaces the plates: no joint shows through the bands.",
            Way::choice, "", panel([](stack::NormalMapLayer& top, scene::Scene& scene, Maps& m) {
              top.common.mask.emplace();
              top.common.mask->file = m.in(scene, "stripes");
              top.common.mask->uv = 1;
              top.common.mask->tile = {4, 1};
              top.common.blend = stack::Blend::mix;
            })}}};
}

} // namespace

std::vector<Figure> detail_figures(const Shared& maps) {
  return {figure_2(maps), uv_sets(maps), influences(maps)};
}

} // namespace surfgrad::gallery
