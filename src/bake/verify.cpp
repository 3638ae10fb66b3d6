#include "bake/verify.hpp"

#include "bake/format.hpp"
#include "bake/tangent_space.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "stage/stage.hpp"
#include "stage/tile_composer.hpp"

#include <surfgrad/resolve.hpp>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

namespace surfgrad::bake {
namespace {

/// Angles, in whole numbers: their sum and their distribution do not depend on the order.
class Angles {
 public:
  void add(double degrees, std::int64_t texel) {
    ++count_;
    sum_ += std::llround(degrees * unit);
    ++bins_[bin_of(degrees)];
    if (degrees > most_ || (degrees == most_ && texel < where_)) {
      most_ = degrees;
      where_ = texel;
    }
  }
  void add(const Angles& other) {
    count_ += other.count_;
    sum_ += other.sum_;
    for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
    if (other.most_ > most_ || (other.most_ == most_ && other.where_ < where_)) {
      most_ = other.most_;
      where_ = other.where_;
    }
  }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] double mean() const {
    return count_ == 0 ? 0 : static_cast<double>(sum_) / unit / static_cast<double>(count_);
  }
  [[nodiscard]] double most() const { return std::max(most_, 0.0); }
  [[nodiscard]] std::int64_t where() const { return most_ < 0 ? 0 : where_; }
  /// The least angle, rounded up, that no more than this share of all exceeds.
  [[nodiscard]] double exceeded_by(double share) const {
    std::int64_t above = count_;
    std::size_t i = 0;
    for (; i + 1 < bins_.size(); ++i) {
      above -= bins_[i];
      if (static_cast<double>(above) <= share * static_cast<double>(count_)) break;
    }
    return std::min(most(), double{std::bit_cast<float>(static_cast<std::uint32_t>(i + 1) << bin_shift)});
  }

 private:
  static constexpr double unit = 1 << 24; // a part of 2^-24 degrees; the sum of 2^28 texels fits
  // Positive floats sort as their bits do: sign, exponent and eight bits of the fraction.
  static constexpr int bin_shift = 15;
  static std::size_t bin_of(double degrees) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(degrees)) >> bin_shift;
  }

  std::int64_t count_ = 0;
  std::int64_t sum_ = 0;
  std::vector<std::int64_t> bins_ = std::vector<std::int64_t>(std::size_t{1} << (31 - bin_shift));
  double most_ = -1;
  std::int64_t where_ = 0;
};

struct Own {
  Angles angles{};
  std::int64_t left_out = 0;
};

template <class T>
vec3<T> at(const vec3<float*>& array, int i) {
  return {static_cast<T>(array.x[i]), static_cast<T>(array.y[i]), static_cast<T>(array.z[i])};
}

double angle_deg(vec3<double> a, vec3<double> b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// Compares tiles.
class Comparison {
 public:
  Comparison(const scene::Scene& scene, const Options& options, const image::Image& map)
      : scene_(scene), space_(options.space), format_(options), map_(map),
        integers_(image::is_integer(map.depth)), most_code_(map.depth == image::Depth::unorm8 ? 255 : 65535) {
  }

  void compare(const stage::ComposedTile& composed) {
    Own& own = own_.local();
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
            ++own.left_out;
            continue;
          }
        }
        const int x = composed.tile.x + composed.pixel[i] % composed.tile.width;
        const int y = composed.tile.y + composed.pixel[i] / composed.tile.width;
        const vec3<double> m = format_.decode(map_.texels.data() + map_.index(x, y), integers_, most_code_);
        own.angles.add(angle_deg(in_world(r, i, linear, m), normal), std::int64_t{y} * map_.width + x);
      }
    }
  }

  [[nodiscard]] Verification result() const {
    Own sum;
    for (const Own& own : own_) {
      sum.angles.add(own.angles);
      sum.left_out += own.left_out;
    }
    return {sum.angles.count(),
            sum.left_out,
            sum.angles.mean(),
            sum.angles.exceeded_by(1e-3),
            sum.angles.most(),
            static_cast<int>(sum.angles.where() % map_.width),
            static_cast<int>(sum.angles.where() / map_.width)};
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
  tbb::enumerable_thread_specific<Own> own_{};
};

} // namespace

Verification verify(const scene::Scene& asked, const Options& options, const image::Image& map,
                    const Report& report) {
  const Report silent{report.progress, {}}; // the bake has given all warnings
  const auto displaced = displace::displaced(asked, silent.at_the_start());
  const scene::Scene& scene = displaced ? displaced->scene : asked;
  const stage::Stage stage(scene, {}, {{options.uv_set, options.space == Space::tangent}}, silent,
                           options.backend);
  const std::size_t slot = stage.slot_of(options.uv_set);
  const raster::Projection projection = raster::Projection::texture(slot, map.width, map.height);
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

} // namespace surfgrad::bake
