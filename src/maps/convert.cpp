#include "maps/convert.hpp"

#include "maps/integrate.hpp"
#include "maps/lost_detail.hpp"
#include "maps/recode.hpp"
#include "maps/resample.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace surfgrad::maps {
namespace {

// Two centimetres a metre: what plaster, bark or brickwork rises by.
constexpr double usual_relief = 0.02;

/// Heights from 0 to 1, and what they were multiplied with.
double fill_range(std::vector<float>& heights) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const float lowest = *low;
  const float range = *high - lowest;
  for (float& h : heights) h = range > 0 ? (h - lowest) / range : 0.5f;
  return range > 0 ? 1 / double{range} : 1;
}

/// Subtracts the mean of each channel. Returns those of the first two.
vec2<double> remove_mean(image::Image& slopes) {
  std::vector<float>& values = slopes.texels.floats();
  vec2<double> sum{0, 0};
  for (std::size_t i = 0; i < values.size(); i += 2) sum = sum + vec2<double>{values[i], values[i + 1]};
  const vec2<double> mean = (2.0 / static_cast<double>(values.size())) * sum;
  for (std::size_t i = 0; i < values.size(); i += 2) {
    values[i] = static_cast<float>(values[i] - mean.x);
    values[i + 1] = static_cast<float>(values[i + 1] - mean.y);
  }
  return mean;
}

/// Sides of a mip level, or of the map itself.
struct Size {
  int width, height;
};

class Converter {
 public:
  Converter(const Conversion& conversion, const std::filesystem::path& file) : c_(conversion), file_(file) {}

  /// read  is called once the map is read for the last time
  Converted run(const image::Image& map, const std::function<void()>& read) {
    size_ = c_.width > 0 ? Size{c_.width, c_.height} : Size{map.width, map.height};
    if (const auto recoding = Recoding::of(map, c_, file_)) {
      result_.map = recoding->rows(0, map.height);
      result_.is_rearranged = true;
      return std::move(result_);
    }
    if (c_.from.kind == Kind::normal && c_.to.kind == Kind::normal && !c_.retile && c_.width == 0) {
      const Arrangement arrangement = arrangement_of(map, c_.from, c_.to, file_);
      result_.is_rearranged = arrangement.is_only_that;
      if (result_.is_rearranged) result_.map = rearranged(map, arrangement, c_.to, precision());
    }
    if (!result_.is_rearranged || c_.mips || c_.base_roughness) {
      if (c_.from.kind == Kind::height) {
        image::Image heights = read_heights(map, c_.from, file_);
        read();
        from_heights(std::move(heights));
      } else {
        require_normals(map, c_.from, Inward::refused, file_);
        Slopes slopes = read_slopes(map, c_.from, file_);
        read();
        result_.inward = slopes.inward;
        from_slopes(std::move(slopes.map));
      }
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] Precision precision() const { return {c_.depth, c_.dither}; }

  [[nodiscard]] std::vector<Size> levels() const {
    std::vector<Size> sizes{size_};
    while (c_.mips && (sizes.back().width > 1 || sizes.back().height > 1))
      sizes.push_back({std::max(1, sizes.back().width / 2), std::max(1, sizes.back().height / 2)});
    return sizes;
  }

  void from_heights(image::Image heights) {
    if (c_.to.kind == Kind::height) {
      take_levels(std::move(heights),
                  [&](const image::Image& level) { return write_heights(level, c_.to, precision()); });
      return;
    }
    result_.slope_scale = c_.slope_scale.value_or(usual_relief * heights.width);
    // By itself, so that the heights are gone before the slopes are used.
    image::Image slopes = slopes_of_heights(std::move(heights), c_.kernel, c_.border, result_.slope_scale);
    from_slopes(std::move(slopes));
  }

  void from_slopes(image::Image slopes) {
    if (c_.retile) result_.tilt = remove_mean(slopes);
    if (c_.to.kind == Kind::height) {
      to_heights(resampled(std::move(slopes), size_.width, size_.height, c_.border));
      return;
    }
    if (c_.base_roughness) {
      const image::Image normals = unit_normals(slopes);
      for (const Size& size : levels())
        result_.roughness.push_back(
            roughness_of_means(resampled(normals, size.width, size.height, c_.border), *c_.base_roughness));
    }
    take_levels(std::move(slopes),
                [&](const image::Image& level) { return write_slopes(level, c_.to, precision()); });
  }

  void to_heights(image::Image slopes) {
    Integrated integrated = integrate(std::move(slopes), c_.kernel, c_.border);
    result_.not_integrable = integrated.not_integrable;
    if (c_.border == Border::repeat) result_.tilt = integrated.tilt;
    std::vector<float>& heights = integrated.heights.texels.floats();
    if (c_.slope_scale) {
      result_.slope_scale = *c_.slope_scale;
      for (float& h : heights) h = static_cast<float>(0.5 + h / *c_.slope_scale);
    } else {
      result_.slope_scale = 1 / fill_range(heights);
    }
    take_levels(std::move(integrated.heights),
                [&](const image::Image& level) { return write_heights(level, c_.to, precision()); });
  }

  /// write(picture) makes a Written of a picture in each size.
  template <class Write>
  void take_levels(image::Image picture, const Write& write) {
    const std::vector<Size> sizes = levels();
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      if (i == 0 && result_.is_rearranged) continue;
      const bool is_last = i + 1 == sizes.size();
      Written written = write(
          resampled(is_last ? std::move(picture) : picture, sizes[i].width, sizes[i].height, c_.border));
      if (i == 0) {
        result_.map = std::move(written.map);
        result_.clamped = written.clamped;
        result_.steepest = written.steepest;
      } else {
        result_.mips.push_back(std::move(written.map));
      }
    }
  }

  const Conversion& c_;
  const std::filesystem::path& file_;
  Size size_{};
  Converted result_{};
};

} // namespace

Converted convert(const image::Image& map, const Conversion& conversion, const std::filesystem::path& file) {
  return Converter(conversion, file).run(map, [] {});
}

Converted convert(image::Image&& map, const Conversion& conversion, const std::filesystem::path& file) {
  return Converter(conversion, file).run(map, [&map] { map.texels = {}; });
}

} // namespace surfgrad::maps
