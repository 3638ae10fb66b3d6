// Maps in other sizes.

#include "maps/resample.hpp"

#include "support/images.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::maps {
namespace {

using surfgrad::test::Random;

double mean(const image::Image& picture, int channel) {
  double sum = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) sum += picture.at(x, y, channel);
  return sum / (double{1.0 * picture.width} * picture.height);
}

TEST(Resample, SmallerTexelsAreMeansOfTheAreaTheyCover) {
  Random random(1807);
  const image::Image picture = surfgrad::test::random_image(random, 12, 10, 2, image::Depth::float32);
  for (const auto& [width, height] : {std::pair{6, 5}, {4, 10}, {5, 3}, {1, 1}, {12, 7}}) {
    const image::Image small = resampled(picture, width, height, Border::repeat);
    // Any share of the area: every texel's own integral over the squares it covers.
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0;
        double area = 0;
        for (int j = 0; j < 10; ++j)
          for (int i = 0; i < 12; ++i) {
            const auto covered = [](double k, double ratio, int texel) {
              return std::max(0.0, std::min((k + 1) * ratio, texel + 1.0) -
                                       std::max(k * ratio, double{1.0 * texel}));
            };
            const double part = covered(x, 12.0 / width, i) * covered(y, 10.0 / height, j);
            sum += part * picture.at(i, j, 1);
            area += part;
          }
        EXPECT_NEAR(small.at(x, y, 1), sum / area, 1e-6);
      }
    EXPECT_NEAR(mean(small, 0), mean(picture, 0), 1e-6);
  }
}

TEST(Resample, LargerTexelsAreLinearBetweenCentres) {
  image::Image picture = image::make_image(3, 1, 1, image::Depth::float32);
  picture.texels = {0, 6, 12};
  const image::Image large = resampled(picture, 6, 2, Border::clamp);
  const float expected[] = {0, 1.5f, 4.5f, 7.5f, 10.5f, 12};
  for (int x = 0; x < 6; ++x) EXPECT_FLOAT_EQ(large.at(x, 1, 0), expected[x]);
  const image::Image repeated = resampled(picture, 6, 1, Border::repeat);
  EXPECT_FLOAT_EQ(repeated.at(0, 0, 0), 3); // a quarter of the last texel's 12
}

} // namespace
} // namespace surfgrad::maps
