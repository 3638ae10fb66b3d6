#include "render/shading.hpp"

#include <surfgrad/trigonometry.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace surfgrad::render {
namespace {

using namespace glaze;

/// Height-correlated Smith visibility: G / (4 cos_view cos_light).
double visibility(double cos_view, double cos_light) {
  return 0.5 / (cos_light * smith_root(cos_view) + cos_view * smith_root(cos_light));
}

constexpr int rings = 48;
constexpr int spokes = 24; // over half the circle: the other half mirrors it
using Halves = std::array<vec3<double>, std::size_t{rings} * spokes>;

/// Half vectors drawn evenly from the GGX lobe around +z.
Halves half_vectors() {
  Halves result{};
  std::size_t k = 0;
  for (int i = 0; i < rings; ++i) {
    const double e = (i + 0.5) / rings;
    const double c = std::sqrt((1 - e) / (1 + (alpha * alpha - 1) * e));
    const double s = std::sqrt(std::max(0.0, 1 - c * c));
    for (int j = 0; j < spokes; ++j) {
      const SinCos<double> spoke = sin_cos_turns((j + 0.5) / (2 * spokes));
      result[k++] = {s * spoke.cos, s * spoke.sin, c};
    }
  }
  return result;
}

/// Reflection of a white sky, integrated over the half vectors.
double mirrored_at(const Halves& halves, double cos_view) {
  const vec3<double> v{std::sqrt(std::max(0.0, 1 - cos_view * cos_view)), 0, cos_view};
  double sum = 0;
  for (const vec3<double>& h : halves) {
    const double vh = dot(v, h);
    const double cos_light = 2 * vh * h.z - v.z;
    if (vh <= 0 || cos_light <= 0) continue;
    // Density of the light's direction: D * h.z / (4 vh); the estimator's D cancels.
    const double weight = visibility(cos_view, cos_light) * cos_light * 4 * vh / h.z;
    sum += weight * (f0 + (1 - f0) * grazing(std::min(vh, 1.0)));
  }
  return sum / static_cast<double>(halves.size());
}

/// The glaze is always the same, so one table serves every picture.
Words mirrored_table() {
  static const auto table = [] {
    std::array<std::uint32_t, 65> words{};
    const Halves halves = half_vectors();
    for (std::size_t i = 0; i < words.size(); ++i) {
      const double cos_view = std::max(static_cast<double>(i) / static_cast<double>(words.size() - 1), 1e-3);
      words[i] = std::bit_cast<std::uint32_t>(static_cast<float>(mirrored_at(halves, cos_view)));
    }
    return words;
  }();
  return {table.data(), static_cast<std::int32_t>(table.size())};
}

} // namespace

Shading::Shading(const stack::Lights& lights, const image::Image* environment)
    : sky_(lights.sky), mirrored_(mirrored_table()) {
  if (sky_ > 0) environment_ = Environment(environment != nullptr ? *environment : built_in_sky(), roughness);
  const stack::Sun sun = lights.sun.value_or(stack::Sun{});
  if (lights.sun || environment == nullptr) sun_ = sun.strength;
  if (sun_ > 0) to_sun_ = normalize_or_zero(sun.direction);
}

} // namespace surfgrad::render
