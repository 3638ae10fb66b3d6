#include "bake/verify_on_screen.hpp"

#include "bake/angles.hpp"
#include "diagnostic/error.hpp"
#include "render/camera.hpp"
#include "stage/stage.hpp"
#include "stage/tile_composer.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <memory>

namespace surfgrad::bake {
namespace {

constexpr const char* name_of_map = "baked";

/// The layer that reads a map baked with these options, filtered as graphics hardware does: a baked map is
/// one layer on an untouched normal, and there the standard decode is what the engine makes of it.
stack::Layer reading_layer(const Options& options) {
  const auto names_map = [&](auto layer, stack::Filter filter) {
    layer.common.key = "layers[0]";
    layer.map.file.path = name_of_map;
    layer.map.uv = options.uv_set;
    layer.map.green = options.green;
    layer.map.filter = filter;
    return layer;
  };
  if (options.space != Space::tangent) {
    auto layer = names_map(stack::ObjectNormalMapLayer{}, stack::Filter::trilinear);
    layer.space = options.space == Space::object ? stack::Space::object : stack::Space::world;
    return layer;
  }
  if (options.encoding == Encoding::derivative) {
    auto layer = names_map(stack::DerivativeMapLayer{}, stack::Filter::trilinear);
    layer.code = {options.range, options.neutral};
    return layer;
  }
  auto layer = names_map(stack::NormalMapLayer{}, stack::Filter::normal);
  layer.map.channels = options.encoding == Encoding::rg ? stack::Channels::xy : stack::Channels::xyz;
  return layer;
}

/// The scene under the baked map instead of its own layers.
scene::Scene under_map(const scene::Scene& scene, const Options& options, const image::Image& map) {
  scene::Scene reader = scene;
  reader.images = {{name_of_map, {std::shared_ptr<void>(), &map}}}; // the map outlives this scene
  for (scene::Material& material : reader.materials) material.layers = {reading_layer(options)};
  return reader;
}

bool in_unit_square(float s, float t) { return s >= 0 && s <= 1 && t >= 0 && t <= 1; }

} // namespace

Deviation compare_on_screen(const scene::Scene& scene, const Options& options, const image::Image& map,
                            const Report& report) {
  constexpr int side = screen_side;
  const render::Pinhole camera = render::place_camera(scene, side, side);
  const stage::View view{camera.eye, camera.relative_from_screen(side, side)};
  const auto projection = raster::Projection::camera(camera.screen_from_relative(side, side), camera.near);
  const std::vector<raster::UvSlot> needed{{options.uv_set, false}};
  const Report silent{report.progress, {}}; // the map is ours
  const stage::Stage stage(scene, view, needed, silent, options.backend);
  const scene::Scene reader_scene = under_map(scene, options, map);
  const stage::Stage reader_stage(reader_scene, view, needed, silent);
  const int tile_side = stage::tile_side_of(options.backend);
  stage::TileComposer composer(stage, projection, side, side, tile_side, tile_side,
                               {.st = true, .slot = stage.slot_of(options.uv_set)});
  stage::TileComposer reader(reader_stage, projection, side, side, tile_side, tile_side, {});
  tbb::enumerable_thread_specific<Angles> own;
  const auto compare = [&](const stage::ComposedTile& composed, const stage::ComposedTile& read) {
    Angles& angles = own.local();
    const auto normal = [](const stage::ComposedTile& tile, int i) {
      const vec3<float*>& n = tile.results.normal;
      return vec3<double>{n.x[i], n.y[i], n.z[i]};
    };
    // The same triangles of the same materials: both list their pixels in the same order.
    for (int i = 0; i < composed.count; ++i) {
      const vec3<double> expected = normal(composed, i);
      if (!(max_abs(expected) > 0) ||
          !in_unit_square(composed.results.st.x[i] - static_cast<float>(options.tile.column),
                          composed.results.st.y[i] - static_cast<float>(options.tile.row))) {
        angles.leave_out();
        continue;
      }
      const int x = composed.tile.x + composed.pixel[i] % composed.tile.width;
      const int y = composed.tile.y + composed.pixel[i] / composed.tile.width;
      angles.add(angle_deg(normal(read, i), expected), std::int64_t{y} * side + x);
    }
  };
  const int rows = composer.grid().rows();
  for (int row = 0; row < rows; ++row) {
    composer.compose_row(row, [&](const stage::ComposedTile& tile) {
      compare(tile, reader.compose(tile.tile.x / tile_side, row));
    });
    if (report.progress && !report.progress(static_cast<double>(row + 1) / rows)) throw Cancelled();
  }
  Angles sum;
  for (const Angles& angles : own) sum.add(angles);
  return sum.summary(side);
}

} // namespace surfgrad::bake
