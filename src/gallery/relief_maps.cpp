#include "gallery/relief_maps.hpp"

#include "gallery/periodic_noise.hpp"
#include "image/cube_map.hpp"
#include "scene/map_functions.hpp"

#include <algorithm>
#include <cmath>

namespace surfgrad::gallery {
namespace {

using image::Image;

/// Distance to a rectangle, negative inside.
double rectangle(vec2<double> p, vec2<double> centre, vec2<double> half) {
  const vec2<double> d{std::abs(p.x - centre.x) - half.x, std::abs(p.y - centre.y) - half.y};
  return std::hypot(std::max(d.x, 0.0), std::max(d.y, 0.0)) + std::min(std::max(d.x, d.y), 0.0);
}

double knobs(double s, double t) {
  constexpr int count = 15; // odd: the middle column, which some shapes draw out, runs over knobs
  return 0.007 * scene::arch(count * s) * scene::arch(count * t);
}

double letter(double s, double t) {
  const vec2<double> p{s, t};
  const double stem = rectangle(p, {0.36, 0.5}, {0.06, 0.28});
  const double top = rectangle(p, {0.5, 0.72}, {0.2, 0.06});
  const double bar = rectangle(p, {0.46, 0.49}, {0.16, 0.06});
  const double distance = std::min({stem, top, bar});
  constexpr double height = 0.03;
  constexpr double slope_width = 0.035;
  constexpr double clearance = 0.04; // the ground beside the letter is level
  const double ground = scene::smooth(0, clearance, distance);
  return height * scene::smooth(0, slope_width, -distance) + ground * knobs(s, t);
}

/// Distances to the nearest and the second nearest of the points scattered one to a cell, in cells, and
/// a number in [0, 1) that belongs to the nearest.
struct Cells {
  double nearest = 2;
  double second = 2;
  double id = 0;
};

Cells periodic_cells(double s, double t, int cells) {
  const PeriodicHash hash{cells};
  const vec2<double> p{cells * s, cells * t};
  const int x0 = static_cast<int>(std::floor(p.x));
  const int y0 = static_cast<int>(std::floor(p.y));
  Cells found;
  for (int y = y0 - 2; y <= y0 + 2; ++y)
    for (int x = x0 - 2; x <= x0 + 2; ++x) {
      const auto bits = static_cast<std::uint32_t>(hash(x, y, 0));
      const auto part = [bits](int shift) { return ((bits >> shift) & 1023U) / 1024.0; };
      // Not over the whole cell: no two stones grow into one.
      const double distance = std::hypot(x + 0.1 + 0.8 * part(0) - p.x, y + 0.1 + 0.8 * part(10) - p.y);
      if (distance < found.nearest) {
        found.second = found.nearest;
        found.nearest = distance;
        found.id = part(20);
      } else {
        found.second = std::min(found.second, distance);
      }
    }
  return found;
}

double cobbles(double s, double t) {
  constexpr int stones = 5;
  const Cells cell = periodic_cells(s, t, stones);
  const double joint = scene::smooth(-0.05, 0.45, cell.second - cell.nearest);
  const double round = 1 - 0.45 * cell.nearest * cell.nearest;
  const double stone = joint * round * (0.62 + 0.38 * cell.id);
  return std::clamp(0.96 * stone + 0.02 + 0.03 * periodic_noise(s, t, 24), 0.0, 1.0);
}

double crags(double s, double t) {
  // Folded noise has sharp crests; a second noise raises some regions over others.
  double sum = 0.16 * periodic_noise(s, t, 3);
  double amplitude = 0.09;
  for (int cells = 4; cells <= 128; cells *= 2) {
    sum -= amplitude * std::abs(periodic_noise(s, t, cells));
    amplitude *= 0.5;
  }
  return sum;
}

} // namespace

Image letter_normals(int size) { return scene::normal_map_of(size, letter); }

Image letter_cube(int face) {
  Image strip = image::make_image(6 * face, face, 3, image::Depth::unorm16);
  for (int side = 0; side < 6; ++side) {
    const vec3<double> middle = image::cube_direction(side, {0, 0});
    const vec3<double> right = image::cube_direction(side, {1, 0}) - middle;
    const vec3<double> up = image::cube_direction(side, {0, 1}) - middle;
    constexpr int positive_z = 4;
    const auto height = [&](vec2<double> v) { // v in [-1, 1]^2, heights in units of a face two wide
      const double s = 0.5 * v.x + 0.5;
      const double t = 0.5 * v.y + 0.5;
      return 2 * (side == positive_z ? letter(s, t) : knobs(s, t));
    };
    for (int y = 0; y < face; ++y)
      for (int x = 0; x < face; ++x) {
        const vec2<double> v{(2 * x + 1.0) / face - 1, (2 * y + 1.0) / face - 1};
        const double step = 0.5 / face; // a quarter texel
        const vec2<double> slope{(height({v.x + step, v.y}) - height({v.x - step, v.y})) / (2 * step),
                                 (height({v.x, v.y + step}) - height({v.x, v.y - step})) / (2 * step)};
        // Height over the unit sphere, constant along rays. With p = d / |d| and m the face's middle,
        // v.x = p.right / p.m, so its gradient is |d| (right - v.x m), which is perpendicular to d.
        const vec3<double> d = image::cube_direction(side, v);
        const double length = std::sqrt(dot(d, d));
        const vec3<double> gradient =
            length * (slope.x * (right - v.x * middle) + slope.y * (up - v.y * middle));
        scene::set_normal(strip, side * face + x, y, normalize_or_zero((1 / length) * d - gradient));
      }
  }
  return strip;
}

Image cobble_heights(int size) {
  Image map = image::make_image(size, size, 1, image::Depth::unorm16);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      map.at(x, y, 0) =
          static_cast<float>(std::floor(cobbles((x + 0.5) / size, (y + 0.5) / size) * 65535 + 0.5) / 65535);
  return map;
}

Image crag_normals(int size) { return scene::normal_map_of(size, crags); }

} // namespace surfgrad::gallery
