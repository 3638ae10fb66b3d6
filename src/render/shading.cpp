#include "render/shading.hpp"

#include <surfgrad/trigonometry.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace surfgrad::render {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double roughness = 0.36; // glossy enough that highlights trace the bumps
constexpr double alpha = roughness * roughness;
constexpr double f0 = 0.05; // a dielectric
constexpr vec3<double> body{0.37, 0.32, 0.28};

/// Light through a coloured body, channel by channel.
vec3<double> tinted(vec3<double> color, vec3<double> light) {
  return {color.x * light.x, color.y * light.y, color.z * light.z};
}

/// GGX distribution of normals.
double distribution(double cos_half) {
  const double d = cos_half * cos_half * (alpha * alpha - 1) + 1;
  return alpha * alpha / (pi * d * d);
}

/// Height-correlated Smith visibility: G / (4 cos_view cos_light).
double visibility(double cos_view, double cos_light) {
  const auto lambda = [](double c) { return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); };
  return 0.5 / std::max(cos_light * lambda(cos_view) + cos_view * lambda(cos_light), 1e-9);
}

/// Schlick's Fresnel factor without f0.
double grazing(double cosine) {
  const double m = 1 - std::clamp(cosine, 0.0, 1.0);
  return m * m * m * m * m;
}

/// Reflection of a white sky as f0 * x + y, integrated over half vectors drawn from the GGX lobe.
vec2<double> integrate_albedo(double cos_view) {
  const vec3<double> v{std::sqrt(std::max(0.0, 1 - cos_view * cos_view)), 0, cos_view};
  constexpr int rings = 48;
  constexpr int spokes = 48;
  vec2<double> sum{0, 0};
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < spokes; ++j) {
      const double e = (i + 0.5) / rings;
      const SinCos<double> spoke = sin_cos_turns((j + 0.5) / spokes);
      const double c = std::sqrt((1 - e) / (1 + (alpha * alpha - 1) * e));
      const double s = std::sqrt(std::max(0.0, 1 - c * c));
      const vec3<double> h{s * spoke.cos, s * spoke.sin, c};
      const double vh = dot(v, h);
      const double cos_light = 2 * vh * h.z - v.z;
      if (vh <= 0 || cos_light <= 0) continue;
      // density of l: D * h.z / (4 vh); the estimator's D cancels.
      const double weight = visibility(cos_view, cos_light) * cos_light * 4 * vh / h.z;
      const double f = grazing(vh);
      sum = sum + vec2<double>{weight * (1 - f), weight * f};
    }
  return (1.0 / (rings * spokes)) * sum;
}

} // namespace

Shading::Shading(const stack::Lights& lights, const image::Image* environment)
    : environment_(environment != nullptr ? *environment : built_in_sky(), roughness), sky_(lights.sky) {
  const stack::Sun sun = lights.sun.value_or(stack::Sun{});
  to_sun_ = normalize_or_zero(sun.direction);
  if (lights.sun || environment == nullptr) sun_ = sun.strength;
  for (std::size_t i = 0; i < albedo_.size(); ++i)
    albedo_[i] =
        integrate_albedo(std::max(static_cast<double>(i) / static_cast<double>(albedo_.size() - 1), 1e-3));
}

vec2<double> Shading::reflectance(double cos_view) const {
  const double x = cos_view * static_cast<double>(albedo_.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), albedo_.size() - 2);
  const double f = x - static_cast<double>(i);
  return (1 - f) * albedo_[i] + f * albedo_[i + 1];
}

vec3<double> Shading::operator()(vec3<double> normal, vec3<double> to_viewer, double sunlight) const {
  const double cos_view = std::clamp(dot(normal, to_viewer), 0.0, 1.0);
  const vec2<double> split = reflectance(cos_view);
  const double mirrored = f0 * split.x + split.y;
  const vec3<double> mirror = normalize_or_zero((2 * dot(normal, to_viewer)) * normal - to_viewer);
  vec3<double> light = sky_ * ((1 - mirrored) * tinted(body, environment_.diffuse(normal)) +
                               mirrored * environment_.specular(mirror));
  const double cos_light = dot(normal, to_sun_);
  if (cos_light <= 0) return light;
  const vec3<double> half = normalize_or_zero(to_sun_ + to_viewer);
  const double f = grazing(dot(half, to_viewer));
  const double glaze =
      (f0 + (1 - f0) * f) * distribution(dot(normal, half)) * visibility(std::max(cos_view, 1e-4), cos_light);
  const double direct = sunlight * sun_ * cos_light;
  return light + direct * ((1 / pi) * (1 - mirrored) * body + vec3<double>{glaze, glaze, glaze});
}

double display_value(double linear) {
  // Straight up to the shoulder, then bent towards 1 with a matching slope.
  constexpr double shoulder = 0.7;
  const double x = std::max(linear, 0.0);
  const double y = x <= shoulder ? x : 1 - (1 - shoulder) * (1 - shoulder) / (x + 1 - 2 * shoulder);
  return y <= 0.0031308 ? 12.92 * y : 1.055 * std::pow(y, 1 / 2.4) - 0.055;
}

} // namespace surfgrad::render
