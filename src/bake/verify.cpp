#include "bake/verify.hpp"

#include "bake/angles.hpp"
#include "bake/format.hpp"
#include "bake/tangent_space.hpp"
#include "bake/verify_on_screen.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "stage/stage.hpp"
#include "stage/tile_composer.hpp"

#include <surfgrad/resolve.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <array>

namespace surfgrad::bake {
namespace {

template <class T>
vec3<T> at(const vec3<float*>& array, int i) {
  return {static_cast<T>(array.x[i]), static_cast<T>(array.y[i]), static_cast<T>(array.z[i])};
}

/// Compares tiles.
class Comparison {
 public:
  Comparison(const scene::Scene& scene, const Options& options, const image::Image& map)
      : scene_(scene), space_(options.space), format_(options), map_(map),
        integers_(image::is_integer(map.depth)), most_code_(map.depth == image::Depth::unorm8 ? 255 : 65535) {
  }

  void compare(const stage::ComposedTile& composed) {
    Angles& own = own_.local();
    const engine::TileWork::Results& r = composed.results;
    for (const stage::ComposedTile::Run& run : composed.runs) {
      const mat3<double> linear = raster::linear_part(scene_.objects[run.surface].world_from_object);
      for (int i = run.first; i < run.end; ++i) {
        const vec3<double> normal = at<double>(r.normal, i);
        if (!(max_abs(normal) > 0)) continue; // there is none
        if (space_ == Space::tangent) {
          const auto held = in_vertex_frame(at<float>(r.mesh_normal, i), at<float>(r.tangent, i), r.sign[i],
                                            at<float>(r.normal, i));
          if (held.singular || held.clamped) {
            own.leave_out();
            continue;
          }
        }
        const int x = composed.tile.x + composed.pixel[i] % composed.tile.width;
        const int y = composed.tile.y + composed.pixel[i] / composed.tile.width;
        std::array<float, 4> texel;
        const float* values =
            map_.texels.read(map_.index(x, y), static_cast<std::size_t>(map_.channels), texel.data());
        const vec3<double> m = format_.decode(values, integers_, most_code_);
        own.add(angle_deg(in_world(r, i, linear, m), normal), std::int64_t{y} * map_.width + x);
      }
    }
  }

  [[nodiscard]] Deviation result() const {
    Angles sum;
    for (const Angles& own : own_) sum.add(own);
    return sum.summary(map_.width);
  }

 private:
  [[nodiscard]] vec3<double> in_world(const engine::TileWork::Results& r, int i, const mat3<double>& linear,
                                      vec3<double> m) const {
    switch (space_) {
    case Space::world:
      return m;
    case Space::object:
      return transform_normal(linear, m);
    case Space::tangent:
      break;
    }
    const vec3<double> n = at<double>(r.mesh_normal, i);
    const vec3<double> t = at<double>(r.tangent, i);
    const double sign = r.sign[i] > 0 ? 1 : -1;
    return m.x * t + m.y * (sign * cross(n, t)) + m.z * n;
  }

  const scene::Scene& scene_;
  Space space_;
  Format format_;
  const image::Image& map_;
  bool integers_;
  double most_code_;
  tbb::enumerable_thread_specific<Angles> own_{};
};

/// At the texel centres, by the nearest texel.
Deviation compare_texels(const scene::Scene& scene, const Options& options, const image::Image& map,
                         const Report& report) {
  const stage::Stage stage(scene, {}, {{options.uv_set, options.space == Space::tangent}}, report,
                           options.backend);
  const std::size_t slot = stage.slot_of(options.uv_set);
  const raster::Projection projection = raster::Projection::texture(
      slot, map.width, map.height,
      {static_cast<double>(options.tile.column), static_cast<double>(options.tile.row)});
  const int side = stage::tile_side_of(options.backend);
  stage::TileComposer composer(stage, projection, map.width, map.height, side, side,
                               {.vertex_frame = options.space == Space::tangent, .slot = slot});
  Comparison comparison(scene, options, map);
  const int rows = composer.grid().rows();
  for (int row = 0; row < rows; ++row) {
    composer.compose_row(row, [&](const stage::ComposedTile& tile) { comparison.compare(tile); });
    if (report.progress && !report.progress(static_cast<double>(row + 1) / rows)) throw Cancelled();
  }
  return comparison.result();
}

} // namespace

Verification verify(const scene::Scene& asked, const Options& options, const image::Image& map,
                    const Report& report) {
  const auto displaced = displace::displaced(asked, Report{report.progress, {}}.at_the_start());
  const scene::Scene& scene = displaced ? displaced->scene : asked;
  // The bake has given all warnings. The two parts take about as long.
  const auto part = [&](double first) {
    Report part_report;
    if (report.progress)
      part_report.progress = [&report, first](double done) { return report.progress(first + 0.5 * done); };
    return part_report;
  };
  Verification result;
  result.texels = compare_texels(scene, options, map, part(0));
  result.on_screen = compare_on_screen(scene, options, map, part(0.5));
  return result;
}

} // namespace surfgrad::bake
