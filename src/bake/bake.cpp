#include "bake/bake.hpp"

#include "bake/dither.hpp"
#include "bake/encode.hpp"
#include "bake/fill.hpp"
#include "bake/format.hpp"
#include "bake/normal_statistics.hpp"
#include "bake/padding.hpp"
#include "bake/sample_means.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "simd/lane.hpp"
#include "stage/tile_composer.hpp"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

namespace surfgrad::bake {
namespace {

/// Of the unit square that is baked.
vec2<double> corner_of(const Options& options) {
  return {static_cast<double>(options.tile.column), static_cast<double>(options.tile.row)};
}

/// Triangles that lie, wholly or in part, where the map does not reach.
std::int64_t triangles_outside(const std::vector<raster::Surface>& surfaces, std::size_t slot,
                               vec2<double> corner) {
  std::int64_t count = 0;
  for (const raster::Surface& surface : surfaces)
    for (const auto& triangle : surface.mesh->triangles)
      count += std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
        const vec2<double> st = surface.slots[slot].st[vertex] - corner;
        return st.x < 0 || st.x > 1 || st.y < 0 || st.y > 1;
      });
  return count;
}

/// A map covers the unit square: says where the texture coordinates are instead if none of a triangle is in
/// it.
void require_something_inside(const std::vector<raster::Surface>& surfaces, std::size_t slot,
                              const Options& options, const std::filesystem::path& source) {
  const vec2<double> corner = corner_of(options);
  const int uv_set = options.uv_set;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  vec2<double> low{infinity, infinity};
  vec2<double> high{-infinity, -infinity};
  for (const raster::Surface& surface : surfaces)
    for (const auto& triangle : surface.mesh->triangles) {
      vec2<double> from{infinity, infinity};
      vec2<double> to{-infinity, -infinity};
      for (const std::uint32_t vertex : triangle) {
        const vec2<double> st = surface.slots[slot].st[vertex];
        from = {std::min(from.x, st.x), std::min(from.y, st.y)};
        to = {std::max(to.x, st.x), std::max(to.y, st.y)};
      }
      if (from.x < corner.x + 1 && to.x > corner.x && from.y < corner.y + 1 && to.y > corner.y) return;
      low = {std::min(low.x, from.x), std::min(low.y, from.y)};
      high = {std::max(high.x, to.x), std::max(high.y, to.y)};
    }
  const vec2<double> square{std::floor(low.x), std::floor(low.y)};
  const bool in_one = high.x <= square.x + 1 && high.y <= square.y + 1;
  throw InputError(
      {.file = source,
       .problem =
           in_one ? fmt::format("UV set {} lies in the unit square from ({}, {}) to ({}, {}), counted "
                                "upwards from the lower left, and a map covers that from (0, 0) to (1, 1)",
                                uv_set, square.x, square.y, square.x + 1, square.y + 1)
                  : fmt::format("UV set {} lies between ({:.4g}, {:.4g}) and ({:.4g}, {:.4g}), and no "
                                "triangle reaches into the unit square that a map covers",
                                uv_set, low.x, low.y, high.x, high.y),
       .remedy = in_one
                     ? fmt::format(
                           "move its coordinates by ({}, {}), or bake UDIM tiles: <UDIM> in the file's name",
                           0 - square.x, 0 - square.y)
                     : "lay it out within the unit square, or bake UDIM tiles: <UDIM> in the file's name"});
}

/// Bakes rows of tiles.
class Bands {
 public:
  /// format  of the texels; null: a band holds what SampleSums puts
  Bands(const stage::Stage& stage, const Options& options, const Format* format)
      : scene_(stage.scene()), options_(options), format_(format),
        empty_(format != nullptr ? format->flat() : std::vector<float>(SampleSums::channels)),
        slot_(stage.slot_of(options.uv_set)),
        tile_side_(options.samples * std::max(1, stage::tile_side_of(options.backend) / options.samples)),
        projection_(raster::Projection::texture(slot_, options.width * options.samples,
                                                options.height * options.samples, corner_of(options))),
        composer_(stage, projection_, options.width * options.samples, options.height * options.samples,
                  tile_side_, tile_side_, {.vertex_frame = options.space == Space::tangent, .slot = slot_}),
        own_([this] { return Own(static_cast<std::size_t>(tile_side_)); }) {}

  [[nodiscard]] int count() const { return composer_.grid().rows(); }
  void make(int row, image::Image& band, const stage::GoOn& go_on) {
    const raster::Tile first = composer_.grid().tile(0, row);
    stage::reshape(band, options_.width, first.height / options_.samples, static_cast<int>(empty_.size()));
    composer_.compose_row(row, [&](const stage::ComposedTile& tile) {
      go_on();
      encode(tile, band);
    });
  }
  [[nodiscard]] Counts counts() const {
    Counts sum;
    for (const Own& own : own_) {
      sum.covered += own.counts.covered;
      sum.samples += own.counts.samples;
      sum.touched += own.counts.touched;
      sum.overlapping += own.counts.overlapping;
      sum.singular += own.counts.singular;
      sum.clamped += own.counts.clamped;
      sum.degenerate += own.counts.degenerate;
      sum.beyond_range += own.counts.beyond_range;
      sum.steepest = std::max(sum.steepest, own.counts.steepest);
    }
    return sum;
  }

 private:
  /// What one thread works with: the normals of a tile's samples, and what it has counted.
  struct Own {
    explicit Own(std::size_t side) : length(side * side + most_lanes), values(5 * length) {}
    Counts counts{};
    SampleMeans means{};
    SampleSums sums{};
    std::vector<std::size_t> texel_of{}; ///< where the texels of tiles of this size lie, from the first on
    int tile_width = 0;
    int tile_height = 0;
    std::size_t length;
    std::vector<float> values;
    float* array(std::size_t i) { return values.data() + i * length; }
  };

  void encode(const stage::ComposedTile& composed, image::Image& band) {
    Own& own = own_.local();
    EncodeWork work{.space = options_.space,
                    .composed = &composed.results,
                    .normal = {own.array(0), own.array(1), own.array(2)},
                    .singular = own.array(3),
                    .clamped = own.array(4)};
    for (const stage::ComposedTile::Run& run : composed.runs) {
      work.linear = raster::linear_part(scene_.objects[run.surface].world_from_object);
      work.first = run.first;
      work.end = run.end;
      encode_pixels(work);
    }
    count_samples(composed, work, own.counts);
    const raster::Tile& tile = composed.tile;
    const int width = tile.width / options_.samples;
    const int height = tile.height / options_.samples;
    if (own.tile_width != tile.width || own.tile_height != tile.height) {
      own.tile_width = tile.width;
      own.tile_height = tile.height;
      own.texel_of.clear();
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) own.texel_of.push_back(band.index(x, y));
    }
    float* const first = &band.texels[band.index(tile.x / options_.samples, 0)];
    const auto put = [&](std::size_t texel, vec3<float> normal) {
      ++own.counts.covered;
      const Format::Encoded encoded = format_->encode(normal, first + own.texel_of[texel]);
      own.counts.beyond_range += encoded.clamped ? 1 : 0;
      own.counts.steepest = std::max<double>(own.counts.steepest, encoded.steepest);
    };
    const auto normal = [&](int i) {
      return vec3<float>{work.normal.x[i], work.normal.y[i], work.normal.z[i]};
    };
    const SampleGrid grid{options_.samples, width, height};
    if (format_ == nullptr) {
      own.sums.start(grid);
      for (int i = 0; i < composed.count; ++i)
        if (work.singular[i] == 0) own.sums.add(composed.pixel[i], normal(i));
      for (std::size_t texel = 0; texel < own.texel_of.size(); ++texel)
        own.sums.put(texel, first + own.texel_of[texel]);
      return;
    }
    if (composed.count < tile.width * tile.height)
      for (const std::size_t texel : own.texel_of) {
        first[texel] = empty_[0]; // two or three values: a call to copy them costs more
        first[texel + 1] = empty_[1];
        if (empty_.size() == 3) first[texel + 2] = empty_[2];
        if (options_.padding > 0 || options_.fill) first[texel] = uncovered;
      }
    if (options_.samples == 1) {
      const auto texel = [&](int i) { return static_cast<std::size_t>(composed.pixel[i]); };
      if (format_->holds_slopes()) {
        for (int i = 0; i < composed.count; ++i) put(texel(i), normal(i));
      } else { // nothing to count but how many there are
        own.counts.covered += composed.count;
        for (int i = 0; i < composed.count; ++i)
          format_->encode_components(normal(i), first + own.texel_of[texel(i)]);
      }
      return;
    }
    own.means.start(options_.space, grid);
    for (int i = 0; i < composed.count; ++i)
      own.means.add(composed.pixel[i], normal(i), work.singular[i] != 0);
    for (std::size_t texel = 0; texel < own.texel_of.size(); ++texel)
      if (own.means.covered(texel)) put(texel, own.means.mean(texel));
  }

  static void count_samples(const stage::ComposedTile& composed, const EncodeWork& work, Counts& counts) {
    const auto set = [&](const float* flags) {
      int count = 0; // as wide as the flags, or the loop takes twice as long
      for (int i = 0; i < composed.count; ++i) count += flags[i] != 0 ? 1 : 0;
      return count;
    };
    counts.samples += composed.count;
    counts.touched += composed.touched;
    counts.overlapping += composed.overlapping;
    counts.singular += set(work.singular);
    counts.clamped += set(work.clamped);
    counts.degenerate += set(composed.results.degenerate);
  }

  const scene::Scene& scene_;
  const Options& options_;
  const Format* format_;
  std::vector<float> empty_; ///< what a texel begins as
  std::size_t slot_;
  int tile_side_;
  raster::Projection projection_;
  stage::TileComposer composer_;
  tbb::enumerable_thread_specific<Own> own_;
};

/// A bake looks from nowhere.
void refuse_layers_that_need_a_viewer(const scene::Scene& scene) {
  for (const scene::Material& material : scene.materials)
    for (const stack::Layer& layer : material.layers)
      if (const auto* parallax = std::get_if<stack::ParallaxLayer>(&layer))
        throw InputError({.file = scene.source,
                          .line = parallax->common.line,
                          .place = parallax->common.key,
                          .problem = "parallax depends on the viewer, and a bake has none",
                          .remedy = "leave it out, or give the heights to a layer of type \"height_map\""});
}

} // namespace

stage::Stage stage_of(scene::Scene scene, const Options& options, const Report& report) {
  refuse_layers_that_need_a_viewer(scene);
  if (auto displaced = displace::displaced(scene, report.at_the_start())) scene = std::move(displaced->scene);
  return {std::move(scene), {}, {{options.uv_set, options.space == Space::tangent}}, report, options.backend};
}

NormalStatistics normal_statistics(scene::Scene scene, const Options& asked, const Report& report) {
  Options options = asked;
  options.space = Space::tangent;
  const stage::Stage stage = stage_of(std::move(scene), options, report);
  require_something_inside(stage.surfaces(), stage.slot_of(options.uv_set), options, stage.scene().source);
  Bands bands(stage, options, nullptr);
  image::Image sums = image::make_image(options.width, options.height, 3, image::Depth::float32);
  image::Image squares = image::make_image(options.width, options.height, 4, image::Depth::float32);
  int rows_left = options.height;
  stage::for_each_band(
      bands.count(), report,
      [&](int row, image::Image& band, const stage::GoOn& go_on) { bands.make(row, band, go_on); },
      [&](const image::Image& band) {
        rows_left -= band.height;
        for (int y = 0; y < band.height; ++y)
          for (int x = 0; x < band.width; ++x)
            for (int c = 0; c < SampleSums::channels; ++c)
              (c < 3 ? sums.at(x, rows_left + y, c) : squares.at(x, rows_left + y, c - 3)) = band.at(x, y, c);
      });
  return {sums, squares};
}

Counts bake_bands(scene::Scene scene, const Options& options, const stage::BandSink& take,
                  const Report& report) {
  return bake_bands(stage_of(std::move(scene), options, report), options, take, report);
}

Counts bake_bands(const stage::Stage& stage, const Options& options, const stage::BandSink& take,
                  const Report& report) {
  const Format format(options);
  const std::size_t slot = stage.slot_of(options.uv_set);
  require_something_inside(stage.surfaces(), slot, options, stage.scene().source);
  Bands bands(stage, options, &format);
  // From the maker over the padding and the dither to the taker.
  stage::BandSink sink = take;
  std::optional<Dither> dither;
  if (options.dither) {
    dither.emplace(options.height, format.flat(), sink);
    sink = [&](const image::Image& band) { dither->add(band); };
  }
  std::optional<Fill> fill;
  std::optional<Padding> padding;
  if (options.fill) {
    fill.emplace(options.width, options.height, format.flat(), sink);
    sink = [&](const image::Image& band) { fill->add(band); };
  } else if (options.padding > 0) {
    padding.emplace(options.width, options.height, options.padding, format.flat(), sink);
    sink = [&](const image::Image& band) { padding->add(band); };
  }
  stage::for_each_band(
      bands.count(), report,
      [&](int row, image::Image& band, const stage::GoOn& go_on) { bands.make(row, band, go_on); }, sink);
  Counts counts = bands.counts();
  if (fill) counts.padded = fill->filled();
  if (padding) counts.padded = padding->padded();
  counts.outside = triangles_outside(stage.surfaces(), slot, corner_of(options));
  if (counts.covered == 0)
    throw InputError(
        {.file = stage.scene().source,
         .problem = fmt::format("no triangle has an area in the unit square of UV set {}", options.uv_set),
         .remedy = "unwrap the mesh"});
  return counts;
}

Baked bake(scene::Scene scene, const Options& options, const Report& report) {
  Baked baked;
  baked.map = image::make_image(options.width, options.height, Format(options).channels(), options.depth);
  static_cast<Counts&>(baked) = bake_bands(std::move(scene), options, stage::into(baked.map), report);
  return baked;
}

} // namespace surfgrad::bake
