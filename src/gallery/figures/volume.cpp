// Functions of space as bumps: no texture coordinate is needed.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

std::function<scene::Scene()> ball_under(const stack::NoiseLayer& layer) {
  return [layer] {
    scene::Scene scene = scene_of(closed_surface(32, ball_point));
    look_from(scene, 0, 12);
    light_from(scene, {-0.8, 0.7, 0.7});
    scene.materials[0].layers = {layer};
    return scene;
  };
}

stack::NoiseLayer noise(const stack::NoiseFunction& function, double scale) {
  stack::NoiseLayer layer;
  layer.common.key = "noise";
  layer.common.scale = scale;
  layer.noise = function;
  return layer;
}

Figure figure_1() {
  stack::NoiseLayer right = noise({.function = stack::NoiseKind::perlin, .frequency = 7}, 0.2);
  stack::NoiseLayer older = right;
  older.method = stack::NoiseMethod::perlin1985;
  return {
      "figure-1",
      "Perlin's perturbation of 1985 against the surface gradient (figure 1)",
      "A ball under strong noise. A bump may only tilt the normal by the slope along the surface, but the "
      "noise also changes across it.",
      {{"a", "(a) the whole gradient added",
        "Where the noise grows outwards the normal shrinks and falls over: spots with hard, dark rims, "
        "some lit from the wrong side. Where it falls outwards the relief is washed out.",
        Way::older, "b", ball_under(older)},
       {"b", "(b) its part along the surface", "Hills and hollows of one steepness all over the ball.",
        Way::right, "", ball_under(right)}}};
}

Figure noises() {
  using Kind = stack::NoiseKind;
  const auto panel = [](const char* id, const char* label, const char* look,
                        const stack::NoiseFunction& function, double scale) {
    return Panel{id, label, look, Way::choice, "", ball_under(noise(function, scale))};
  };
  return {
      "noise",
      "Noise of every kind",
      "Functions of space as heights over a ball: exact gradients, no texture, no seam, no pole.",
      {panel("perlin", "Perlin", "Hills and hollows of one size; on a closer look they keep to a lattice.",
             {.function = Kind::perlin, .frequency = 4}, 0.2),
       panel("simplex", "simplex", "Rounder, and without preferred directions.",
             {.function = Kind::simplex, .frequency = 2.5}, 0.25),
       panel("worley-f1", "Worley, F1",
             "The distance to the nearest point of many: pits that meet in sharp ridges.",
             {.function = Kind::worley, .worley = WorleyKind::f1, .frequency = 5}, 0.16),
       panel("worley-f2-f1", "Worley, F2 - F1",
             "How much farther the second nearest is: facets with sharp joints, like cracked mud.",
             {.function = Kind::worley, .worley = WorleyKind::f2_minus_f1, .frequency = 5}, 0.1),
       panel("turbulence", "turbulence", "Octaves of the noise's magnitude: billows between sharp creases.",
             {.function = Kind::turbulence, .octaves = 4, .frequency = 2}, 0.35),
       panel("ridged", "ridged",
             "Octaves of crests: the creases of turbulence turned to ridges, finely rough.",
             {.function = Kind::ridged, .octaves = 5, .gain = 0.45, .frequency = 2.2}, 0.2),
       panel("dented", "turbulence to the fourth power, inwards",
             "Power flattens what is low and deepens what is high: dents in a smooth ball.",
             {.function = Kind::turbulence, .octaves = 2, .power = 4, .frequency = 3}, -0.45)}};
}

} // namespace

std::vector<Figure> volume_figures(const Shared&) { return {figure_1(), noises()}; }

} // namespace surfgrad::gallery
