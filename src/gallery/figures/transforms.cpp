// Objects that are scaled and mirrored.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"
#include "mesh/mikktspace.hpp"

#include <utility>

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

vec3<float> times(vec3<double> s, vec3<float> v) {
  return {static_cast<float>(s.x * v.x), static_cast<float>(s.y * v.y), static_cast<float>(s.z * v.z)};
}

/// The mesh moved by hand as one should not: normals are multiplied by the scale as positions are, and
/// the tangents keep their handedness.
mesh::TriangleMesh scaled_carelessly(mesh::TriangleMesh mesh, vec3<double> scale) {
  mesh::TangentSpace tangents = mesh::generate_tangents(mesh, 0);
  const bool mirrored = scale.x * scale.y * scale.z < 0;
  for (vec3<float>& p : mesh.positions) p = times(scale, p);
  for (vec3<float>& n : mesh.normals) {
    const vec3<float> v = times(scale, n);
    const vec3<double> unit = normalize_or_zero(vec3<double>{v.x, v.y, v.z});
    n = times({1, 1, 1},
              {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
  }
  for (vec4<float>& t : tangents.corners) {
    const vec3<float> v = times(scale, {t.x, t.y, t.z});
    const vec3<double> unit = normalize_or_zero(vec3<double>{v.x, v.y, v.z});
    t = {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z), t.w};
  }
  if (mirrored) // turned over so that they face outwards again
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
      std::swap(tangents.corners[3 * i + 1], tangents.corners[3 * i + 2]);
    }
  mesh.tangent_spaces = {std::move(tangents)};
  return mesh;
}

mesh::TriangleMesh torus() { return scene::demo_scene().meshes[0]; }

using Layers = std::vector<stack::Layer> (*)(scene::Scene&, Maps&);

/// The torus under some layers, scaled as it should be or by hand.
std::function<scene::Scene()> torus_scaled(const Shared& maps, Layers layers, vec3<double> scale,
                                           bool carelessly = false) {
  return [=] {
    scene::Scene scene = scene_of(carelessly ? scaled_carelessly(torus(), scale) : torus());
    if (!carelessly) scene.objects[0].world_from_object = affine(scaling(scale));
    look_from(scene, 0, 42);
    light_from(scene, {-0.7, 0.9, 0.3});
    scene.materials[0].layers = layers(scene, *maps);
    return scene;
  };
}

std::vector<stack::Layer> plates(scene::Scene& scene, Maps& maps) {
  return {normal_map(scene, maps, "plates", {.tile = {4, 2}})};
}

std::vector<stack::Layer> domes(scene::Scene& scene, Maps& maps) {
  return {normal_map(scene, maps, "studs", {.tile = {3, 1}}, 0.7),
          normal_map(scene, maps, "ripples", {.tile = {2, 1}}, 0.25)};
}

} // namespace

std::vector<Figure> transform_figures(const Shared& maps) {
  const vec3<double> plain{1, 1, 1};
  const vec3<double> flat{1, 0.4, 1};
  const vec3<double> mirrored{-1, 1, 1};
  return {{"scaled",
           "An object scaled unevenly",
           "A torus under riveted plates. Its normals go through the cofactors of the object's transform, "
           "its tangents through the transform itself.",
           {{"plain", "as it is", "A round tube, lit from the upper left.", Way::choice, "",
             torus_scaled(maps, plates, plain)},
            {"right", "flattened to two fifths", "The top is nearly level and evenly lit; the rim is sharp.",
             Way::right, "", torus_scaled(maps, plates, flat)},
            {"wrong", "flattened, normals multiplied as positions are",
             "Normals lean outwards: the flat ring is shaded as if it were a steep hollow.", Way::wrong,
             "right", torus_scaled(maps, plates, flat, true)}}},
          {"mirrored",
           "An object mirrored",
           "A torus with domes and slanting ripples, mirrored left to right under the same sun. A mirroring "
           "transform also turns the handedness of the tangent frame.",
           {{"plain", "as it is", "Domes are raised, ripples fall to the right.", Way::choice, "",
             torus_scaled(maps, domes, plain)},
            {"right", "mirrored", "Domes are raised and lit as before; ripples climb to the right.",
             Way::right, "", torus_scaled(maps, domes, mirrored)},
            {"wrong", "mirrored, handedness kept",
             "Relief is inverted along the tube's girth: domes are lit from below.", Way::wrong, "right",
             torus_scaled(maps, domes, mirrored, true)}}}};
}

} // namespace surfgrad::gallery
