#include "bake/fill.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace surfgrad::bake {
namespace {

bool covered(const image::Image& level, int x, int y) { return !std::isnan(level.at(x, y, 0)); }

/// A level of half the size: means of what is covered.
image::Image pulled(const image::Image& fine) {
  image::Image coarse;
  stage::reshape(coarse, (fine.width + 1) / 2, (fine.height + 1) / 2, fine.channels);
  tbb::parallel_for(0, coarse.height, [&](int y) {
    for (int x = 0; x < coarse.width; ++x)
      for (int c = 0; c < fine.channels; ++c) {
        double sum = 0;
        int count = 0;
        for (int v = 2 * y; v < std::min(2 * y + 2, fine.height); ++v)
          for (int u = 2 * x; u < std::min(2 * x + 2, fine.width); ++u)
            if (covered(fine, u, v)) {
              sum += fine.at(u, v, c);
              ++count;
            }
        coarse.at(x, y, c) = static_cast<float>(sum / count); // 0 / 0: uncovered
      }
  });
  return coarse;
}

/// Values for what is uncovered from a level of half the size; how many texels got one.
std::int64_t pushed(const image::Image& coarse, image::Image& fine) {
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, fine.height), std::int64_t{0},
      [&](const tbb::blocked_range<int>& rows, std::int64_t count) {
        for (int y = rows.begin(); y < rows.end(); ++y)
          for (int x = 0; x < fine.width; ++x) {
            if (covered(fine, x, y)) continue;
            for (int c = 0; c < fine.channels; ++c) fine.at(x, y, c) = coarse.at(x / 2, y / 2, c);
            ++count;
          }
        return count;
      },
      std::plus<>());
}

} // namespace

Fill::Fill(int width, int height, std::vector<float> empty, stage::BandSink take)
    : rows_left_(height), empty_(std::move(empty)), take_(std::move(take)), levels_(1) {
  stage::reshape(levels_[0], width, height, static_cast<int>(empty_.size()));
}

void Fill::add(const image::Image& band) {
  rows_left_ -= band.height;
  image::Image& picture = levels_[0];
  stage::copy_values(band, picture.texels.floats().data() + picture.index(0, rows_left_));
  if (rows_left_ > 0) return;
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(pulled(levels_.back()));
  if (!covered(levels_.back(), 0, 0))
    std::copy(empty_.begin(), empty_.end(), levels_.back().texels.floats().begin());
  while (levels_.size() > 1) {
    filled_ = pushed(levels_.back(), levels_[levels_.size() - 2]);
    levels_.pop_back();
  }
  hand_over();
}

void Fill::hand_over() {
  constexpr int rows_a_band = 64; // what follows copies a band once or twice: little of the picture
  image::Image& picture = levels_[0];
  image::Image band;
  for (int top = picture.height; top > 0; top -= band.height) {
    stage::reshape(band, picture.width, std::min(top, rows_a_band), picture.channels);
    const auto first =
        picture.texels.floats().begin() + static_cast<std::ptrdiff_t>(picture.index(0, top - band.height));
    std::copy(first, first + static_cast<std::ptrdiff_t>(band.texels.size()), band.texels.floats().begin());
    take_(band);
  }
}

} // namespace surfgrad::bake
