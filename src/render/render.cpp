#include "render/render.hpp"

#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "engine/rows.hpp"
#include "raster/visibility.hpp"
#include "render/camera.hpp"
#include "render/display.hpp"
#include "render/shading.hpp"
#include "stage/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace surfgrad::render {
namespace {

/// Near plane and picture plane of the supersampled raster, and everything a sample needs.
struct Sampler {
  const stage::Stage& stage;
  const raster::VisibilityBuffer& visible;
  const mat4<double>& projection;
  Aov aov;
  const Shading* shading; // for beauty only

  struct Result {
    vec3<double> value;
    bool degenerate;
  };
  [[nodiscard]] Result operator()(int x, int y) const {
    const raster::Visible& what = visible.at(x, y);
    const raster::Surface& surface = stage.surfaces()[what.surface];
    const raster::TrianglePlanes planes = raster::screen_planes(surface, what.triangle, projection);
    raster::Fragment<double> fragment =
        raster::make_fragment(surface, what.triangle, planes, x + 0.5, y + 0.5);
    fragment.to_viewer = normalize_or_zero(-fragment.position);
    const engine::Composition<double> c = stage.compose(what, fragment);
    return {value_of(fragment, c), c.degenerate};
  }

 private:
  [[nodiscard]] vec3<double> value_of(const raster::Fragment<double>& fragment,
                                      const engine::Composition<double>& c) const {
    switch (aov) {
    case Aov::normal:
      return c.normal;
    case Aov::base_normal:
      return c.base_normal;
    case Aov::surfgrad:
      return c.surfgrad;
    case Aov::uv: {
      const vec2<double> st = fragment.uvs[stage.slot_of(0)].st;
      return {st.x, st.y, 0};
    }
    case Aov::beauty:
      break;
    }
    return shade(*shading, c.normal, fragment.to_viewer, c.sunlight);
  }
};

/// Dark and neutral, a little lighter towards the top: bumps are judged against it.
vec3<double> background(double height) {
  const double grey = 0.05 + 0.06 * height;
  return {grey, grey, 1.08 * grey};
}

/// Raw values are not averaged: they take one sample a pixel.
int samples_along_a_side(const Options& options) {
  return options.aov == Aov::beauty ? std::max(1, options.samples) : 1;
}

} // namespace

void check_options(const Options& options) {
  const double pixels = double(options.width) * options.height;
  const int k = samples_along_a_side(options);
  const double samples = pixels * k * k; // doubles: the product may pass 2^63
  const double most = static_cast<double>(most_samples);
  if (samples <= most) return;
  const double shrink = std::sqrt(most / samples);
  const auto side = [&](int length) { return std::max(1, static_cast<int>(length * shrink)); };
  std::string fits =
      fmt::format("--size {}x{} with --samples {}", side(options.width), side(options.height), k);
  if (pixels <= most)
    fits += fmt::format(" or --samples {} at this size", static_cast<int>(std::sqrt(most / pixels)));
  throw InputError(
      {.place = fmt::format("--size {}x{} with --samples {}", options.width, options.height, k),
       .problem = fmt::format("takes {:.0f} samples, at most {} are possible", samples, most_samples),
       .remedy = "what fits is " + fits});
}

Picture render(const scene::Scene& asked, const Options& options, const Report& report) {
  check_options(options);
  const auto displaced = displace::displaced(asked, report.at_the_start());
  const scene::Scene& scene = displaced ? displaced->scene : asked;
  const bool beauty = options.aov == Aov::beauty;
  const int k = samples_along_a_side(options);
  const int width = options.width * k;
  const int height = options.height * k;
  const Pinhole camera = place_camera(scene, width, height);
  const mat4<double> projection = camera.screen_from_relative(width, height);
  std::vector<raster::UvSlot> needed;
  if (options.aov == Aov::uv) needed.push_back({0, false});
  std::optional<Shading> shading;
  if (beauty) shading.emplace(scene.lights, scene.environment.get());
  const stage::View view{camera.eye, camera.relative_from_screen(width, height),
                         shading ? shading->to_sun() : vec3<double>{0, 0, 0}};
  const stage::Stage stage(scene, view, needed, report);
  const raster::VisibilityBuffer visible = raster::see_from_camera(
      stage.surfaces(), projection, camera.near, width, height,
      [&](std::uint32_t s, std::uint32_t t, bool front) { return stage.culled(s, t, front); });
  const Sampler sample{stage, visible, projection, options.aov, shading ? &*shading : nullptr};

  Picture picture{image::make_image(options.width, options.height, 3, image::Depth::float32)};
  std::atomic<std::int64_t> covered{0};
  std::atomic<std::int64_t> degenerate{0};
  engine::for_each_row(options.height, report, [&](int row) {
    std::int64_t row_covered = 0;
    std::int64_t row_degenerate = 0;
    for (int column = 0; column < options.width; ++column) {
      vec3<double> sum{0, 0, 0};
      for (int y = row * k; y < (row + 1) * k; ++y)
        for (int x = column * k; x < (column + 1) * k; ++x) {
          if (visible.at(x, y).surface == raster::Visible::none) {
            if (beauty) sum = sum + background((y + 0.5) / height);
            continue;
          }
          const Sampler::Result r = sample(x, y);
          sum = sum + r.value;
          ++row_covered;
          row_degenerate += r.degenerate;
        }
      vec3<double> mean = (1.0 / (k * k)) * sum;
      if (beauty) mean = {display_value(mean.x), display_value(mean.y), display_value(mean.z)};
      picture.image.at(column, row, 0) = static_cast<float>(mean.x);
      picture.image.at(column, row, 1) = static_cast<float>(mean.y);
      picture.image.at(column, row, 2) = static_cast<float>(mean.z);
    }
    covered += row_covered;
    degenerate += row_degenerate;
  });
  picture.covered = covered;
  picture.degenerate = degenerate;
  return picture;
}

image::Image encoded_for_display(const Picture& picture, Aov aov) {
  image::Image result = picture.image;
  if (aov == Aov::beauty) return result;
  for (float& v : result.texels) v = aov == Aov::uv ? v - std::floor(v) : 0.5f * v + 0.5f;
  return result;
}

} // namespace surfgrad::render
