#include "bake/bake.hpp"

#include "bake/encode.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "simd/lane.hpp"
#include "stage/stage.hpp"
#include "stage/tile_composer.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <utility>

namespace surfgrad::bake {
namespace {

/// Triangles that lie, wholly or in part, where the map does not reach.
std::int64_t triangles_outside(const std::vector<raster::Surface>& surfaces, std::size_t slot) {
  std::int64_t count = 0;
  for (const raster::Surface& surface : surfaces)
    for (const auto& triangle : surface.mesh->triangles)
      count += std::any_of(triangle.begin(), triangle.end(), [&](std::uint32_t vertex) {
        const vec2<double> st = surface.slots[slot].st[vertex];
        return st.x < 0 || st.x > 1 || st.y < 0 || st.y > 1;
      });
  return count;
}

/// Bakes rows of tiles.
class Bands {
 public:
  Bands(const stage::Stage& stage, const Options& options)
      : scene_(stage.scene()), options_(options), slot_(stage.slot_of(0)),
        tile_side_(stage::tile_side_of(options.backend)),
        projection_(raster::Projection::texture(slot_, options.width, options.height)),
        composer_(stage, projection_, options.width, options.height, tile_side_, tile_side_,
                  {.vertex_frame = options.space == Space::tangent, .slot = slot_}),
        own_([this] { return Own(static_cast<std::size_t>(tile_side_)); }) {}

  [[nodiscard]] int count() const { return composer_.grid().rows(); }
  void make(int row, image::Image& band, const stage::GoOn& go_on) {
    const raster::Tile first = composer_.grid().tile(0, row);
    stage::reshape(band, options_.width, first.height, 3);
    composer_.compose_row(row, [&](const stage::ComposedTile& tile) {
      go_on();
      encode(tile, band);
    });
  }
  [[nodiscard]] Counts counts() const {
    Counts sum;
    for (const Own& own : own_) {
      sum.covered += own.counts.covered;
      sum.overlapping += own.counts.overlapping;
      sum.singular += own.counts.singular;
      sum.clamped += own.counts.clamped;
      sum.degenerate += own.counts.degenerate;
    }
    return sum;
  }

 private:
  /// What one thread works with: the codes of a tile's pixels, and what it has counted.
  struct Own {
    explicit Own(std::size_t side) : length(side * side + most_lanes), codes(5 * length) {}
    Counts counts{};
    std::vector<std::size_t> texel_of{}; ///< of the pixels of tiles of this size, from a tile's first on
    int tile_width = 0;
    int tile_height = 0;
    std::size_t length;
    std::vector<float> codes;
    float* array(std::size_t i) { return codes.data() + i * length; }
  };

  void encode(const stage::ComposedTile& composed, image::Image& band) {
    Own& own = own_.local();
    EncodeWork work{.space = options_.space,
                    .composed = &composed.results,
                    .code = {own.array(0), own.array(1), own.array(2)},
                    .singular = own.array(3),
                    .clamped = own.array(4)};
    for (const stage::ComposedTile::Run& run : composed.runs) {
      work.linear = raster::linear_part(scene_.objects[run.surface].world_from_object);
      work.first = run.first;
      work.end = run.end;
      encode_pixels(work);
    }
    const raster::Tile& tile = composed.tile;
    if (own.tile_width != tile.width || own.tile_height != tile.height) {
      own.tile_width = tile.width;
      own.tile_height = tile.height;
      own.texel_of.clear();
      for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) own.texel_of.push_back(band.index(x, y));
    }
    const std::size_t first = band.index(tile.x, 0);
    const auto put = [&](std::size_t pixel, float r, float g, float b) {
      float* texel = &band.texels[first + own.texel_of[pixel]];
      texel[0] = r;
      texel[1] = g;
      texel[2] = b;
    };
    if (composed.count < tile.width * tile.height)
      for (std::size_t i = 0; i < own.texel_of.size(); ++i) put(i, 0.5f, 0.5f, 1.0f);
    for (int i = 0; i < composed.count; ++i)
      put(static_cast<std::size_t>(composed.pixel[i]), work.code.x[i], work.code.y[i], work.code.z[i]);
    const auto set = [&](const float* flags) {
      float sum = 0; // whole numbers within a tile
      for (int i = 0; i < composed.count; ++i) sum += flags[i];
      return static_cast<std::int64_t>(sum);
    };
    own.counts.covered += composed.count;
    own.counts.overlapping += composed.overlapping;
    own.counts.singular += set(work.singular);
    own.counts.clamped += set(work.clamped);
    own.counts.degenerate += set(composed.results.degenerate);
  }

  const scene::Scene& scene_;
  const Options& options_;
  std::size_t slot_;
  int tile_side_;
  raster::Projection projection_;
  stage::TileComposer composer_;
  tbb::enumerable_thread_specific<Own> own_;
};

} // namespace

Counts bake_bands(scene::Scene scene, const Options& options, const stage::BandSink& take,
                  const Report& report) {
  if (auto displaced = displace::displaced(scene, report.at_the_start())) scene = std::move(displaced->scene);
  const stage::Stage stage(std::move(scene), {}, {{0, options.space == Space::tangent}}, report,
                           options.backend);
  Bands bands(stage, options);
  stage::for_each_band(
      bands.count(), report,
      [&](int row, image::Image& band, const stage::GoOn& go_on) { bands.make(row, band, go_on); }, take);
  Counts counts = bands.counts();
  counts.outside = triangles_outside(stage.surfaces(), stage.slot_of(0));
  if (counts.covered == 0)
    throw InputError({.file = stage.scene().source,
                      .problem = "no triangle covers a texel of the unit square of UV set 0",
                      .remedy = "check the mesh's texture coordinates, or bake at a larger size"});
  return counts;
}

Baked bake(scene::Scene scene, const Options& options, const Report& report) {
  Baked baked;
  baked.map = image::make_image(options.width, options.height, 3, image::Depth::unorm16);
  static_cast<Counts&>(baked) = bake_bands(std::move(scene), options, stage::into(baked.map), report);
  return baked;
}

} // namespace surfgrad::bake
