#include "render/render.hpp"

#include "displace/scene.hpp"
#include "render/camera.hpp"
#include "render/shade_tile.hpp"
#include "simd/lane.hpp"
#include "stage/stage.hpp"
#include "stage/tile_composer.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace surfgrad::render {
namespace {

/// Dark and neutral, a little lighter towards the top: bumps are judged against it.
vec3<float> background(double height) {
  const double grey = 0.05 + 0.06 * height;
  return {static_cast<float>(grey), static_cast<float>(grey), static_cast<float>(1.08 * grey)};
}

stage::Outputs outputs_of(Aov aov, std::size_t slot) {
  const bool beauty = aov == Aov::beauty;
  return {.normal = beauty || aov == Aov::normal,
          .base_normal = aov == Aov::base_normal,
          .surfgrad = aov == Aov::surfgrad,
          .sunlight = beauty,
          .to_viewer = beauty,
          .st = aov == Aov::uv,
          .slot = slot};
}

/// Raw values are not averaged: they take one sample a pixel.
int samples_along_a_side(const Options& options) {
  return options.aov == Aov::beauty ? std::max(1, options.samples) : 1;
}

/// Values of a tile's samples and pixels. One a thread.
struct Values {
  explicit Values(std::size_t samples) : length(samples + most_lanes), storage(7 * length, 0.0f) {}

  [[nodiscard]] vec3<float*> composed() { return {array(0), array(1), array(2)}; }
  [[nodiscard]] vec3<float*> tile() { return {array(3), array(4), array(5)}; }
  [[nodiscard]] const float* zeros() { return array(6); }

 private:
  float* array(std::size_t i) { return storage.data() + i * length; }

  std::size_t length;
  std::vector<float> storage;
};

/// Renders rows of tiles.
class Bands {
 public:
  Bands(const stage::Stage& stage, const raster::Projection& projection, const Options& options,
        const Shading* shading)
      : options_(options), shading_(shading), side_(samples_along_a_side(options)),
        pixels_(std::max(1, stage::tile_side_of(options.backend) / side_)),
        composer_(stage, projection, options.width * side_, options.height * side_, pixels_ * side_,
                  pixels_ * side_, outputs_of(options.aov, options.aov == Aov::uv ? stage.slot_of(0) : 0)),
        values_([this] { return Values(static_cast<std::size_t>(pixels_ * side_ * pixels_ * side_)); }) {}

  [[nodiscard]] int count() const { return composer_.grid().rows(); }

  void make(int row, image::Image& band, const stage::GoOn& go_on) {
    const int height = composer_.grid().tile(0, row).height / side_;
    stage::reshape(band, options_.width, height, 3);
    composer_.compose_row(row, [&](const stage::ComposedTile& tile) {
      go_on();
      draw(tile, band);
    });
  }

  [[nodiscard]] Counts counts() const { return {covered_, degenerate_}; }

 private:
  /// What the composed samples show.
  [[nodiscard]] vec3<const float*> shown(const stage::ComposedTile& composed, Values& values) const {
    const engine::TileWork::Results& r = composed.results;
    const auto constant = [](vec3<float*> a) { return vec3<const float*>{a.x, a.y, a.z}; };
    switch (options_.aov) {
    case Aov::normal:
      return constant(r.normal);
    case Aov::base_normal:
      return constant(r.base_normal);
    case Aov::surfgrad:
      return constant(r.surfgrad);
    case Aov::uv:
      return {r.st.x, r.st.y, values.zeros()};
    case Aov::beauty:
      break;
    }
    shade_pixels(*shading_, r, composed.count, values.composed());
    return constant(values.composed());
  }

  void draw(const stage::ComposedTile& composed, image::Image& band) {
    Values& values = values_.local();
    const raster::Tile& tile = composed.tile;
    const bool beauty = options_.aov == Aov::beauty;
    const vec3<const float*> from = shown(composed, values);
    const vec3<float*> samples = values.tile();
    const int area = tile.width * tile.height;
    if (composed.count < area)
      for (int y = 0; y < tile.height; ++y) {
        const double height = (tile.y + y + 0.5) / (options_.height * side_);
        const vec3<float> empty = beauty ? background(height) : vec3<float>{0, 0, 0};
        std::fill_n(samples.x + y * tile.width, tile.width, empty.x);
        std::fill_n(samples.y + y * tile.width, tile.width, empty.y);
        std::fill_n(samples.z + y * tile.width, tile.width, empty.z);
      }
    for (int i = 0; i < composed.count; ++i) {
      samples.x[composed.pixel[i]] = from.x[i];
      samples.y[composed.pixel[i]] = from.y[i];
      samples.z[composed.pixel[i]] = from.z[i];
    }
    int degenerate = 0; // in whole numbers, which are vectorised: sums of floats keep their order
    for (int i = 0; i < composed.count; ++i) degenerate += composed.results.degenerate[i] != 0 ? 1 : 0;
    covered_ += composed.count;
    degenerate_ += degenerate;
    for (float* channel : {samples.x, samples.y, samples.z}) {
      average(tile, channel);
      if (beauty) to_display(channel, area / (side_ * side_));
    }
    const int width = tile.width / side_;
    for (int y = 0, i = 0; y < tile.height / side_; ++y) {
      float* texel = &band.texels[band.index(tile.x / side_, y)];
      for (int x = 0; x < width; ++x, ++i) {
        *texel++ = samples.x[i];
        *texel++ = samples.y[i];
        *texel++ = samples.z[i];
      }
    }
  }

  /// The means of the samples of each pixel, in place.
  void average(const raster::Tile& tile, float* samples) const {
    if (side_ == 1) return;
    const float share = 1.0f / static_cast<float>(side_ * side_);
    int pixel = 0;
    for (int y = 0; y < tile.height; y += side_)
      for (int x = 0; x < tile.width; x += side_) {
        float sum = 0;
        for (int j = 0; j < side_; ++j)
          for (int i = 0; i < side_; ++i) sum += samples[(y + j) * tile.width + x + i];
        samples[pixel++] = sum * share; // behind all that is still to be read
      }
  }

  const Options& options_;
  const Shading* shading_;
  int side_;   ///< samples along a side of a pixel
  int pixels_; ///< pixels along a side of a tile
  stage::TileComposer composer_;
  tbb::enumerable_thread_specific<Values> values_;
  std::atomic<std::int64_t> covered_{0}, degenerate_{0};
};

} // namespace

Counts render_bands(scene::Scene scene, const Options& options, const stage::BandSink& take,
                    const Report& report) {
  if (auto displaced = displace::displaced(scene, report.at_the_start())) scene = std::move(displaced->scene);
  const int k = samples_along_a_side(options);
  const int width = options.width * k;
  const int height = options.height * k;
  const Pinhole camera = place_camera(scene, width, height);
  std::vector<raster::UvSlot> needed;
  if (options.aov == Aov::uv) needed.push_back({0, false});
  std::optional<Shading> shading;
  if (options.aov == Aov::beauty) shading.emplace(scene.lights, scene.environment.get());
  const stage::View view{camera.eye, camera.relative_from_screen(width, height),
                         shading ? shading->to_sun() : vec3<double>{0, 0, 0}};
  const stage::Stage stage(std::move(scene), view, needed, report, options.backend);
  const auto projection = raster::Projection::camera(camera.screen_from_relative(width, height), camera.near);
  Bands bands(stage, projection, options, shading ? &*shading : nullptr);
  stage::for_each_band(
      bands.count(), report,
      [&](int row, image::Image& band, const stage::GoOn& go_on) { bands.make(row, band, go_on); }, take);
  return bands.counts();
}

Picture render(const scene::Scene& scene, const Options& options, const Report& report) {
  Picture picture;
  picture.image = image::make_image(options.width, options.height, 3, image::Depth::float32);
  static_cast<Counts&>(picture) = render_bands(scene, options, stage::into(picture.image), report);
  return picture;
}

image::Image encoded_for_display(const image::Image& picture, Aov aov) {
  image::Image result = picture;
  if (aov == Aov::beauty) return result;
  for (float& v : result.texels.floats()) v = aov == Aov::uv ? v - std::floor(v) : 0.5f * v + 0.5f;
  return result;
}

} // namespace surfgrad::render
