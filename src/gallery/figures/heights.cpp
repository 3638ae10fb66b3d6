// Height maps: what their heights are measured in, and how their slopes are found.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

stack::HeightMapLayer heights(scene::Scene& scene, Maps& maps, const char* name, vec2<double> tile) {
  stack::HeightMapLayer layer;
  layer.common.key = name;
  layer.map.file = maps.in(scene, name);
  layer.map.tile = tile;
  return layer;
}

/// A slab under a low sun, which makes steepness visible.
scene::Scene slab() {
  scene::Scene scene = scene_of(sheet(1));
  look_from(scene, 0, 58);
  light_from(scene, {-0.9, 0.6, -0.5});
  return scene;
}

Figure tiled_heights(const Shared& maps) {
  const auto panel = [maps](stack::HeightMode mode, vec2<double> tile) {
    return [maps, mode, tile] {
      scene::Scene scene = slab();
      stack::HeightMapLayer layer = heights(scene, *maps, "paving", tile);
      layer.mode = mode;
      // The slab is two wide: laid on once, a height of 0.05 is 0.025 of the map's width.
      layer.height = mode == stack::HeightMode::physical ? 0.05 : 0.025;
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  using stack::HeightMode;
  return {
      "tiled-heights",
      "Heights that are real, and heights that stand for slopes",
      "The same map of stones on a slab, laid on once and laid on 8 times across and 2 times along. "
      "Physical heights displace the surface: stones that are narrower at the same height are steeper. "
      "Scale-free heights are slopes, as in a normal map.",
      {{"physical", "physical, tile 1", "Low stones with soft shoulders.", Way::choice, "",
        panel(HeightMode::physical, {1, 1})},
       {"physical-tiled", "physical, tile [8, 2]",
        "Narrow stones as high as before: their left and right flanks are eight times as steep, their "
        "front and back only twice.",
        Way::choice, "", panel(HeightMode::physical, {8, 2})},
       {"scale-free", "scale-free, tile 1", "The same as physical heights on this size of slab.", Way::choice,
        "", panel(HeightMode::scale_free, {1, 1})},
       {"scale-free-tiled", "scale-free, tile [8, 2]",
        "Narrow stones with the soft shoulders of the large ones: they have become lower with their width.",
        Way::choice, "", panel(HeightMode::scale_free, {8, 2})}}};
}

Figure scaled_heights(const Shared& maps) {
  const auto panel = [maps](double scale, stack::HeightMode mode, stack::Units units) {
    return [maps, scale, mode, units] {
      scene::Scene scene = scene_of(closed_surface(32, ball_point));
      scene.objects[0].world_from_object = affine(scaling({scale, scale, scale}));
      look_from(scene, 0, 12);
      light_from(scene, {-0.8, 0.7, 0.7});
      stack::HeightMapLayer layer = heights(scene, *maps, "paving", {5, 5});
      layer.map.uv = 1;
      layer.mode = mode;
      layer.units = units;
      // A map is 2 pi / 5 wide at the equator: 0.04 of that is as high as the physical heights.
      layer.height = mode == stack::HeightMode::physical ? 0.05 : 0.04;
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  using stack::HeightMode;
  using stack::Units;
  return {
      "scaled-heights",
      "A ball of stones, and the same ball four times as large",
      "Each picture frames its ball, so that the large one looks as large as the small one. What tells them "
      "apart is how high the stones are beside the ball.",
      {{"small", "the ball as it is", "Stones of height 0.05 on a ball of radius 1.", Way::choice, "",
        panel(1, HeightMode::physical, Units::scene)},
       {"scene", "four times as large, heights in units of the scene",
        "Still 0.05 high on a radius of 4: seen from as far as it takes to see the whole, the stones are "
        "nearly flat.",
        Way::choice, "", panel(4, HeightMode::physical, Units::scene)},
       {"object", "four times as large, heights in units of the object",
        "The heights have grown with the ball: the picture of the small one.", Way::choice, "",
        panel(4, HeightMode::physical, Units::object)},
       {"scale-free", "four times as large, scale-free heights",
        "Slopes know no size either: the same at the equator. Towards the poles, where the map is "
        "squeezed, physical stones get steeper, these do not.",
        Way::choice, "", panel(4, HeightMode::scale_free, Units::scene)}}};
}

Figure magnified_heights(const Shared& maps) {
  const auto panel = [maps](stack::Taps taps, stack::Filter filter) {
    return [maps, taps, filter] {
      scene::Scene scene = slab();
      stack::HeightMapLayer layer = heights(scene, *maps, "coarse heights", {1, 1});
      layer.map.filter = filter;
      layer.taps = taps;
      layer.height = 0.5;
      scene.camera.zoom = 1.4;
      light_from(scene, {-0.9, 0.45, -0.2});
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  using stack::Filter;
  using stack::Taps;
  return {
      "magnified-heights",
      "A height map of 16x16 texels, magnified",
      "A texel covers more than twenty pixels across. What a renderer takes for the slope between texels "
      "decides what is seen of them.",
      {{"nearest", "three taps without a filter", "Texels are flat: all slope is in the lines between them.",
        Way::wrong, "bicubic", panel(Taps::three, Filter::nearest)},
       {"one", "one tap a pixel, linear filter",
        "Linear heights have facets: the light breaks along the edges of the texels. A block of 2x2 samples "
        "shares one slope; at two samples a pixel that is a pixel, and the picture is nearly that of three "
        "taps.",
        Way::older, "bicubic", panel(Taps::one, Filter::trilinear)},
       {"three", "three taps, linear filter",
        "The same facets: every sample measures its own slope, which is that of its texel.", Way::older,
        "bicubic", panel(Taps::three, Filter::trilinear)},
       {"bicubic", "bicubic", "The slope of a smooth surface through the same texels.", Way::right, "",
        panel(Taps::bicubic, Filter::trilinear)}}};
}

} // namespace

std::vector<Figure> height_figures(const Shared& maps) {
  return {tiled_heights(maps), scaled_heights(maps), magnified_heights(maps)};
}

} // namespace surfgrad::gallery
