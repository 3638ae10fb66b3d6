#include "stage/tile_composer.hpp"

#include "simd/lane.hpp"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace surfgrad::stage {

/// What one thread works with: allocated once, but for what grows with the triangles of a tile.
struct TileComposer::Scratch {
  raster::TileScan scan;
  std::vector<std::uint32_t> order; ///< of shown triangles, by surface and material
  std::vector<int> next;            ///< of each shown triangle, its next place in the lists below
  std::vector<raster::TriangleSetup> setups;
  std::vector<std::int32_t> which, pixel;
  std::vector<float> x, y;
  std::vector<float> results; ///< all arrays of results, one after the other
  std::vector<ComposedTile::Run> runs;
  ComposedTile composed;
};

struct TileComposer::Scratches {
  tbb::enumerable_thread_specific<Scratch> each;
};

TileComposer::TileComposer(const Stage& stage, const raster::Projection& projection, int width, int height,
                           int tile_width, int tile_height, const Outputs& outputs)
    : stage_(stage), projection_(projection),
      grid_(stage.surfaces(), projection, width, height, tile_width, tile_height), outputs_(outputs),
      most_pixels_(static_cast<std::size_t>(tile_width) * static_cast<std::size_t>(tile_height)),
      scratches_(std::make_unique<Scratches>()) {}

TileComposer::~TileComposer() = default;

namespace {

/// Arrays one after another in one allocation.
class Arrays {
 public:
  Arrays(std::vector<float>& storage, std::size_t length) : storage_(storage), length_(length) {}

  float* one(bool wanted) {
    if (!wanted) return nullptr;
    float* array = storage_.data() + used_;
    used_ += length_;
    return array;
  }
  vec2<float*> two(bool wanted) {
    float* x = one(wanted);
    return {x, one(wanted)};
  }
  vec3<float*> three(bool wanted) {
    const vec2<float*> xy = two(wanted);
    return {xy.x, xy.y, one(wanted)};
  }

 private:
  std::vector<float>& storage_;
  std::size_t length_;
  std::size_t used_ = 0;
};

constexpr std::size_t most_arrays = 23; // of TileWork::Results

engine::TileWork::Results results_of(const Outputs& outputs, std::vector<float>& storage,
                                     std::size_t length) {
  storage.resize(most_arrays * length);
  Arrays arrays(storage, length);
  engine::TileWork::Results r;
  r.normal = arrays.three(outputs.normal);
  r.base_normal = arrays.three(outputs.base_normal);
  r.surfgrad = arrays.three(outputs.surfgrad);
  r.sunlight = arrays.one(outputs.sunlight);
  r.degenerate = arrays.one(true);
  r.to_viewer = arrays.three(outputs.to_viewer);
  r.mesh_normal = arrays.three(outputs.vertex_frame);
  r.tangent = arrays.three(outputs.vertex_frame);
  r.sign = arrays.one(outputs.vertex_frame);
  r.st = arrays.two(outputs.st);
  r.slot = outputs.slot;
  return r;
}

/// The same results from the i-th pixel on.
engine::TileWork::Results results_from(const engine::TileWork::Results& results, int i) {
  const auto one = [i](float* array) { return array == nullptr ? nullptr : array + i; };
  const auto two = [&](vec2<float*> a) { return vec2<float*>{one(a.x), one(a.y)}; };
  const auto three = [&](vec3<float*> a) { return vec3<float*>{one(a.x), one(a.y), one(a.z)}; };
  return {three(results.normal),
          three(results.base_normal),
          three(results.surfgrad),
          one(results.sunlight),
          one(results.degenerate),
          three(results.to_viewer),
          three(results.mesh_normal),
          three(results.tangent),
          one(results.sign),
          two(results.st),
          results.slot};
}

} // namespace

/// Lists the pixels triangle by triangle, the triangles of a surface and material together.
void TileComposer::collect(Scratch& s) const {
  const auto shown = s.scan.shown();
  s.order.resize(shown.size());
  std::iota(s.order.begin(), s.order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const raster::TriangleId& id = shown[i].id;
    return std::tuple(id.surface, stage_.material_of(id), i); // all differ: a stable sort would allocate
  };
  std::sort(s.order.begin(), s.order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  s.next.resize(shown.size());
  int first = 0;
  for (const std::uint32_t i : s.order) {
    s.next[i] = first;
    first += shown[i].pixels;
  }
  const raster::Tile& tile = s.composed.tile;
  for (const raster::TileScan::Run& run : s.scan.runs()) {
    const auto begin = static_cast<std::size_t>(s.next[static_cast<std::size_t>(run.owner)]);
    s.next[static_cast<std::size_t>(run.owner)] += run.count;
    const float y = static_cast<float>(tile.y + run.y) + 0.5f;
    for (int i = 0; i < run.count; ++i) {
      const std::size_t at = begin + static_cast<std::size_t>(i);
      s.which[at] = run.owner;
      s.pixel[at] = run.y * tile.width + run.x + i;
      s.x[at] = static_cast<float>(tile.x + run.x + i) + 0.5f;
      s.y[at] = y;
    }
  }
  s.composed.count = first;
  s.setups.resize(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    double x = tile.x + shown[i].first_pixel % tile.width + 0.5;
    double y = tile.y + shown[i].first_pixel / tile.width + 0.5;
    if (const auto& nearest = shown[i].nearest) {
      x = nearest->x;
      y = nearest->y;
      // Rounded as the setup is: so lanes find themselves at its centre, however thin the triangle.
      const auto at = static_cast<std::size_t>(s.next[i] - 1);
      s.x[at] = static_cast<float>(x);
      s.y[at] = static_cast<float>(y);
    }
    raster::set_up(stage_.surfaces()[shown[i].id.surface], shown[i].id.triangle, shown[i].planes, x, y,
                   s.setups[i]);
  }
}

const ComposedTile& TileComposer::compose(int column, int row) {
  Scratch& s = scratches_->each.local();
  // What the last pack of a run writes beyond it is overwritten by the next run, or padding.
  const std::size_t length = most_pixels_ + most_lanes;
  if (s.x.size() != length) {
    for (auto* list : {&s.which, &s.pixel}) list->assign(length, 0);
    for (auto* list : {&s.x, &s.y}) list->assign(length, 0.0f);
    s.composed.results = results_of(outputs_, s.results, length);
  }
  s.composed.tile = grid_.tile(column, row);
  s.scan.scan(
      stage_.surfaces(), projection_, s.composed.tile, grid_.candidates(column, row),
      [&](const raster::TriangleId& id, bool front) {
        // Winding in a texture says mirrored, not turned away.
        return projection_.has_depth() && stage_.culled(id, front);
      },
      projection_.has_depth() ? raster::Coverage::centres : raster::Coverage::squares);
  s.composed.overlapping = s.scan.overlapping();
  s.composed.touched = s.scan.touched();
  collect(s);
  s.runs.clear();
  const auto shown = s.scan.shown();
  for (std::size_t i = 0; i < s.order.size();) {
    const raster::TriangleId first = shown[s.order[i]].id;
    const int begin = s.next[s.order[i]] - shown[s.order[i]].pixels;
    int end = begin;
    for (; i < s.order.size(); ++i) {
      const raster::TileScan::Shown& next = shown[s.order[i]];
      if (next.id.surface != first.surface || stage_.material_of(next.id) != stage_.material_of(first)) break;
      end += next.pixels;
    }
    engine::TileWork work = stage_.work_of(first);
    work.wanted.screen = projection_.has_depth();
    work.wanted.to_viewer = projection_.has_depth();
    work.shown = shown;
    work.setups = s.setups.data();
    work.count = end - begin;
    work.which = s.which.data() + begin;
    work.x = s.x.data() + begin;
    work.y = s.y.data() + begin;
    work.results = results_from(s.composed.results, begin);
    stage_.compose(work, first);
    s.runs.push_back({first.surface, begin, end});
  }
  s.composed.pixel = s.pixel.data();
  s.composed.runs = s.runs;
  return s.composed;
}

void TileComposer::compose_row(int row, const std::function<void(const ComposedTile&)>& take) {
  constexpr int columns_each = 8; // a few hundred microseconds of work
  tbb::parallel_for(tbb::blocked_range<int>(0, grid_.columns(), columns_each),
                    [&](const tbb::blocked_range<int>& columns) {
                      for (int column = columns.begin(); column < columns.end(); ++column)
                        take(compose(column, row));
                    });
}

} // namespace surfgrad::stage
