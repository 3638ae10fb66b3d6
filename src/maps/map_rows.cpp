#include "maps/map_rows.hpp"

#include "image/codes.hpp"

#include <algorithm>
#include <utility>

namespace surfgrad::maps {

MapRows::MapRows(int width, int height, int channels, image::Depth depth,
                 std::optional<std::vector<float>> flat)
    : map_{width, height, channels, depth, false, {}} {
  const std::size_t values = map_.index(0, height);
  if (depth == image::Depth::unorm8)
    codes8_.resize(values);
  else if (depth == image::Depth::unorm16)
    codes16_.resize(values);
  else
    floats_.resize(values);
  if (flat && depth == image::Depth::unorm8) mask_.emplace(std::move(*flat));
}

void MapRows::put(int y, std::vector<float>& row) {
  const std::size_t first = map_.index(0, y);
  if (!floats_.empty()) {
    std::copy(row.begin(), row.end(), floats_.data() + first);
  } else if (!codes16_.empty()) {
    image::to_codes(row, codes16_.data() + first);
  } else {
    if (mask_) mask_->round_row(row.data(), map_.width, map_.channels, y, row.data());
    image::to_codes(row, codes8_.data() + first);
  }
}

image::Image MapRows::take() {
  if (!floats_.empty())
    map_.texels = image::Texels(std::move(floats_));
  else if (!codes16_.empty())
    map_.texels = image::Texels(std::move(codes16_));
  else
    map_.texels = image::Texels(std::move(codes8_));
  return std::move(map_);
}

} // namespace surfgrad::maps
