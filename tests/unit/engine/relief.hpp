#pragma once

/// Analytic surfaces seen by a pinhole, as the rasteriser would give them, to try parallax layers on.

#include "lab.hpp"
#include "support/surfaces.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace surfgrad::engine::test {

using surfgrad::test::Pinhole;
using surfgrad::test::SurfacePoint;
using surfgrad::test::UvMap;

/// A point of a surface, who looks at it and its two texture coordinates.
struct Sight {
  SurfacePoint base;
  UvMap map;   ///< texture coordinate 0 by the surface's parameters
  UvMap other; ///< texture coordinate 1
  Pinhole camera;

  /// From this many degrees off the normal of the surface's front; more than 90 is from behind.
  Sight(const SurfacePoint& point, double degrees, Random& random, double distance = 3)
      : base(point), map(surfgrad::test::random_uv_map(random)),
        other(surfgrad::test::random_uv_map(random)) {
    const vec3<double> along = normalize_or_zero(cross(point.normal, random.unit_vector()));
    const double angle = degrees * std::numbers::pi / 180;
    const vec3<double> towards = std::cos(angle) * point.normal + std::sin(angle) * along;
    const vec3<double> forward = normalize_or_zero(0.2 * random.vector3() - towards);
    const vec3<double> right = normalize_or_zero(cross(forward, random.unit_vector()));
    camera = {point.position + distance * towards, {right, cross(right, forward), forward}};
    camera.screen_y = random.sign();
  }

  [[nodiscard]] raster::Fragment<double> fragment() const {
    const surfgrad::test::Fragment seen = camera.fragment(base);
    raster::Fragment<double> f{};
    f.raster = seen.pixel;
    f.position = base.position - camera.eye;
    f.object_position = base.position;
    f.to_viewer = normalize_or_zero(-f.position);
    f.normal = base.normal;
    f.dp_dx = seen.dp_dx;
    f.dp_dy = seen.dp_dy;
    f.dn_dx = seen.duv_dx.x * base.dn_du + seen.duv_dx.y * base.dn_dv;
    f.dn_dy = seen.duv_dy.x * base.dn_du + seen.duv_dy.y * base.dn_dv;
    f.front_facing = seen.front_facing;
    const auto coordinate = [&](const UvMap& uv) {
      const vec2<double> dx = uv.linear(seen.duv_dx);
      const vec2<double> dy = uv.linear(seen.duv_dy);
      return raster::UvFragment<double>{uv(base.uv), dx, dy, dx, dy, {0, 0, 0}, 1};
    };
    f.uvs[0] = coordinate(map);
    f.uvs[1] = coordinate(other);
    return f;
  }
  [[nodiscard]] Placement placement(vec3<double> to_sun = {0, 0, 0}) const {
    Placement result = placed(identity);
    Pinhole at_origin = camera;
    at_origin.eye = {0, 0, 0};
    result.relative_from_screen = at_origin.world_from_screen(0.01, 100);
    result.to_sun = to_sun;
    return result;
  }
};

/// What a parallax layer makes of a fragment.
struct Moved {
  raster::Fragment<double> fragment;
  Frame<double> frame;
  double sunlight;
  bool first_pass;
  bool degenerate;
};

inline const Parallax& parallax_of(const Program& program) {
  return std::get<Parallax>(program.layers.front());
}

inline Moved moved(const Program& program, const raster::Fragment<double>& f, const Placement& placement,
                   BackFaces mode = BackFaces::same) {
  raster::Fragment<double> own = f;
  Point<double> point{own, make_frame(f.normal, f.dp_dx, f.dp_dy, f.front_facing, mode), placement};
  vec3<double> sum{0, 0, 0};
  bool degenerate = false;
  apply(parallax_of(program), point, sum, degenerate);
  return {point.fragment, point.frame, point.sunlight, point.first_pass, degenerate};
}

/// The relief's height over a coordinate, on the level of detail that a search from this fragment meets.
inline double height_at(const Program& program, vec2<double> st, const raster::Fragment<double>& f) {
  const TiledMap& tiled = parallax_of(program).relief.texture.tiled;
  const double lod = tiled.filter == image::Filter::trilinear
                         ? level_of_detail(tiled, f.uvs[0].footprint_dx, f.uvs[0].footprint_dy)
                         : 0;
  return image::sample<1>(*tiled.map, map_coordinate(tiled, st), std::floor(lod + 0.5), tiled.wrap,
                          image::Filter::trilinear, true)[0];
}

/// Heights 1/16, 3/16 ... 15/16 along s: between the outer texels' centres the height is s itself.
inline image::Image ramp_image() {
  image::Image ramp = image::make_image(8, 1, 1, image::Depth::float32);
  for (std::size_t i = 0; i < 8; ++i)
    ramp.texels[i] = static_cast<float>((2.0 * static_cast<double>(i) + 1) / 16);
  return ramp;
}

} // namespace surfgrad::engine::test
