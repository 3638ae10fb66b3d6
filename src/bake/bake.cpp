#include "bake/bake.hpp"

#include "bake/encode.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "simd/lane.hpp"
#include "stage/stage.hpp"
#include "stage/tile_composer.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <mutex>

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

/// Fits the first caches with all that is kept of a pixel.
constexpr int tile_side = 32;

/// Bakes rows of tiles.
class Bands {
 public:
  Bands(const stage::Stage& stage, const scene::Scene& scene, const Options& options)
      : scene_(scene), options_(options), slot_(stage.slot_of(0)),
        tile_side_(options.backend != nullptr ? options.backend->tile_side() : tile_side),
        projection_(raster::Projection::texture(slot_, options.width, options.height)),
        composer_(stage, projection_, options.width, options.height, tile_side_, tile_side_,
                  {.vertex_frame = options.space == Space::tangent, .slot = slot_}),
        codes_([this] { return Codes(static_cast<std::size_t>(tile_side_)); }) {}

  [[nodiscard]] int count() const { return composer_.grid().rows(); }
  void make(int row, image::Image& band) {
    const raster::Tile first = composer_.grid().tile(0, row);
    stage::reshape(band, options_.width, first.height, 3);
    Counts counts;
    std::mutex adding;
    tbb::parallel_for(tbb::blocked_range<int>(0, composer_.grid().columns(), 8),
                      [&](const tbb::blocked_range<int>& columns) {
                        Counts own;
                        for (int column = columns.begin(); column < columns.end(); ++column)
                          encode(composer_.compose(column, row), band, own);
                        const std::lock_guard<std::mutex> lock(adding);
                        add(own, counts);
                      });
    const std::lock_guard<std::mutex> lock(adding_);
    add(counts, counts_);
  }
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  /// Codes of a tile's pixels. One a thread.
  struct Codes {
    explicit Codes(std::size_t side) : length(side * side + most_lanes), values(5 * length) {}
    std::size_t length;
    std::vector<float> values;
    float* array(std::size_t i) { return values.data() + i * length; }
  };

  static void add(const Counts& some, Counts& to) {
    to.covered += some.covered;
    to.overlapping += some.overlapping;
    to.singular += some.singular;
    to.clamped += some.clamped;
    to.degenerate += some.degenerate;
  }

  void encode(const stage::ComposedTile& composed, image::Image& band, Counts& counts) {
    Codes& codes = codes_.local();
    EncodeWork work{.space = options_.space,
                    .composed = &composed.results,
                    .code = {codes.array(0), codes.array(1), codes.array(2)},
                    .singular = codes.array(3),
                    .clamped = codes.array(4)};
    for (const stage::ComposedTile::Run& run : composed.runs) {
      work.linear = raster::linear_part(scene_.objects[run.surface].world_from_object);
      work.first = run.first;
      work.end = run.end;
      encode_pixels(work);
    }
    const raster::Tile& tile = composed.tile;
    if (composed.count < tile.width * tile.height)
      for (int y = 0; y < tile.height; ++y)
        for (int x = 0; x < tile.width; ++x) put(band, tile.x + x, y, 0.5f, 0.5f, 1.0f);
    for (int i = 0; i < composed.count; ++i) {
      const int pixel = composed.pixel[i];
      put(band, tile.x + pixel % tile.width, pixel / tile.width, work.code.x[i], work.code.y[i],
          work.code.z[i]);
    }
    const auto set = [&](const float* flags) {
      float sum = 0; // whole numbers within a tile
      for (int i = 0; i < composed.count; ++i) sum += flags[i];
      return static_cast<std::int64_t>(sum);
    };
    counts.covered += composed.count;
    counts.overlapping += composed.overlapping;
    counts.singular += set(work.singular);
    counts.clamped += set(work.clamped);
    counts.degenerate += set(composed.results.degenerate);
  }

  static void put(image::Image& band, int x, int y, float r, float g, float b) {
    float* texel = &band.texels[band.index(x, y)];
    texel[0] = r;
    texel[1] = g;
    texel[2] = b;
  }

  const scene::Scene& scene_;
  const Options& options_;
  std::size_t slot_;
  int tile_side_;
  raster::Projection projection_;
  stage::TileComposer composer_;
  tbb::enumerable_thread_specific<Codes> codes_;
  std::mutex adding_;
  Counts counts_;
};

} // namespace

Counts bake_bands(const scene::Scene& asked, const Options& options, const stage::BandSink& take,
                  const Report& report) {
  const auto displaced = displace::displaced(asked, report.at_the_start());
  const scene::Scene& scene = displaced ? displaced->scene : asked;
  const stage::Stage stage(scene, {}, {{0, options.space == Space::tangent}}, report, options.backend);
  Bands bands(stage, scene, options);
  stage::for_each_band(
      bands.count(), report, [&](int row, image::Image& band) { bands.make(row, band); }, take);
  Counts counts = bands.counts();
  counts.outside = triangles_outside(stage.surfaces(), stage.slot_of(0));
  if (counts.covered == 0)
    throw InputError({.file = scene.source,
                      .problem = "no triangle covers a texel of the unit square of UV set 0",
                      .remedy = "check the mesh's texture coordinates, or bake at a larger size"});
  return counts;
}

Baked bake(const scene::Scene& scene, const Options& options, const Report& report) {
  Baked baked;
  baked.map = image::make_image(options.width, options.height, 3, image::Depth::unorm16);
  static_cast<Counts&>(baked) = bake_bands(scene, options, stage::into(baked.map), report);
  return baked;
}

} // namespace surfgrad::bake
