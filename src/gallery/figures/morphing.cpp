// A mesh that changes its shape, and the tangents that should have changed with it.

#include "gallery/figures.hpp"
#include "gallery/morphs.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

constexpr int cells = 128; // fine enough that no triangle of the derived frame is seen

scene::Scene studded(const Shared& maps, mesh::TriangleMesh mesh, stack::Basis basis) {
  scene::Scene scene = scene_of(std::move(mesh));
  look_from(scene, 0, 0, 1.5);
  light_from(scene, {-0.8, 0.7, 0.6});
  scene.materials[0].layers = {
      normal_map(scene, *maps, "studs", {.uv = 0, .tile = {2, 2}, .basis = basis}, 0.8)};
  return scene;
}

} // namespace

std::vector<Figure> morphing_figures(const Shared& maps) {
  const auto panel = [maps](MorphedTangents tangents, stack::Basis basis) {
    return [maps, tangents, basis] { return studded(maps, morphed_sheet(cells, tangents), basis); };
  };
  const auto rest = [maps] { return studded(maps, flat_sheet(cells), stack::Basis::mikktspace); };
  using stack::Basis;
  return {{"morphing",
           "A morphed mesh: stale, blended and derived tangents",
           "A studded sheet is swirled, stretched and bulged by three morph targets at once. Positions and "
           "normals are right in every picture; only the tangents of the normal map differ. All domes are "
           "raised, and "
           "the sun stands at the upper left.",
           {{"rest", "before the morph", "Round domes in rows, all lit at the upper left.", Way::choice, "",
             rest},
            {"stale", "tangents of the shape before",
             "The middle has turned by a right angle and the light on its domes has not: right of the middle "
             "they "
             "are lit at the lower left.",
             Way::wrong, "derived", panel(MorphedTangents::stale, Basis::mikktspace)},
            {"blended", "tangents blended as positions are",
             "Differences of unit vectors forget how far each target stretches. The light has turned too "
             "far: right "
             "of the middle domes are lit at the upper right.",
             Way::older, "derived", panel(MorphedTangents::blended, Basis::mikktspace)},
            {"derived", "derived per pixel", "All domes are lit at the upper left. No tangents are needed.",
             Way::right, "", panel(MorphedTangents::recomputed, Basis::derived)},
            {"recomputed", "MikkTSpace of the morphed mesh",
             "The truth, at the price of new tangents for every pose: the picture of the derived frame.",
             Way::right, "", panel(MorphedTangents::recomputed, Basis::mikktspace)}}}};
}

} // namespace surfgrad::gallery
