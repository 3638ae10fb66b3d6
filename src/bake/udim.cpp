#include "bake/udim.hpp"

#include "diagnostic/error.hpp"

#include <surfgrad/vec.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>

namespace surfgrad::bake {
namespace {

constexpr int columns = 10;
constexpr int rows = 900;
constexpr int last_number = 9999; // numbers have four digits

// Exporters round: what reaches into a tile by less than a quarter of the smallest texel is not in it.
constexpr double rounding = 0.25 / 16384;

using Triangle = std::array<vec2<double>, 3>;

struct Range {
  double low, high;
};

template <std::size_t N>
Range range_of(const std::array<vec2<double>, N>& points, vec2<double> axis) {
  Range range{dot(points[0], axis), dot(points[0], axis)};
  for (const vec2<double> p : points) {
    range.low = std::min(range.low, dot(p, axis));
    range.high = std::max(range.high, dot(p, axis));
  }
  return range;
}

bool has_area(const Triangle& triangle) {
  const vec2<double> a = triangle[1] - triangle[0];
  const vec2<double> b = triangle[2] - triangle[0];
  return a.x * b.y != a.y * b.x;
}

/// Whether they have an area in common: no line parallel to a side of either lies between them.
bool overlap(const Triangle& triangle, const UdimTile& tile) {
  const double s = tile.column;
  const double t = tile.row;
  const std::array<vec2<double>, 4> square{{{s, t}, {s + 1, t}, {s, t + 1}, {s + 1, t + 1}}};
  std::array<vec2<double>, 5> axes{{{1, 0}, {0, 1}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const vec2<double> side = triangle[(i + 1) % 3] - triangle[i];
    axes[2 + i] = {-side.y, side.x};
  }
  return std::all_of(axes.begin(), axes.end(), [&](vec2<double> axis) {
    const Range a = range_of(triangle, axis);
    const Range b = range_of(square, axis);
    // Of unit length along s and t; along the sides of triangles a sliver more or less is no matter.
    return a.low + rounding < b.high && b.low + rounding < a.high;
  });
}

} // namespace

std::vector<UdimTile> udim_tiles(const scene::Scene& scene, int uv_set) {
  std::set<int> numbers;
  for (const scene::Object& object : scene.objects) {
    const mesh::TriangleMesh& mesh = scene.meshes[object.mesh];
    if (static_cast<std::size_t>(uv_set) >= mesh.uv_sets.size())
      throw InputError(
          {.file = scene.source,
           .place = "mesh \"" + object.name + "\"",
           .problem = fmt::format("has {} UV sets, but set {} is to be baked", mesh.uv_sets.size(), uv_set),
           .remedy = "choose another with --uv, or unwrap the mesh"});
    const std::vector<vec2<float>>& uvs = mesh.uv_sets[static_cast<std::size_t>(uv_set)];
    for (const auto& vertices : mesh.triangles) {
      Triangle triangle;
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = {uvs[vertices[i]].x, uvs[vertices[i]].y};
      if (!has_area(triangle)) continue;
      const Range s = range_of(triangle, {1, 0});
      const Range t = range_of(triangle, {0, 1});
      if (!(s.low >= -rounding && s.high <= columns + rounding && t.low >= -rounding &&
            t.high <= rows + rounding))
        throw InputError(
            {.file = scene.source,
             .place = "mesh \"" + object.name + "\"",
             .problem = fmt::format("UV set {} reaches from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}), where "
                                    "there is no UDIM tile",
                                    uv_set, s.low, t.low, s.high, t.high),
             .remedy =
                 fmt::format("lay it out within (0, 0) and ({}, {}), tiles 1001 to 9999", columns, rows)});
      for (int row = std::max(0, static_cast<int>(t.low)); row < std::min<double>(rows, t.high); ++row)
        for (int column = std::max(0, static_cast<int>(s.low)); column < std::min<double>(columns, s.high);
             ++column)
          if (const UdimTile tile{column, row}; overlap(triangle, tile)) numbers.insert(tile.number());
    }
  }
  if (numbers.empty())
    throw InputError({.file = scene.source,
                      .problem = fmt::format("no triangle has an area in UV set {}", uv_set),
                      .remedy = "unwrap the mesh"});
  if (*numbers.rbegin() > last_number)
    throw InputError({.file = scene.source,
                      .problem = fmt::format("UV set {} reaches beyond UDIM tile {}", uv_set, last_number),
                      .remedy = "lay it out in tiles 1001 to 9999"});
  std::vector<UdimTile> tiles;
  for (const int number : numbers) tiles.push_back({(number - 1001) % 10, (number - 1001) / 10});
  return tiles;
}

} // namespace surfgrad::bake
