// Relief that is there, beside relief that is only seen.

#include "displace/scene.hpp"
#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {
namespace {

using Shared = std::shared_ptr<Maps>;

// The highest stone: a fifth of its length.
constexpr double depth = 0.12;
constexpr vec2<double> laid{1, 1};

/// The paved sheet, every panel from the same place: displacement would change an automatic frame.
scene::Scene pavement(int cells) {
  scene::Scene scene = scene_of(sheet(cells, 0.35));
  scene.camera.position = vec3<double>{-0.45, 1.35, 2.35};
  scene.camera.target = vec3<double>{0.05, -0.12, 0};
  light_from(scene, {-0.8, 0.35, -0.5}, 4);
  return scene;
}

Figure parallax_figure(const Shared& maps) {
  const auto parallax = [maps](void (*change)(stack::ParallaxLayer&)) {
    return [maps, change] {
      scene::Scene scene = pavement(48);
      stack::ParallaxLayer layer;
      layer.common.key = "paving";
      layer.map.file = maps->in(scene, "paving");
      layer.map.tile = laid;
      layer.height = depth;
      layer.level = 1;
      change(layer);
      scene.materials[0].layers = {layer};
      return scene;
    };
  };
  const auto bump = [maps] {
    scene::Scene scene = pavement(48);
    stack::HeightMapLayer layer;
    layer.common.key = "paving";
    layer.map.file = maps->in(scene, "paving");
    layer.map.tile = laid;
    layer.height = depth;
    layer.taps = stack::Taps::bicubic;
    scene.materials[0].layers = {layer};
    return scene;
  };
  const auto displaced = [maps] {
    scene::Scene scene = pavement(48);
    stack::Displace displace;
    displace.map.emplace();
    displace.map->file = maps->in(scene, "paving");
    displace.map->tile = laid;
    displace.height = depth;
    displace.level = 1;
    displace.subdivide = 3;
    scene.displace = displace;
    return scene;
  };
  return {
      "parallax",
      "Parallax beside true displacement",
      "A gently curved sheet, paved with stones that are carved into it. Parallax moves what each pixel "
      "shows of the map; displacement moves the mesh. Compare stones in the middle of the sheet, then its "
      "border.",
      {{"bump", "bumps only", "Stones are shaded but flat: joints stay visible behind them.", Way::choice, "",
        bump},
       {"offset", "offset", "One step by the height under the pixel: at the far side stones smear.",
        Way::older, "occlusion",
        parallax([](stack::ParallaxLayer& l) { l.method = stack::ParallaxMethod::offset; })},
       {"limited", "offset, limited",
        "Shorter steps: less smearing, and less depth; joints are too wide and nothing hides them.",
        Way::older, "occlusion", parallax([](stack::ParallaxLayer& l) {
          l.method = stack::ParallaxMethod::offset;
          l.limit_offset = true;
        })},
       {"occlusion", "occlusion",
        "Stones hide the joints behind them, as on the displaced mesh. The outline is that of the smooth "
        "sheet: straight, with the relief cut off at it.",
        Way::right, "", parallax([](stack::ParallaxLayer&) {})},
       {"self-shadow", "occlusion with self shadow",
        "The same, and joints lie in the shadow of the stones. (Nothing else casts shadows here, nor does "
        "the displaced mesh.)",
        Way::choice, "", parallax([](stack::ParallaxLayer& l) { l.self_shadow = true; })},
       {"displaced", "displaced mesh",
        "The relief itself: its border is uneven. Away from the border it is the picture of occlusion.",
        Way::right, "", displaced}}};
}

stack::NoiseFunction lumps() {
  stack::NoiseFunction noise;
  noise.function = stack::NoiseKind::fractal_sum;
  noise.octaves = 2;
  noise.frequency = 2;
  noise.offset = {0.3, 0.1, 0.7};
  return noise;
}
constexpr double lump_height = 0.22;

enum class Normals { derived, stale };

/// A ball that noise has moved. The finer noise is left to a layer, which reads it where the surface was.
scene::Scene lumpy_ball(bool displaced, Normals normals, bool bumped) {
  scene::Scene scene = scene_of(closed_surface(24, ball_point));
  scene.camera.position = vec3<double>{0, 0.8, 4.2};
  scene.camera.target = vec3<double>{0, 0, 0};
  light_from(scene, {-0.8, 0.8, 0.5});
  if (displaced) {
    stack::Displace displace;
    displace.noise = lumps();
    displace.height = lump_height;
    displace.subdivide = 2;
    displace.edges = stack::Edges::curved;
    scene.displace = displace;
    scene = displace::displaced(scene)->scene;
  }
  if (normals == Normals::stale)
    for (std::size_t i = 0; i < scene.meshes[0].normals.size(); ++i) // of the ball: where it was, was up
      scene.meshes[0].normals[i] = scene.meshes[0].rest_positions[i];
  std::vector<stack::Layer>& layers = scene.materials[0].layers;
  if (!displaced) {
    stack::NoiseLayer layer;
    layer.common.key = "lumps";
    layer.noise = lumps();
    layer.common.scale = lump_height;
    layers.emplace_back(layer);
  }
  if (bumped) {
    stack::NoiseLayer layer;
    layer.common.key = "grain";
    layer.noise.function = stack::NoiseKind::fractal_sum;
    layer.noise.frequency = 11;
    layer.noise.octaves = 3;
    layer.common.scale = 0.014;
    layers.emplace_back(layer);
  }
  return scene;
}

Figure noise_figure() {
  const auto panel = [](bool displaced, Normals normals, bool bumped) {
    return [=] { return lumpy_ball(displaced, normals, bumped); };
  };
  return {"displaced-noise",
          "Displacement by noise and bumps by finer noise",
          "A ball displaced by noise of two octaves. The gradient of the noise gives the displaced normals "
          "without looking at a neighbour; a finer noise then perturbs those per pixel.",
          {{"displaced", "displaced, normals from the gradient", "Smooth lumps, shaded as they are shaped.",
            Way::choice, "", panel(true, Normals::derived, false)},
           {"bumped", "displaced and bumped", "The lumps carry grain, equally strong on all of them.",
            Way::right, "", panel(true, Normals::derived, true)},
           {"stale", "displaced, normals of the ball",
            "The outline has lumps; inside there is only the shading of a smooth ball under the grain.",
            Way::wrong, "bumped", panel(true, Normals::stale, true)},
           {"bumps-only", "both as bumps",
            "The same lumps and grain on a ball that is still round: right inside, wrong at the outline.",
            Way::choice, "", panel(false, Normals::derived, true)}}};
}

} // namespace

std::vector<Figure> displacement_figures(const Shared& maps) {
  return {parallax_figure(maps), noise_figure()};
}

} // namespace surfgrad::gallery
