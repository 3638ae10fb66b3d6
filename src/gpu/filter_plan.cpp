#include "gpu/filter_plan.hpp"

#include <surfgrad/derivative.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace surfgrad::gpu {
namespace {

using Gradient = FilterPlan::Gradient;
using Weight = FilterPlan::Weight;

constexpr double unknown = std::numeric_limits<double>::infinity();
constexpr Gradient unknown_gradient{unknown, unknown, 0, unknown};
constexpr double steepest_slope = max_slope * std::numbers::sqrt2; // both components

/// Of an error, by later passes, with which a bound still says something: a noise as steep as it could be
/// anywhere makes it far larger than what is ever seen.
constexpr double most_growth = 4;

/// Nothing of something unknown is nothing.
double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }

/// A quantity of the sum after a layer has joined it. The sum depends on the weight linearly: it is largest
/// at one end of the weight's range.
double joined(double sum, const Weight& w, double of_layer) {
  const double own = times(w.opacity * w.scale, of_layer);
  return w.mix ? std::max(sum, times(1 - w.opacity, sum) + own) : sum + own;
}

/// Bounds of a noise's value and gradient, one octave of it (the core documents them).
struct NoiseReach {
  double value, gradient;
};
NoiseReach reach_of(stack::NoiseBasis basis, WorleyKind worley) {
  switch (basis) {
  case stack::NoiseBasis::simplex:
    return {1, 6.97};
  case stack::NoiseBasis::worley:
    return {1, worley == WorleyKind::f1 ? 1.0 : 2.0};
  case stack::NoiseBasis::perlin:
    break;
  }
  return {1.0364, 3.75};
}

/// Most of the gradient of a function of space.
double steepest(const stack::NoiseFunction& f) {
  const NoiseReach octave = reach_of(stack::basis_of(f), f.worley);
  const bool sums = f.function == stack::NoiseKind::fractal_sum ||
                    f.function == stack::NoiseKind::turbulence || f.function == stack::NoiseKind::ridged;
  const bool ridged =
      f.function == stack::NoiseKind::ridged; // (1 - |value|)^2, of which |value| is near 1 at most
  NoiseReach sum{0, 0};
  double frequency = 1, amplitude = 1;
  for (int i = 0; i < (sums ? f.octaves : 1); ++i) {
    sum.value += amplitude * (ridged ? 1 : octave.value);
    sum.gradient += amplitude * frequency * (ridged ? 2 : 1) * octave.gradient;
    frequency *= f.lacunarity;
    amplitude *= f.gain;
  }
  // Below 1 a power is vertical where the function is 0.
  if (f.power != 1)
    sum.gradient = f.power < 1 ? unknown : f.power * std::pow(sum.value, f.power - 1) * sum.gradient;
  return f.frequency * sum.gradient;
}

/// Slopes, or derivatives of heights, that a map is read for: how they follow from its texels.
struct MapReach {
  double gain, steepest;
};

/// Of hex tiles the steeper prevail: their weights follow the slopes in no simple way.
MapReach of_slopes(const engine::TiledMap& tiled) {
  return {tiled.hex_turn ? unknown : 1, tiled.map->encoded ? steepest_slope : longest_texel(*tiled.map)};
}

MapReach of_bumps(const engine::BumpMap& bumps) {
  if (!bumps.heights) return of_slopes(bumps.tiled);
  if (bumps.tiled.hex_turn) return {unknown, unknown}; // tiles of maps that are not square shear
  const double by_height =
      std::abs(bumps.height) * std::max(std::abs(bumps.tiled.tile.x), std::abs(bumps.tiled.tile.y));
  return {by_height, by_height * longest_texel(*bumps.tiled.map)};
}

MapReach of_scale_free(const engine::HeightMap& layer) {
  const image::Map& map = *layer.texture.tiled.map;
  const double by_map =
      std::abs(layer.height) * std::max(1.0, static_cast<double>(map.width()) / map.height());
  const double most = by_map * longest_texel(map);
  // What is limited to the steepest slope, or blended with a spline, follows its texels in no simple way.
  const bool plain = !layer.smooth && !layer.texture.tiled.hex_turn && most <= max_slope;
  return plain ? MapReach{by_map, most} : MapReach{unknown, steepest_slope};
}

/// The surface below a pass.
struct Base {
  /// What vertex frames go by: the mesh's normals, those where a parallax has moved the point without
  /// bumps, or those of a pass, to which they are turned.
  enum class Frames { mesh, moved, turned };

  const MeshReach& mesh;
  bool even;
  Frames frames = Frames::mesh;
  double tilt_rad = 0; ///< of the normal against the mesh's
};

/// A slope on a tangent frame.
Gradient on_frame(const MapReach& slope, int slot, bool derived, const Base& base) {
  const MeshReach::Slot& vertex = base.mesh.slots[static_cast<std::size_t>(slot)];
  if (base.frames == Base::Frames::moved && !derived) return {unknown, unknown, unknown, unknown};
  if (base.frames == Base::Frames::mesh && !derived) {
    const double length = base.mesh.tangent_length;
    return {times(slope.gain, length), times(slope.steepest, length),
            times(slope.steepest, vertex.along_normal), 0};
  }
  if (base.frames == Base::Frames::mesh) return {slope.gain, slope.steepest, 0, 0};
  const double tilt = base.tilt_rad + (derived ? base.mesh.tilt_rad : vertex.tangent_tilt_rad);
  constexpr double upright = std::numbers::pi / 2;
  return {slope.gain, slope.steepest, 0, tilt < upright ? slope.steepest / std::cos(tilt) : unknown};
}

/// A volume gradient. Under an uneven transform it leans off the tangent plane.
Gradient in_space(const MapReach& gradient, bool world, const Base& base) {
  return {gradient.gain, gradient.steepest, world || base.even ? 0 : unknown, gradient.steepest};
}

Gradient gradient_of(const engine::NormalMap& layer, const Base& base) {
  return on_frame(of_slopes(layer.texture.tiled), layer.texture.slot, layer.derived, base);
}
Gradient gradient_of(const engine::HeightMap& layer, const Base& base) {
  if (layer.kind == engine::HeightMap::Kind::scale_free)
    return on_frame(of_scale_free(layer), layer.texture.slot, layer.derived, base);
  Gradient g = unknown_gradient;
  if (layer.kind == engine::HeightMap::Kind::object_units && !base.even) g.lean = unknown;
  return g;
}
Gradient gradient_of(const engine::ObjectNormalMap&, const Base&) { return unknown_gradient; }
Gradient gradient_of(const engine::VolumeNoise& layer, const Base& base) {
  const bool known = !layer.perlin1985 && !layer.custom;
  const double most = known ? times(std::abs(layer.scale), steepest(layer.noise)) : unknown;
  Gradient g = in_space({0, most}, layer.world, base);
  if (layer.perlin1985) g.lean = 0;
  return g;
}
Gradient gradient_of(const engine::Planar& layer, const Base& base) {
  return in_space(of_bumps(layer.bumps), layer.world, base);
}
Gradient gradient_of(const engine::Triplanar& layer, const Base& base) {
  if (layer.whole_normals) return unknown_gradient;
  MapReach most{0, 0};
  for (const engine::BumpMap& bumps : layer.planes) { // blended by weights of sum 1
    const MapReach each = of_bumps(bumps);
    most = {std::max(most.gain, each.gain), std::max(most.steepest, each.steepest)};
  }
  Gradient g = in_space(most, layer.world, base);
  if (base.frames != Base::Frames::mesh) g.turn = unknown; // the weights follow the normal
  return g;
}
/// How many lie over each other is not known.
Gradient gradient_of(const engine::Decals& layer, const Base& base) {
  Gradient g = unknown_gradient;
  if (!layer.world && !base.even) g.lean = unknown;
  return g;
}
Gradient gradient_of(const engine::Parallax&, const Base&) { return unknown_gradient; }
Gradient gradient_of(const engine::Resolve&, const Base&) { return {}; }

template <class Kind>
Weight weight_of(const Kind& layer) {
  if constexpr (requires { layer.influence; })
    return {layer.influence.opacity, std::abs(layer.influence.scale), layer.influence.mix};
  return {};
}

} // namespace

FilterPlan::FilterPlan(const engine::Program& program, const MeshReach& mesh, bool even) {
  Base base{mesh, even};
  Gradient sum{};
  const auto close_pass = [&] {
    Pass& pass = passes_.back();
    pass.distance = std::max(1 - sum.lean, 0.0);
    pass.growth *= (1 + sum.turn) / pass.distance;
    base.tilt_rad += std::atan2(sum.steepest, pass.distance);
    base.frames = Base::Frames::turned;
    sum = {};
    passes_.emplace_back();
  };
  passes_.emplace_back();
  for (const auto& each : program.layers)
    std::visit(
        [&](const auto& kind) {
          using Kind = std::decay_t<decltype(kind)>;
          if constexpr (std::is_same_v<Kind, engine::Resolve> || std::is_same_v<Kind, engine::Parallax>)
            close_pass();
          if constexpr (std::is_same_v<Kind, engine::Parallax>) {
            passes_.back().growth = unknown; // what it shows follows the normal in no simple way
            base.tilt_rad = unknown;
            if (!kind.height_normal) base.frames = Base::Frames::moved;
          }
          const Gradient g = gradient_of(kind, base);
          const Weight w = weight_of(kind);
          const double mask_gain = times(w.opacity, times(w.scale, g.steepest) + (w.mix ? sum.steepest : 0));
          layers_.push_back({w, g.gain, mask_gain, passes_.size() - 1});
          if constexpr (!std::is_same_v<Kind, engine::Parallax>)
            sum = {0, joined(sum.steepest, w, g.steepest), joined(sum.lean, w, g.lean),
                   joined(sum.turn, w, g.turn)};
        },
        each);
  close_pass();
  passes_.pop_back();
}

double FilterPlan::growth_after(std::size_t pass) const {
  double growth = 1;
  for (std::size_t later = pass + 1; later < passes_.size(); ++later) growth *= passes_[later].growth;
  return growth;
}

bool FilterPlan::follows(const shadergen::MapSite& site) const {
  const Layer& layer = layers_[site.layer];
  return std::isfinite(site.mask ? layer.mask_gain : layer.gain) && passes_[layer.pass].distance > 0 &&
         growth_after(layer.pass) <= most_growth;
}

void FilterPlan::count(const shadergen::MapSite& site, double error) {
  Layer& layer = layers_[site.layer];
  double& counted = site.mask ? layer.mask_error : layer.error;
  counted = std::max(counted, error);
}

double FilterPlan::largest_angle() const {
  std::vector<double> of_pass(passes_.size());
  for (const Layer& layer : layers_) {
    double& sum = of_pass[layer.pass];
    sum =
        joined(sum, layer.weight, times(layer.gain, layer.error)) + times(layer.mask_gain, layer.mask_error);
  }
  double angle = 0;
  for (std::size_t i = 0; i < passes_.size(); ++i)
    if (of_pass[i] > 0) angle += of_pass[i] / passes_[i].distance * growth_after(i);
  return std::min(angle, std::numbers::pi);
}

} // namespace surfgrad::gpu
