#include "image/cube_map.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>

namespace surfgrad::image {
namespace {

constexpr std::array face_names{"+x", "-x", "+y", "-y", "+z", "-z"};

std::string shape(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

std::optional<CubeFault> fault_of(const std::array<const Image*, 6>& faces) {
  for (int f = 0; f < 6; ++f) {
    const Image& face = *faces[f];
    const std::string name = std::string("face ") + face_names[f];
    const int channels = face.channels - (face.has_alpha ? 1 : 0);
    if (channels < 3)
      return CubeFault{name + " has " + std::to_string(channels) + (channels == 1 ? " channel" : " channels"),
                       "a direction of x, y and z needs three", f};
    if (face.width != face.height || face.width < 1)
      return CubeFault{name + " is " + shape(face), "expected a square", f};
    if (face.width > max_cube_size)
      return CubeFault{name + " is " + shape(face),
                       "expected at most " + std::to_string(max_cube_size) + " texels a side", f};
    if (face.width != faces[0]->width)
      return CubeFault{name + " is " + shape(face) + ", face +x is " + shape(*faces[0]),
                       "expected six faces of one size", f};
  }
  return std::nullopt;
}

/// Where a face lies in an image that holds all: cells from the left and from the top.
struct Cell {
  int column, row;
  bool turned = false; ///< by 180 degrees
};
struct Layout {
  int columns, rows;
  std::array<Cell, 6> cells;
};
constexpr std::array<Layout, 4> layouts{{
    {6, 1, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}},
    {1, 6, {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}},
    {4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}},
    {3, 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3, true}}}},
}};

Image cut(const Image& image, const Layout& layout, const Cell& cell) {
  const int size = image.width / layout.columns;
  Image face = make_image(size, size, image.channels, image.depth);
  face.has_alpha = image.has_alpha;
  const int left = cell.column * size;
  const int bottom = (layout.rows - 1 - cell.row) * size;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < image.channels; ++c)
        face.at(x, y, c) = cell.turned ? image.at(left + size - 1 - x, bottom + size - 1 - y, c)
                                       : image.at(left + x, bottom + y, c);
  return face;
}

/// One level of six unbordered faces.
struct Level {
  const std::array<Map, 6>& faces;
  int level;
  int size;

  [[nodiscard]] vec3<double> texel(int face, int x, int y) const {
    const auto component = [&](int c) { return faces[face].value(level, x, y, c); };
    return {component(0), component(1), component(2)};
  }

  /// The texel of the next face that adjoins this face's border texel (x, y): one of the two is -1 or size.
  [[nodiscard]] vec3<double> across_edge(int face, int x, int y) const {
    // Fold the texel's centre over the edge: from half a texel beyond it to half a texel down the next
    // face. That is the centre of a texel there, far from any rounding.
    const auto centre = [&](int i) { return (2.0 * i + 1) / size - 1; };
    const auto on_edge = [&](int i) { return i < 0 ? -1.0 : i < size ? centre(i) : 1.0; };
    const vec3<double> edge = cube_direction(face, {on_edge(x), on_edge(y)});
    const vec3<double> folded = edge - (1.0 / size) * cube_direction(face, {0, 0});
    const detail::CubePoint<double> p = detail::cube_point(folded);
    const auto index = [&](double s) { return static_cast<int>((0.5 * s + 0.5) * size); };
    return texel(p.face, index(p.st.x), index(p.st.y));
  }

  [[nodiscard]] vec3<double> bordered(int face, int x, int y) const {
    const int near_x = std::min(std::max(x, 0), size - 1);
    const int near_y = std::min(std::max(y, 0), size - 1);
    if (x == near_x && y == near_y) return texel(face, x, y);
    if (x == near_x || y == near_y) return across_edge(face, x, y);
    return (1.0 / 3) *
           (texel(face, near_x, near_y) + across_edge(face, x, near_y) + across_edge(face, near_x, y));
  }
};

} // namespace

vec3<double> cube_direction(int face, vec2<double> st) {
  const auto [s, t] = st;
  switch (face) {
  case 0:
    return {1, t, -s};
  case 1:
    return {-1, t, s};
  case 2:
    return {s, 1, -t};
  case 3:
    return {s, -1, t};
  case 4:
    return {s, t, 1};
  default:
    return {-s, t, -1};
  }
}

CubeMap cube_of_faces(const std::array<Map, 6>& faces) {
  CubeMap cube;
  Map& map = cube.map;
  map.components = 3;
  map.level_count = faces[0].level_count;
  for (int level = 0; level < map.level_count; ++level) {
    const Level source{faces, level, faces[0].width(level)};
    const int width = source.size + 2;
    map.level_table.insert(map.level_table.end(),
                           {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(6 * width),
                            static_cast<std::uint32_t>(map.words.size())});
    // The copies that end a map's rows and levels too, although no direction reads them.
    for (int row = 0; row <= 6 * width; ++row)
      for (int column = 0; column <= width; ++column) {
        const int in_map = row % (6 * width);
        const vec3<double> v = source.bordered(in_map / width, column % width - 1, in_map % width - 1);
        for (const double c : {v.x, v.y, v.z})
          map.words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(c)));
      }
  }
  map.words.insert(map.words.end(), words_read_ahead, 0);
  return cube;
}

std::variant<CubeMap, CubeFault> make_cube_map(const std::array<const Image*, 6>& faces) {
  if (const auto fault = fault_of(faces)) return *fault;
  std::array<Map, 6> maps;
  for (int f = 0; f < 6; ++f) maps[f] = make_direction_map(*faces[f], true);
  return cube_of_faces(maps);
}

std::variant<CubeMap, CubeFault> make_cube_map(const Image& image) {
  for (const Layout& layout : layouts) {
    if (image.width * layout.rows != image.height * layout.columns || image.width % layout.columns != 0)
      continue;
    std::array<Image, 6> faces;
    std::array<const Image*, 6> pointers{};
    for (int f = 0; f < 6; ++f) {
      faces[f] = cut(image, layout, layout.cells[f]);
      pointers[f] = &faces[f];
    }
    auto result = make_cube_map(pointers);
    if (CubeFault* fault = std::get_if<CubeFault>(&result)) fault->face = -1;
    return result;
  }
  return CubeFault{"is " + shape(image) + ", which is no layout of six square faces",
                   "expected a strip (6:1 or 1:6), a cross (4:3 or 3:4) or six separate images"};
}

} // namespace surfgrad::image
