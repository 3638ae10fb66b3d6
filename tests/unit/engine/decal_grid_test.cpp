// The grid finds every decal that reaches a point, and looks at few others.

#include "lab.hpp"
#include "simd/emulated_lanes.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

namespace surfgrad::engine {
namespace {

using simd::EmulatedFloat;
using test::Random;

Bounds around(vec3<double> centre, vec3<double> half) { return {centre - half, centre + half}; }
Bounds at(vec3<double> p) { return {p, p}; }

std::vector<std::uint32_t> all_that_meet(const std::vector<Bounds>& boxes, const std::vector<Bounds>& where) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    for (const Bounds& w : where)
      if (meet(boxes[i], w)) {
        found.push_back(i);
        break;
      }
  return found;
}

void expect_all(const DecalGrid& grid, const std::vector<Bounds>& boxes, const std::vector<Bounds>& where) {
  const auto found = grid.search(where);
  EXPECT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), all_that_meet(boxes, where));
}

TEST(DecalGrids, FindWhatALookAtEveryBoxFinds) {
  constexpr std::uint64_t seed = 301;
  SCOPED_TRACE(seed);
  Random random(seed);
  std::size_t hits = 0;
  for (int round = 0; round < 40; ++round) {
    std::vector<Bounds> boxes;
    const double spread = random.magnitude(1e-3, 1e6);
    const vec3<double> far = random.magnitude(1e-6, 1e12) * random.vector3();
    for (int i = 0; i < 200; ++i) {
      const double size = spread * random.magnitude(1e-9, 1e3);
      boxes.push_back(around(far + spread * random.vector3(), size * random.vector3(0, 1)));
    }
    boxes.push_back(boxes[3]);                       // twice the same
    boxes.push_back(at(boxes[4].low));               // of no extent
    boxes.push_back(around(far, {1e12, 1e-9, 1e3})); // long and thin
    const DecalGrid grid(boxes);
    for (int k = 0; k < 300; ++k) {
      const Bounds& box = boxes[random.bits() % boxes.size()];
      const double s = random.integer(3) * 0.5;
      // Corners, edges and middles of boxes; and anywhere.
      const vec3<double> on = box.low + s * (box.high - box.low);
      const vec3<double> p = random.integer(2) == 0 ? on : far + spread * random.vector3();
      expect_all(grid, boxes, {at(p)});
      hits += grid.search(std::array{at(p)}).size();
      const double wide = spread * random.magnitude(1e-12, 10);
      expect_all(grid, boxes, {around(p, {wide, wide, wide}), at(on), at(p)});
    }
  }
  std::printf("  boxes found in 12000 searches: %zu\n", hits);
  EXPECT_GT(hits, 6000u);
}

TEST(DecalGrids, FindTheSameFromPlaceToPlace) {
  constexpr std::uint64_t seed = 304;
  SCOPED_TRACE(seed);
  Random random(seed);
  // More lists in use at a time than a thread remembers, copies and lists that took another's place.
  std::vector<std::vector<Bounds>> boxes(40);
  std::vector<DecalGrid> grids(40);
  std::size_t hits = 0;
  for (int round = 0; round < 3; ++round) {
    for (std::size_t g = 0; g < grids.size(); ++g) {
      boxes[g].clear();
      for (int i = 0; i < 60; ++i) {
        const double half = random.magnitude(1e-3, 2);
        boxes[g].push_back(around(random.vector3(-2, 2), half * random.vector3(0.1, 1)));
      }
      grids[g] = DecalGrid(boxes[g]);
    }
    for (const double reach : {0.0, 1e-3, 0.1, 10.0, 1e300, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN()})
      for (int walk = 0; walk < 20; ++walk) {
        const std::size_t g = random.bits() % grids.size();
        const std::size_t other = random.bits() % grids.size();
        const DecalGrid copy = grids[g];
        vec3<double> p = random.vector3(-2, 2);
        for (int step = 0; step < 50; ++step) {
          p = p + random.magnitude(1e-4, 0.1) * random.vector3();
          const double half = random.magnitude(1e-6, 0.1);
          const Bounds where = around(p, half * random.vector3(0, 1));
          using Use = std::pair<const DecalGrid*, std::size_t>;
          for (const auto& [grid, list] : {Use(&grids[g], g), Use(&copy, g), Use(&grids[other], other)}) {
            const auto found = grid->near(where, reach);
            ASSERT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()),
                      all_that_meet(boxes[list], {where}));
            hits += found.size();
          }
        }
      }
  }
  std::printf("  boxes found from place to place: %zu\n", hits);
  EXPECT_GT(hits, 10000u);
}

TEST(DecalGrids, HoldTheirBordersAtCellBorders) {
  // Corners at powers of two and their sums are corners of cells, whatever their size.
  std::vector<Bounds> boxes;
  for (const double size : {0.25, 1.0, 2.0})
    for (int x = -4; x <= 4; ++x)
      for (int y = -4; y <= 4; ++y)
        boxes.push_back({{x * size, y * size, 0}, {(x + 1) * size, (y + 1) * size, size}});
  const DecalGrid grid(boxes);
  for (const double step : {0.0, 0x1p-52, -0x1p-52, 0x1p-1060})
    for (int x = -9; x <= 9; ++x)
      for (int y = -9; y <= 9; ++y) expect_all(grid, boxes, {at({x * 0.5 + step, y * 0.5, 0.25})});
}

TEST(DecalGrids, OfNothingFindNothing) {
  EXPECT_TRUE(DecalGrid().search(std::array{at({0, 0, 0})}).empty());
  EXPECT_TRUE(DecalGrid(std::vector<Bounds>{}).search(std::array{at({0, 0, 0})}).empty());
  EXPECT_TRUE(DecalGrid(std::vector<Bounds>{around({0, 0, 0}, {1, 1, 1})}).search({}).empty());
}

TEST(DecalGrids, LookAtFewBoxesBesideThoseThatCover) {
  Random random(302);
  // A thousand of one size, spread so that two seldom meet; and a few of other sizes.
  std::vector<Bounds> boxes;
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y)
      for (int z = 0; z < 10; ++z)
        boxes.push_back(
            around({x + 0.3 * random.uniform(), y + 0.3 * random.uniform(), z + 0.3 * random.uniform()},
                   {0.3, 0.3, 0.3}));
  const std::size_t even = DecalGrid(boxes).most_looks();
  boxes.push_back(around({5, 5, 5}, {500, 500, 500}));
  for (int i = 0; i < 20; ++i) boxes.push_back(around(random.vector3(0, 10), {1e-4, 1e-4, 1e-4}));
  const std::size_t mixed = DecalGrid(boxes).most_looks();
  std::printf("  looks at most: %zu of 1000, %zu of 1021\n", even, mixed);
  // Cells of one to two sizes: within them and beside them, three a side.
  EXPECT_LE(even, 27u);
  EXPECT_LE(mixed, even + 1 + 2);
}

// The same, of decals at fragments.

template <class T>
raster::Fragment<T> fragment_at(vec3<T> position, vec3<double> normal) {
  raster::Fragment<T> f{};
  f.position = position;
  f.normal = {static_cast<T>(normal.x), static_cast<T>(normal.y), static_cast<T>(normal.z)};
  const vec3<double> t = normalize_or_zero(cross(normal, {0.3, 0.5, 0.8}));
  f.dp_dx = T(1e-3) * vec3<T>{static_cast<T>(t.x), static_cast<T>(t.y), static_cast<T>(t.z)};
  f.dp_dy = cross(f.normal, f.dp_dx);
  f.front_facing = true;
  return f;
}

struct DecalLists : ::testing::Test {
  static constexpr std::uint64_t seed = 303;
  ::testing::ScopedTrace trace{__FILE__, __LINE__, seed};
  Random random{seed};
  test::Lab lab{};
  void SetUp() override {
    lab.add("a", surfgrad::test::random_normal_map(random, 16, 16, 0.5));
    lab.add("cube", surfgrad::test::random_image(random, 24, 4, 3));
  }
  Decals compiled(const stack::DecalLayer& layer) {
    return std::get<Decals>(lab.compile({layer}).layers.at(0));
  }
};

template <class T>
std::span<const std::uint32_t> near(const Decals& decals, const Point<T>& point) {
  return decals_near(decals, surface_in_space(point, decals.world));
}

/// Applied by way of the grid and by trying every decal: the same bits.
template <class T>
bool expect_same(const Decals& decals, const Placement& placement, raster::Fragment<T> f) {
  Point<T> point{f, make_frame(f.normal, f.dp_dx, f.dp_dy, f.front_facing, BackFaces::same), placement};
  vec3<T> found{T(0.25), T(-0.5), T(0.125)};
  vec3<T> tried = found;
  bool degenerate = false;
  apply(decals, point, found, degenerate);
  std::vector<std::uint32_t> every(decals.decals.size());
  std::iota(every.begin(), every.end(), 0u);
  apply(decals, every, point, surface_in_space(point, decals.world), tried, degenerate);
  EXPECT_EQ(std::memcmp(&found, &tried, sizeof found), 0)
      << found.x << " " << found.y << " " << found.z << " against " << tried.x << " " << tried.y << " "
      << tried.z;
  return tried.x != T(0.25) || tried.y != T(-0.5);
}

TEST_F(DecalLists, ComeOutTheSameByWayOfTheGridBitForBit) {
  long covered = 0, tried = 0;
  for (const auto& word : stack::words_of<stack::DecalShape>) {
    const bool round = word.value == stack::DecalShape::sphere || word.value == stack::DecalShape::capsule;
    for (const bool object : {false, true})
      for (const double far : {0.0, 1e3, 1e7}) {
        stack::DecalLayer layer = test::decal_layer(round ? "cube" : "a", word.value);
        layer.falloff = 0; // the hardest edge shows the slightest difference
        layer.space = object ? stack::Space::object : stack::Space::world;
        const vec3<double> origin = far * random.vector3();
        layer.instances.assign(100, {});
        for (stack::DecalInstance& decal : layer.instances) {
          const double size = random.magnitude(1e-4, 3);
          decal.position = (object ? vec3<double>{0, 0, 0} : origin) + random.vector3(-2, 2);
          decal.direction = random.integer(2) == 0 ? vec3<double>{0, 0, -1} : random.unit_vector();
          decal.size = size * random.vector3(0.1, 1);
          decal.angle_deg = random.uniform(5, 150);
          decal.depth = size;
          decal.radius = size;
          decal.length = random.integer(2) * size;
          decal.blend = stack::words_of<stack::DecalBlend>[random.bits() % 3].value;
          decal.opacity = random.uniform(0.2, 1);
        }
        const Decals decals = compiled(layer);
        mat4<double> m{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
        if (object)
          m = {{2, 0.5, 0, origin.x}, {0, -0.5, 0, origin.y + 3}, {0, 0, 3, origin.z}, {0, 0, 0, 1}};
        const Placement placement = place(m, origin);
        for (int k = 0; k < 400; ++k) {
          // On the border of a decal's bounds as often as anywhere.
          const Decal& decal = decals.decals[random.bits() % decals.decals.size()];
          const Bounds bounds = bounds_of(decal, word.value);
          vec3<double> p = bounds.low + random.vector3(0, 1) * 1.0;
          p = {bounds.low.x + random.integer(5) * 0.25 * (bounds.high.x - bounds.low.x),
               bounds.low.y + random.integer(5) * 0.25 * (bounds.high.y - bounds.low.y),
               bounds.low.z + random.integer(5) * 0.25 * (bounds.high.z - bounds.low.z)};
          if (random.integer(2) == 0) p = p + 1e-7 * random.vector3();
          if (object) {
            const vec4<double> w = m * vec4<double>{p.x, p.y, p.z, 1};
            p = {w.x, w.y, w.z};
          }
          const vec3<double> d = p - origin;
          const vec3<double> n = random.unit_vector();
          const vec3<float> narrow{static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
          covered += expect_same<float>(decals, placement, fragment_at(narrow, n));
          covered += expect_same<double>(decals, placement, fragment_at(d, n));
          tried += 2;
        }
      }
  }
  std::printf("  fragments under a decal: %ld of %ld\n", covered, tried);
  EXPECT_GT(covered, tried / 10);
}

TEST_F(DecalLists, ComeOutTheSameWhereTheirBordersPassTheEye) {
  // Positions next to nothing, decals not: what their own rounding lets in must be found.
  long covered = 0;
  stack::DecalLayer layer = test::decal_layer("a");
  layer.falloff = 0;
  for (int k = 0; k < 4000; ++k) {
    stack::DecalInstance& decal = layer.instances[0];
    decal.position = random.vector3();
    decal.direction = random.unit_vector();
    decal.size = random.vector3(0.1, 1);
    const Decals decals = compiled(layer);
    // The corner farthest along x, where the box touches its bounds; a little farther, or nearer.
    const DecalFrame<double>& frame = decals.decals[0].frame;
    const vec3<double> half = decals.decals[0].half_size;
    const auto side = [](double x) { return x < 0 ? -1.0 : 1.0; };
    const vec3<double> corner = frame.origin + side(frame.axis_x.x) * half.x * frame.axis_x +
                                side(frame.axis_y.x) * half.y * frame.axis_y +
                                side(frame.axis_z.x) * half.z * frame.axis_z;
    const vec3<double> eye = corner + vec3<double>{random.sign() * random.magnitude(1e-11, 1e-8), 0, 0};
    covered +=
        expect_same<float>(decals, place({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, eye),
                           fragment_at<float>({1e-13f, 0, 0}, random.unit_vector()));
  }
  EXPECT_GT(covered, 50);
}

/// One fragment a lane.
raster::Fragment<EmulatedFloat> pack_of(const std::vector<raster::Fragment<float>>& lanes) {
  raster::Fragment<EmulatedFloat> pack{};
  const auto put = [](vec3<EmulatedFloat>& to, int i, vec3<float> v) {
    to.x.lane[i] = v.x;
    to.y.lane[i] = v.y;
    to.z.lane[i] = v.z;
  };
  for (int i = 0; i < simd::emulated_width; ++i) {
    const raster::Fragment<float>& f = lanes[static_cast<std::size_t>(i)];
    put(pack.position, i, f.position);
    put(pack.normal, i, f.normal);
    put(pack.dp_dx, i, f.dp_dx);
    put(pack.dp_dy, i, f.dp_dy);
    pack.front_facing.lane[i] = true;
  }
  return pack;
}

TEST_F(DecalLists, OfAPackAreThoseOfItsLanes) {
  // Lanes side by side, far apart and nowhere; walks across a place, as a row of pixels does.
  long covered = 0;
  for (const auto& word : stack::words_of<stack::DecalShape>) {
    const bool round = word.value == stack::DecalShape::sphere || word.value == stack::DecalShape::capsule;
    stack::DecalLayer layer = test::decal_layer(round ? "cube" : "a", word.value);
    layer.falloff = 0;
    layer.instances.assign(200, {});
    for (stack::DecalInstance& decal : layer.instances) {
      const double size = random.magnitude(1e-3, 1);
      decal.position = random.vector3(-1, 1);
      decal.direction = random.integer(2) == 0 ? vec3<double>{0, 0, -1} : random.unit_vector();
      decal.size = {size, size, size};
      decal.depth = size;
      decal.radius = 0.5 * size;
      decal.length = size;
      decal.blend = stack::words_of<stack::DecalBlend>[random.bits() % 3].value;
    }
    const Decals decals = compiled(layer);
    for (const double origin : {0.0, 1e4}) {
      const Placement placement =
          place({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, {0, 0, origin});
      for (int walk = 0; walk < 40; ++walk) {
        vec3<double> p = random.vector3(-1, 1) - vec3<double>{0, 0, origin};
        const vec3<double> n = random.unit_vector();
        const vec3<double> along = normalize_or_zero(cross(n, random.unit_vector()));
        for (int k = 0; k < 20; ++k) {
          std::vector<raster::Fragment<float>> lanes;
          for (int i = 0; i < simd::emulated_width; ++i) {
            p = p + 5e-3 * along; // pixels are 1e-3 wide: near enough to be looked up at once
            vec3<double> at = p;
            if (k % 5 == 4 && i > 4) at = random.vector3(-1, 1) - vec3<double>{0, 0, origin};
            if (k % 7 == 6 && i == walk % 8) at.x = std::numeric_limits<double>::quiet_NaN();
            lanes.push_back(fragment_at<float>(
                {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)}, n));
          }
          raster::Fragment<EmulatedFloat> f = pack_of(lanes);
          Point<EmulatedFloat> point{
              f, make_frame(f.normal, f.dp_dx, f.dp_dy, f.front_facing, BackFaces::same), placement};
          vec3<EmulatedFloat> sum{EmulatedFloat(0.25f), EmulatedFloat(-0.5f), EmulatedFloat(0.125f)};
          simd::EmulatedMask degenerate{};
          apply(decals, point, sum, degenerate);
          for (int i = 0; i < simd::emulated_width; ++i) {
            raster::Fragment<float>& one = lanes[static_cast<std::size_t>(i)];
            Point<float> alone{one, make_frame(one.normal, one.dp_dx, one.dp_dy, true, BackFaces::same),
                               placement};
            vec3<float> expected{0.25f, -0.5f, 0.125f};
            bool odd = false;
            std::vector<std::uint32_t> every(decals.decals.size());
            std::iota(every.begin(), every.end(), 0u);
            apply(decals, every, alone, surface_in_space(alone, true), expected, odd);
            ASSERT_EQ(sum.x.lane[i], expected.x) << word.text << " " << walk << " " << k << " " << i;
            ASSERT_EQ(sum.y.lane[i], expected.y);
            ASSERT_EQ(sum.z.lane[i], expected.z);
            ASSERT_EQ(degenerate.lane[i], odd);
            covered += expected.x != 0.25f;
          }
        }
      }
    }
  }
  std::printf("  lanes under a decal: %ld of 64000\n", covered);
  EXPECT_GT(covered, 6000);
}

TEST_F(DecalLists, CostWhatCoversTheFragment) {
  stack::DecalLayer layer = test::decal_layer("a");
  layer.instances.clear();
  for (int x = -50; x < 50; ++x)
    for (int y = 0; y < 10; ++y) {
      stack::DecalInstance decal;
      decal.position = {1.0 * x, 1.0 * y, 0};
      decal.size = {0.8, 0.5, 0.8};
      layer.instances.push_back(decal);
    }
  const Decals thousand = compiled(layer);
  layer.instances = {layer.instances[505]};
  const Decals one = compiled(layer);
  const Placement placement = test::placed(test::identity);
  auto f = fragment_at<double>({0.1, 5.1, 0.1}, {0, 1, 0});
  const Point<double> point{f, make_frame(f.normal, f.dp_dx, f.dp_dy), placement};
  ASSERT_EQ(near(one, point).size(), 1u);
  ASSERT_EQ(near(thousand, point).size(), 1u);
  EXPECT_EQ(near(thousand, point)[0], 505u);
  EXPECT_LE(thousand.grid.most_looks(), 9u) << "one layer of cells, three a side";
}

TEST_F(DecalLists, AreNotReachedByPositionsThatAreNoNumbers) {
  const Decals decals = compiled(test::decal_layer("a"));
  const Placement placement = test::placed(test::identity);
  for (const double no :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    auto f = fragment_at<double>({0, no, 0}, {0, 1, 0});
    const Point<double> point{f, make_frame(f.normal, f.dp_dx, f.dp_dy), placement};
    EXPECT_TRUE(near(decals, point).empty());
  }
}

} // namespace
} // namespace surfgrad::engine
