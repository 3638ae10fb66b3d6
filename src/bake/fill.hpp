#pragma once

#include "stage/bands.hpp"

#include <cstdint>
#include <vector>

namespace surfgrad::bake {

/// Gives every texel where no surface lies (bake::uncovered) a value, by pull and push: the mean of the
/// covered ones of 2x2 texels is a texel of the next level, those of that level of the one after it, and what
/// is uncovered takes the value of the texel above it. So the mean of 2x2 texels, at every mip level, is the
/// mean of the covered ones alone. Means are those of values as they are encoded: that is what mip levels and
/// filters average.
///
/// Works on bands on their way to a sink and holds the picture: 4/3 of it in floats.
class Fill {
 public:
  /// width, height  of the whole map
  /// empty          texel of a map where nothing is covered
  Fill(int width, int height, std::vector<float> empty, stage::BandSink take);

  /// The next rows from the top downwards. All bands go to the sink with the last row.
  void add(const image::Image& band);
  /// Texels that got a value.
  [[nodiscard]] std::int64_t filled() const { return filled_; }

 private:
  void hand_over();

  int rows_left_;
  std::vector<float> empty_;
  stage::BandSink take_;
  std::vector<image::Image> levels_; ///< the picture, and levels of half the size, rounded up
  std::int64_t filled_ = 0;
};

} // namespace surfgrad::bake
