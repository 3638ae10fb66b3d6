#include "exported/truth.hpp"

#include "support/angle.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace surfgrad::shadergen::test {
namespace {

using raster::Fragment;

void filter_encoded(stack::Filter& filter) {
  if (filter != stack::Filter::nearest) filter = stack::Filter::normal;
}

std::vector<stack::Layer> filtered_as_encoded(std::vector<stack::Layer> layers) {
  for (stack::Layer& layer : layers)
    std::visit(
        [](auto& l) {
          using Kind = std::decay_t<decltype(l)>;
          if constexpr (std::is_same_v<Kind, stack::NormalMapLayer>) filter_encoded(l.map.filter);
          if constexpr (std::is_same_v<Kind, stack::PlanarLayer> || std::is_same_v<Kind, stack::DecalLayer>)
            if (l.map.content == stack::Content::normal) filter_encoded(l.map.filter);
          if constexpr (std::is_same_v<Kind, stack::TriplanarLayer>)
            if (l.map.content == stack::TriplanarContent::normal) filter_encoded(l.map.filter);
        },
        layer);
  return layers;
}

BackFaces back_faces_of(stack::BackFaces mode) {
  return mode == stack::BackFaces::flip     ? BackFaces::flip
         : mode == stack::BackFaces::mirror ? BackFaces::mirror
                                            : BackFaces::same;
}

/// The fragment with one number after the other a little off.
std::vector<Fragment<double>> neighbours(const Fragment<double>& f) {
  constexpr double some_roundings = 8 * 0x1p-24;
  std::vector<Fragment<double>> all;
  const auto with = [&](const auto& change) {
    for (const double sign : {-1.0, 1.0}) {
      all.push_back(f);
      change(all.back(), sign * some_roundings);
    }
  };
  const double size = std::max({1.0, max_abs(f.position), max_abs(f.object_position)});
  for (const auto axis : {&vec3<double>::x, &vec3<double>::y, &vec3<double>::z})
    with([&](Fragment<double>& g, double d) {
      g.position.*axis += d * size;
      g.object_position.*axis += d * size;
    });
  for (int slot = 0; slot < f.slots; ++slot) {
    const auto of = [slot](Fragment<double>& g) -> raster::UvFragment<double>& {
      return g.uvs[static_cast<std::size_t>(slot)];
    };
    const double range = std::max(1.0, max_abs(f.uvs[static_cast<std::size_t>(slot)].st));
    for (const auto axis : {&vec2<double>::x, &vec2<double>::y})
      for (const auto what : {&raster::UvFragment<double>::st, &raster::UvFragment<double>::dst_dx,
                              &raster::UvFragment<double>::dst_dy})
        with([&](Fragment<double>& g, double d) { of(g).*what.*axis += d * range; });
  }
  return all;
}

} // namespace

Truth::Truth(const std::vector<stack::Layer>& layers, stack::BackFaces back_faces,
             const std::vector<raster::UvSlot>& slots, engine::MapLibrary& maps)
    : program_(engine::compile(filtered_as_encoded(layers), slots, maps)),
      back_faces_(back_faces_of(back_faces)) {}

engine::Composition<double> Truth::composed(const Sample& sample) const {
  return engine::compose(program_, sample.fragment, back_faces_, sample.placement);
}

double Truth::turn_by_rounding(const Sample& sample) const {
  const vec3<double> n = composed(sample).normal;
  double most = 0;
  for (const Fragment<double>& f : neighbours(sample.fragment))
    most = std::max(most, surfgrad::test::unit_angle(composed({f, sample.placement}).normal, n));
  return most;
}

void Comparison::add(const Comparison& other) {
  mean = (count * mean + other.count * other.mean) / std::max(count + other.count, 1);
  count += other.count;
  worst = std::max(worst, other.worst);
  rounded += other.rounded;
  wrong += other.wrong;
  shadowed += other.shadowed;
  lit_otherwise += other.lit_otherwise;
}

Comparison compared(const Truth& truth, const Samples& samples, const std::vector<float>& results,
                    double bound) {
  Comparison c;
  for (std::size_t i = 0; i < samples.all.size(); ++i) {
    const float* const got = &results[4 * i];
    const engine::Composition<double> expected = truth.composed(samples.all[i]);
    const double angle = surfgrad::test::unit_angle({got[0], got[1], got[2]}, expected.normal);
    c.mean += angle / static_cast<double>(samples.all.size());
    ++c.count;
    c.worst = std::max(c.worst, angle);
    c.shadowed += expected.sunlight < 0.5;
    c.lit_otherwise += !(std::abs(got[3] - expected.sunlight) < 0.01);
    if (angle <= bound) continue;
    ++(angle <= bound + truth.turn_by_rounding(samples.all[i]) ? c.rounded : c.wrong);
  }
  return c;
}

MinifiedComparison compared_minified(const Truth& truth, const Samples& samples,
                                     const std::vector<float>& results, double levels) {
  MinifiedComparison c;
  const double share = 1 / static_cast<double>(samples.all.size());
  for (std::size_t i = 0; i < samples.all.size(); ++i) {
    const float* const got = &results[4 * i];
    const vec3<double> expected = truth.composed(samples.all[i]).normal;
    c.angle += share * surfgrad::test::unit_angle({got[0], got[1], got[2]}, expected);
    double turn = 0;
    for (const double by : {levels, -levels}) {
      const Sample other = with_finer_pixels(samples.all[i], std::exp2(by));
      turn = std::max(turn, surfgrad::test::unit_angle(truth.composed(other).normal, expected));
    }
    c.turn += share * turn;
  }
  return c;
}

} // namespace surfgrad::shadergen::test
