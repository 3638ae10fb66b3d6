// Maps projected through space, and detail on a surface that is itself bumped or moved.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

#include <cmath>
#include <numbers>

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;
using Layers = std::vector<stack::Layer>;

Figure figure_3_rock(const Shared& maps) {
  const auto panel = [maps](bool detailed, bool resolved) {
    return [maps, detailed, resolved] {
      scene::Scene scene = scene_of(rock_mesh());
      look_from(scene, 40, 22);
      light_from(scene, {-0.9, 0.7, 0.6});
      stack::ObjectNormalMapLayer baked;
      baked.common.key = "ledges";
      baked.map.file = maps->in(scene, "ledged rock");
      Layers layers{baked};
      if (resolved) layers.push_back(stack::ResolveLayer{});
      stack::TriplanarLayer detail;
      detail.common.key = "detail";
      detail.common.scale = 0.9;
      const stack::FileName rough = maps->in(scene, "grain");
      detail.files = {rough, maps->in(scene, "ripples"), rough};
      detail.map.tile = {0.6, 0.6};
      detail.sharpness = 8;
      if (detailed) layers.push_back(detail);
      scene.materials[0].layers = layers;
      return scene;
    };
  };
  return {"figure-3-rock",
          "Triplanar detail by the mesh's normal and by the resolved one (figure 3, a and b)",
          "A rock whose ledges are in its baked normal map alone. Three planes are projected on it: ripples "
          "from above, grain from the sides. Which one a point shows should depend on its direction.",
          {{"baked", "the baked map alone", "Level ledges between steep flanks.", Way::choice, "",
            panel(false, false)},
           {"a", "(a) planes by the normal of the mesh",
            "Ripples cover what is up on the mesh, a cap, and run over ledges and flanks alike.", Way::older,
            "b", panel(true, false)},
           {"b", "(b) planes by the normal after a resolve",
            "Ripples lie on every ledge, down to the lowest, and grain on every flank.", Way::right, "",
            panel(true, true)}}};
}

Figure figure_3_parallax(const Shared& maps) {
  const auto panel = [maps](Layers (*detail)(scene::Scene&, Maps&)) {
    return [maps, detail] {
      scene::Scene scene = scene_of(barrel());
      scene.camera.position = vec3<double>{0.9, 1.5, 2.5};
      scene.camera.target = vec3<double>{0.1, -0.4, 0.1};
      light_from(scene, {-0.9, 0.5, 0.15});
      stack::ParallaxLayer cobbles;
      cobbles.common.key = "cobbles";
      cobbles.map.file = maps->in(scene, "cobbles");
      cobbles.map.tile = {0.5, 0.5};
      cobbles.height = 0.16;
      cobbles.level = 1;
      cobbles.self_shadow = true;
      Layers layers{cobbles};
      for (const stack::Layer& layer : detail(scene, *maps)) layers.push_back(layer);
      scene.materials[0].layers = layers;
      return scene;
    };
  };
  return {
      "figure-3-parallax",
      "Detail on the surface that parallax shows (figure 3, c and d)",
      "Cobbles of a height map on a smooth curved sheet. Parallax puts a virtual surface in place of "
      "the mesh; its own normal is the base for whatever follows.",
      {{"none", "parallax alone",
        "Stones hide what is behind them and cast shadows, and are smooth as plaster.", Way::choice, "",
        panel([](scene::Scene&, Maps&) { return Layers{}; })},
       {"c", "(c) a detail normal map",
        "Grain lies on each stone and turns with its flanks; where they are steep it is drawn out, for it "
        "has the sheet's texture coordinate.",
        Way::right, "", panel([](scene::Scene& scene, Maps& m) {
          return Layers{normal_map(scene, m, "grain", {.tile = {1, 1}, .basis = stack::Basis::derived}, 0.8)};
        })},
       {"d", "(d) dents of turbulence",
        "A function of space, sampled on the virtual surface: dents run over tops and flanks alike, "
        "nowhere drawn out.",
        Way::right, "", panel([](scene::Scene&, Maps&) {
          stack::NoiseLayer dents;
          dents.common.key = "dents";
          dents.common.scale = -0.13;
          dents.noise = {.function = stack::NoiseKind::turbulence, .octaves = 3, .power = 3, .frequency = 6};
          return Layers{dents};
        })}}};
}

mat3<double> turned_about_y(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return {{std::cos(a), 0, std::sin(a)}, {0, 1, 0}, {-std::sin(a), 0, std::cos(a)}};
}

Figure projections(const Shared& maps) {
  const auto panel = [maps](bool planar, stack::Space space, double turned) {
    return [maps, planar, space, turned] {
      scene::Scene scene = scene_of(closed_surface(48, rounded_cube_point));
      scene.objects[0].world_from_object = affine(turned_about_y(turned));
      look_from(scene, 20, 28);
      light_from(scene, {-0.7, 0.9, 0.6});
      if (!planar) {
        stack::TriplanarLayer layer;
        layer.common.key = "plates";
        layer.files = {maps->in(scene, "plates")};
        layer.space = space;
        scene.materials[0].layers = {layer};
        return scene;
      }
      stack::PlanarLayer layer;
      layer.common.key = "plates";
      layer.file = maps->in(scene, "plates");
      layer.axis = PlaneAxis::y;
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  return {"projections",
          "Projected maps",
          "A cube with rounded edges and no texture coordinates in use, turned by 35 degrees in the last two "
          "pictures.",
          {{"planar", "planar, along y", "Plates on the top alone; the sides do not face the projection.",
            Way::choice, "", panel(true, stack::Space::object, 0)},
           {"triplanar", "triplanar", "Each side carries plates, blended where the edges round.", Way::choice,
            "", panel(false, stack::Space::object, 0)},
           {"object", "triplanar, object space, turned", "The plates have turned with the cube.", Way::choice,
            "", panel(false, stack::Space::object, 35)},
           {"world", "triplanar, world space, turned",
            "The plates stayed with the world: those on the top run askew, those on the sides are two "
            "projections blended.",
            Way::choice, "", panel(false, stack::Space::world, 35)}}};
}

} // namespace

std::vector<Figure> projection_figures(const Shared& maps) {
  return {figure_3_rock(maps), figure_3_parallax(maps), projections(maps)};
}

} // namespace surfgrad::gallery
