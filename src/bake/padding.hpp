#pragma once

#include "stage/bands.hpp"

#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

namespace surfgrad::bake {

/// First value of a texel where no surface lies, in bands on their way to be padded.
inline constexpr float uncovered = std::numeric_limits<float>::quiet_NaN();

/// Gives texels where no surface lies the value of the nearest one where a surface does, so that filters
/// and mip levels that read across the border of an island read more of the island. Works on bands on
/// their way to a sink; memory is a window of rows.
///
/// Distances are those of texel centres, exact. Of texels equally near the one in the nearest column is
/// taken, then the left one, then the upper one: bands make no difference. The map does not go on at its
/// other side.
class Padding {
 public:
  /// width, height  of the whole map
  /// reach          in texels, farther ones stay empty
  /// empty          value of texels that nothing is near to, one number for each of one to three channels
  Padding(int width, int height, int reach, std::vector<float> empty, stage::BandSink take);

  /// The next rows from the top downwards. Bands that are ready go to the sink, the last with the last row.
  void add(const image::Image& band);
  /// Texels that got the value of another one.
  [[nodiscard]] std::int64_t padded() const { return padded_; }

 private:
  struct Row {
    std::vector<float> texels;
    std::vector<std::uint8_t> covered; ///< 1 or 0
    int count = 0;                     ///< of the covered ones
  };
  static constexpr int never = -1;

  void push(const image::Image& band, int y);
  /// Rows from the top of the map on count from 0.
  [[nodiscard]] const Row& row(int from_top) const {
    return rows_[static_cast<std::size_t>(from_top - first_kept_)];
  }
  void find_vertically(int from_top);
  void fill(int from_top, float* texels);
  void hand_over(int until);

  int width_, height_, reach_;
  std::vector<float> empty_;
  stage::BandSink take_;
  std::deque<Row> rows_{}; ///< those within reach of the next one to be made
  std::vector<Row> spares_{};
  int first_kept_ = 0;
  int received_ = 0;
  int made_ = 0;
  // Of each column, for the row that is being made:
  std::vector<int> above_;         ///< the nearest covered row at or above it, or never
  std::vector<int> below_;         ///< the nearest covered row below it that has been found, or never
  std::vector<int> scanned_;       ///< rows above this one have been searched for below_
  std::vector<int> nearest_;       ///< the nearer of them within reach, or never
  std::vector<int> empty_columns_; ///< to the nearest column that has one, at most reach + 1
  image::Image band_{};
  std::int64_t padded_ = 0;
};

} // namespace surfgrad::bake
