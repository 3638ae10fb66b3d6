// Images of bumps projected onto whatever lies within a shape.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

stack::DecalLayer decal(scene::Scene& scene, Maps& maps, stack::DecalShape shape,
                        const stack::DecalInstance& where) {
  const bool around = shape == stack::DecalShape::sphere || shape == stack::DecalShape::capsule;
  stack::DecalLayer layer;
  layer.common.key = "decal";
  layer.shape = shape;
  layer.files = {maps.in(scene, around ? "letter cube" : "letter")};
  layer.falloff = 0.15;
  layer.instances = {where};
  return layer;
}

struct View {
  double yaw_deg = 8;
  double pitch_deg = 12;
  double zoom = 1;
};

using Body = SurfacePoint (*)(vec3<double>);

std::function<scene::Scene()> decal_on(const Shared& maps, Body body, const View& view,
                                       stack::DecalShape shape, const stack::DecalInstance& where) {
  return [=] {
    scene::Scene scene = scene_of(closed_surface(48, body));
    look_from(scene, view.yaw_deg, view.pitch_deg, view.zoom);
    light_from(scene, {-0.8, 0.7, 0.7});
    scene.materials[0].layers = {decal(scene, *maps, shape, where)};
    return scene;
  };
}

/// A decal that projects along -z.
stack::DecalInstance from_front(double z) {
  stack::DecalInstance where;
  where.position = {0, 0, z};
  where.direction = {0, 0, -1};
  return where;
}

Figure shapes(const Shared& maps) {
  using Shape = stack::DecalShape;
  stack::DecalInstance box = from_front(0);
  box.position = {0.9, 0, 0.9};
  box.direction = {-1, 0, -1};
  box.size = {1.5, 1.3, 1.4};
  stack::DecalInstance cone = from_front(2.4);
  cone.angle_deg = 40;
  cone.depth = 2.2;
  stack::DecalInstance sphere = from_front(0.45);
  sphere.radius = 0.7;
  stack::DecalInstance capsule = from_front(0.25);
  capsule.radius = 0.42;
  capsule.length = 0.8;
  stack::DecalInstance wedge = from_front(2.2);
  wedge.angle_deg = 42;
  wedge.depth = 1.5;
  wedge.length = 0.6;
  return {"decals",
          "Decals of five shapes",
          "A letter on a field of knobs, projected onto smooth bodies. The knobs show how far each shape "
          "reaches and how it fades out at its border.",
          {{"box", "box",
            "Parallel projection from the right, over an edge: the letter is drawn out where the "
            "surface turns away.",
            Way::choice, "", decal_on(maps, rounded_cube_point, {28, 18}, Shape::box, box)},
           {"cone", "cone", "Projected from a point in front, as by a lamp.", Way::choice, "",
            decal_on(maps, ball_point, {}, Shape::cone, cone)},
           {"sphere", "sphere", "A cube map seen from a point below the surface.", Way::choice, "",
            decal_on(maps, ball_point, {}, Shape::sphere, sphere)},
           {"wedge", "wedge",
            "A cone whose apex is drawn out to a line: the image's middle column fills what is between its "
            "two halves.",
            Way::choice, "", decal_on(maps, rounded_cube_point, {-20, 14}, Shape::wedge, wedge)},
           {"capsule", "capsule", "A sphere drawn out likewise, along the body's axis.", Way::choice, "",
            decal_on(maps, pill_point, {}, Shape::capsule, capsule)}}};
}

Figure blends(const Shared& maps) {
  const auto panel = [maps](stack::DecalBlend blend) {
    return [maps, blend] {
      scene::Scene scene = scene_of(rock_mesh());
      look_from(scene, 40, 8);
      light_from(scene, {-0.9, 0.7, 0.6});
      stack::DecalInstance where;
      where.position = {0.64, 0.1, 0.77};
      where.direction = {-0.64, -0.1, -0.77};
      where.size = {1.2, 1.2, 1.2};
      stack::DecalLayer layer = decal(scene, *maps, stack::DecalShape::box, where);
      layer.blend = blend;
      scene.materials[0].layers = {normal_map(scene, *maps, "rock", {}, 0.6), layer};
      return scene;
    };
  };
  return {"decal-blends",
          "A decal that adds, mixes or replaces",
          "A box with a letter on the rock, three ways to join it with the bumps below.",
          {{"add", "add", "The letter follows the rock: crests and clefts run through it.", Way::choice, "",
            panel(stack::DecalBlend::add)},
           {"mix", "mix", "The baked bumps are gone inside the box; the shape of the mesh is still shaded.",
            Way::choice, "", panel(stack::DecalBlend::mix)},
           {"replace", "replace", "The decal brings its own direction: a flat plaque, whatever is below it.",
            Way::choice, "", panel(stack::DecalBlend::replace)}}};
}

} // namespace

std::vector<Figure> decal_figures(const Shared& maps) { return {shapes(maps), blends(maps)}; }

} // namespace surfgrad::gallery
