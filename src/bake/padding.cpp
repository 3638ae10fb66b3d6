#include "bake/padding.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace surfgrad::bake {

Padding::Padding(int width, int height, int reach, std::vector<float> empty, stage::BandSink take)
    : width_(width), height_(height), reach_(reach), empty_(std::move(empty)), take_(std::move(take)) {
  const auto columns = static_cast<std::size_t>(width);
  for (auto* list : {&above_, &below_, &nearest_}) list->assign(columns, never);
  for (auto* list : {&scanned_, &empty_columns_}) list->assign(columns, 0);
}

void Padding::add(const image::Image& band) {
  for (int y = band.height - 1; y >= 0; --y) push(band, y);
  // Below the last row there is nothing to wait for.
  hand_over(received_ == height_ ? height_ : received_ - reach_);
}

void Padding::push(const image::Image& band, int y) {
  Row row;
  if (!spares_.empty()) {
    row = std::move(spares_.back());
    spares_.pop_back();
  }
  row.texels.resize(band.index(width_, 0));
  stage::copy_values(band, y, 1, row.texels.data());
  const float* texels = row.texels.data();
  row.covered.resize(static_cast<std::size_t>(width_));
  row.count = 0;
  for (int x = 0; x < width_; ++x) {
    const bool covered = !std::isnan(texels[band.index(x, 0)]);
    row.covered[static_cast<std::size_t>(x)] = covered ? 1 : 0;
    row.count += covered ? 1 : 0;
  }
  rows_.push_back(std::move(row));
  ++received_;
}

/// First pass of an exact distance transform: along the columns.
void Padding::find_vertically(int from_top) {
  const int last = std::min(from_top + reach_, received_ - 1);
  const std::vector<std::uint8_t>& own = row(from_top).covered;
  for (std::size_t x = 0; x < above_.size(); ++x) {
    if (own[x] != 0) {
      above_[x] = from_top;
      nearest_[x] = from_top;
      continue;
    }
    if (below_[x] <= from_top) { // every row is searched once
      below_[x] = never;
      scanned_[x] = std::max(scanned_[x], from_top + 1);
      for (; scanned_[x] <= last && below_[x] == never; ++scanned_[x])
        if (row(scanned_[x]).covered[x] != 0) below_[x] = scanned_[x];
    }
    const int beyond = reach_ + 1;
    const int up = above_[x] == never ? beyond : from_top - above_[x];
    const int down = below_[x] == never ? beyond : below_[x] - from_top;
    nearest_[x] = std::min(up, down) > reach_ ? never : up <= down ? above_[x] : below_[x];
  }
}

/// Second pass: along the row.
void Padding::fill(int from_top, float* texels) {
  const std::size_t channels = empty_.size();
  int gap = reach_ + 1;
  for (int x = 0; x < width_; ++x) {
    const auto column = static_cast<std::size_t>(x);
    gap = nearest_[column] == never ? std::min(gap, reach_) + 1 : 0;
    empty_columns_[column] = gap;
  }
  gap = reach_ + 1;
  for (int x = width_ - 1; x >= 0; --x) {
    const auto column = static_cast<std::size_t>(x);
    gap = nearest_[column] == never ? std::min(gap, reach_) + 1 : 0;
    empty_columns_[column] = std::min(empty_columns_[column], gap);
  }
  const Row& own = row(from_top);
  for (int x = 0; x < width_; ++x) {
    const auto column = static_cast<std::size_t>(x);
    float* texel = texels + column * channels;
    if (own.covered[column] != 0) continue;
    int least = reach_ * reach_ + 1; // squared distance
    int from = x;
    const auto try_column = [&](int candidate, int across) {
      if (candidate < 0 || candidate >= width_ || nearest_[static_cast<std::size_t>(candidate)] == never)
        return;
      const int along = nearest_[static_cast<std::size_t>(candidate)] - from_top;
      const int squared = across * across + along * along;
      if (squared >= least) return;
      least = squared;
      from = candidate;
    };
    for (int across = empty_columns_[column]; across * across < least; ++across) {
      try_column(x - across, across);
      try_column(x + across, across);
    }
    const bool found = least <= reach_ * reach_;
    const float* value = found ? row(nearest_[static_cast<std::size_t>(from)]).texels.data() +
                                     static_cast<std::size_t>(from) * channels
                               : empty_.data();
    texel[0] = value[0]; // one to three values: a call to copy them costs more
    if (channels > 1) texel[1] = value[1];
    if (channels > 2) texel[2] = value[2];
    padded_ += found ? 1 : 0;
  }
}

void Padding::hand_over(int until) {
  if (until <= made_) return;
  stage::reshape(band_, width_, until - made_, static_cast<int>(empty_.size()));
  for (; made_ < until; ++made_) {
    float* texels = band_.texels.floats().data() + band_.index(0, until - 1 - made_);
    const Row& own = row(made_);
    std::copy(own.texels.begin(), own.texels.end(), texels);
    if (own.count == width_) {
      std::fill(above_.begin(), above_.end(), made_);
    } else {
      find_vertically(made_);
      fill(made_, texels);
    }
    for (; first_kept_ < made_ + 1 - reach_; ++first_kept_) {
      spares_.push_back(std::move(rows_.front()));
      rows_.pop_front();
    }
  }
  take_(band_);
}

} // namespace surfgrad::bake
