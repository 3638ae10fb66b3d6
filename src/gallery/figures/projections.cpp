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

stack::TriplanarLayer triplanar(scene::Scene& scene, Maps& maps, const char* name, double tile,
                                double scale) {
  stack::TriplanarLayer layer;
  layer.common.key = name;
  layer.common.scale = scale;
  layer.files = {maps.in(scene, name)};
  layer.map.tile = {tile, tile};
  return layer;
}

Figure figure_3_rock(const Shared& maps) {
  const auto panel = [maps](bool resolved) {
    return [maps, resolved] {
      scene::Scene scene = scene_of(rock_mesh());
      look_from(scene, 40, 8);
      light_from(scene, {-0.9, 0.7, 0.6});
      const stack::NormalMapLayer baked = normal_map(scene, *maps, "rock", {}, 1.6);
      stack::TriplanarLayer detail = triplanar(scene, *maps, "strata", 0.9, 1.2);
      detail.sharpness = 8;
      scene.materials[0].layers =
          resolved ? Layers{baked, stack::ResolveLayer{}, detail} : Layers{baked, detail};
      return scene;
    };
  };
  return {"figure-3-rock",
          "Triplanar detail by the mesh's normal and by the resolved one (figure 3, a and b)",
          "A coarse rock under its baked normal map, with layered rock projected along three axes. What a "
          "plane shows should depend on the direction of the surface, most of which is in the baked map.",
          {{"a", "(a) by the normal of the mesh",
            "The ledges take no notice of the crests of the baked map and lie over all alike.", Way::older,
            "b", panel(false)},
           {"b", "(b) after a resolve",
            "The bumped surface chooses the plane and carries the detail: ledges break at crests and belong "
            "to the flank they lie on.",
            Way::right, "", panel(true)}}};
}

Figure figure_3_parallax(const Shared& maps) {
  const auto panel = [maps](Layers (*detail)(scene::Scene&, Maps&)) {
    return [maps, detail] {
      scene::Scene scene = scene_of(barrel());
      scene.camera.position = vec3<double>{0.9, 1.5, 2.9};
      scene.camera.target = vec3<double>{0.1, -0.25, 0.1};
      light_from(scene, {-0.9, 0.55, 0.1});
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
       {"c", "(c) a detail normal map", "Fine grain that lies on each stone and turns with its flanks.",
        Way::right, "", panel([](scene::Scene& scene, Maps& m) {
          return Layers{normal_map(scene, m, "grain", {.tile = {2, 2}, .basis = stack::Basis::derived}, 1.2)};
        })},
       {"d", "(d) dents of turbulence",
        "A function of space, sampled on the virtual surface: dents run over tops and flanks alike, "
        "nowhere drawn out.",
        Way::right, "", panel([](scene::Scene&, Maps&) {
          stack::NoiseLayer dents;
          dents.common.key = "dents";
          dents.common.scale = -0.12;
          dents.noise = {.function = stack::NoiseKind::turbulence, .octaves = 4, .power = 3, .frequency = 9};
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
        stack::TriplanarLayer layer = triplanar(scene, *maps, "plates", 1, 1);
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
