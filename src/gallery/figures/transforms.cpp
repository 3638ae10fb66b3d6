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

scene::Scene shown(scene::Scene scene, Maps& maps) {
  look_from(scene, 0, 42);
  light_from(scene, {-0.7, 0.9, 0.3});
  scene.materials[0].layers = {normal_map(scene, maps, "plates", {.tile = {4, 2}})};
  return scene;
}

mesh::TriangleMesh torus() { return scene::demo_scene().meshes[0]; }

} // namespace

std::vector<Figure> transform_figures(const Shared& maps) {
  const auto right = [maps](vec3<double> scale) {
    return [maps, scale] {
      scene::Scene scene = scene_of(torus());
      scene.objects[0].world_from_object = affine(scaling(scale));
      return shown(std::move(scene), *maps);
    };
  };
  const auto wrong = [maps](vec3<double> scale) {
    return [maps, scale] { return shown(scene_of(scaled_carelessly(torus(), scale)), *maps); };
  };
  const vec3<double> flat{1, 0.4, 1};
  const vec3<double> mirrored{-1, 1, 1};
  return {{"transforms",
           "Objects scaled unevenly and mirrored",
           "A torus under riveted plates. Normals go through the cofactors of the object's transform, "
           "tangents through the transform itself, and a mirroring turns the handedness of the frame.",
           {{"plain", "as it is", "Rivets and plates are raised, the sun stands at the upper left.",
             Way::choice, "", right({1, 1, 1})},
            {"flattened", "flattened to two fifths", "The ring's top faces up and is evenly lit.", Way::right,
             "", right(flat)},
            {"flattened-wrong", "flattened, normals multiplied as positions are",
             "Normals lean sideways: the shape looks rounder than its outline, the light sits too low.",
             Way::wrong, "flattened", wrong(flat)},
            {"mirrored", "mirrored", "The plain picture with left and right exchanged, under the same sun.",
             Way::right, "", right(mirrored)},
            {"mirrored-wrong", "mirrored, handedness kept",
             "Along one direction the relief is inverted: rivets are dents on one pair of sides.", Way::wrong,
             "mirrored", wrong(mirrored)}}}};
}

} // namespace surfgrad::gallery
