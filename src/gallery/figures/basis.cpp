// Which frame a tangent-space normal map is read in.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

/// Tangents as shader snippets derive them: the direction of +s over each triangle as it is, not
/// brought into the plane of the interpolated normal, and without the sign that tells mirrored texture
/// coordinates.
mesh::TangentSpace raw_tangents(const mesh::TriangleMesh& mesh) {
  mesh::TangentSpace space;
  for (const auto& triangle : mesh.triangles) {
    const auto position = [&](std::size_t i) {
      const vec3<float> p = mesh.positions[triangle[i]];
      return vec3<double>{p.x, p.y, p.z};
    };
    const auto st = [&](std::size_t i) {
      const vec2<float> v = mesh.uv_sets[0][triangle[i]];
      return vec2<double>{v.x, v.y};
    };
    const vec3<double> e1 = position(1) - position(0);
    const vec3<double> e2 = position(2) - position(0);
    const vec2<double> d1 = st(1) - st(0);
    const vec2<double> d2 = st(2) - st(0);
    const double side = cross(d1, d2) < 0 ? -1 : 1;
    const vec3<double> t = normalize_or_zero(side * (d2.y * e1 - d1.y * e2));
    const vec4<float> corner{static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z), 1};
    space.corners.insert(space.corners.end(), 3, corner);
  }
  return space;
}

Figure bases(const Shared& maps) {
  const auto panel = [maps](stack::Basis basis, bool raw) {
    return [maps, basis, raw] {
      mesh::TriangleMesh torus = half_mirrored_torus();
      if (raw) torus.tangent_spaces = {raw_tangents(torus)};
      scene::Scene scene = scene_of(std::move(torus));
      look_from(scene, 0, 42);
      light_from(scene, {-0.7, 0.9, 0.3});
      scene.materials[0].layers = {
          normal_map(scene, *maps, "studs", {.uv = 0, .tile = {4, 2}, .basis = basis}, 0.8)};
      return scene;
    };
  };
  return {
      "bases",
      "Vertex tangents, derived frame, and a frame derived carelessly",
      "A torus of few triangles whose left half uses the texture mirrored. All domes are raised, and the "
      "sun stands at the upper left.",
      {{"vertex", "MikkTSpace at the vertices", "Every dome is lit on its left, shaded on its right.",
        Way::right, "", panel(stack::Basis::mikktspace, false)},
       {"derived", "derived per fragment, projected and signed",
        "The same picture without any vertex tangents.", Way::right, "", panel(stack::Basis::derived, false)},
       {"careless", "derived without projection and sign",
        "On the mirrored half relief is inverted along the ring: domes are lit as dents are. The missing "
        "projection is the lesser fault; it tilts the frame a little from triangle to triangle.",
        Way::wrong, "derived", panel(stack::Basis::mikktspace, true)}}};
}

Figure spaces(const Shared& maps) {
  const auto panel = [maps](const char* map, bool as_object, stack::Space space) {
    return [maps, map, as_object, space] {
      scene::Scene scene = scene_of(rock_mesh());
      look_from(scene, 40, 8);
      light_from(scene, {-0.9, 0.7, 0.6});
      if (!as_object) {
        scene.materials[0].layers = {normal_map(scene, *maps, map)};
        return scene;
      }
      stack::ObjectNormalMapLayer layer;
      layer.common.key = map;
      layer.map.file = maps->in(scene, map);
      layer.space = space;
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  return {"spaces",
          "A normal map belongs to a space",
          "The rock's shape as a tangent-space map and as an object-space map, and what happens when the "
          "one is read as the other.",
          {{"tangent", "tangent-space map", "The rock as it was baked.", Way::right, "",
            panel("rock", false, stack::Space::object)},
           {"object", "object-space map",
            "The same rock: the vectors of the map are whole normals and become surface gradients, too.",
            Way::right, "", panel("rock object", true, stack::Space::object)},
           {"untransformed", "tangent-space map, untransformed",
            "Read as normals of the world: every side looks as if it faced the front, and relief and "
            "lighting belong to nothing.",
            Way::wrong, "tangent", panel("rock", true, stack::Space::world)}}};
}

} // namespace

std::vector<Figure> basis_figures(const Shared& maps) { return {bases(maps), spaces(maps)}; }

} // namespace surfgrad::gallery
