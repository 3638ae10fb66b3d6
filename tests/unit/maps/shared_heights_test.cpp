// Height maps and the normal maps that others made of them.

#include "io/image_file.hpp"
#include "maps/convert.hpp"
#include "maps/integrate.hpp"

#include "support/angle.hpp"

#include <surfgrad/derivative.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <ostream>

namespace surfgrad::maps {
namespace {

struct Pair {
  const char* name;
  const char* heights;
  const char* normals;
  bool is_depth;
  stack::Green green;
  double correlation[2]; ///< that others measured
  double scale[2];       ///< slope a unit of height per texel
};

// What the list of the shared maps says of those whose normals were made of these heights.
const Pair pairs[] = {
    {"mmikk_base",
     "base_height.tiff",
     "base_height_conv_to_nmap.png",
     false,
     stack::Green::up,
     {0.999, 0.999},
     {4.7, 4.7}},
    {"acg_Tiles036",
     "Tiles036_1K_Displacement.jpg",
     "Tiles036_1K_Normal.jpg",
     false,
     stack::Green::down,
     {0.993, 0.995},
     {3.4, 3.4}},
    {"acg_Bricks102",
     "Bricks102_Displacement.jpg",
     "Bricks102_NormalGL.jpg",
     false,
     stack::Green::up,
     {0.96, 0.93},
     {9.8, 8.9}},
    {"godot_cheese",
     "texture_cheese_depth.png",
     "texture_cheese_normal.png",
     true,
     stack::Green::up,
     {0.988, 0.993},
     {7.7, 7.7}},
};

std::ostream& operator<<(std::ostream& out, const Pair& pair) { return out << pair.name; }

constexpr const char* names[] = {"central", "sobel", "scharr", "bspline"};

class SharedHeights : public testing::TestWithParam<Pair> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets/height_normal" / GetParam().name;
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << "no " << folder_;
  }
  [[nodiscard]] image::Image slopes_of_normals() const {
    const std::filesystem::path file = folder_ / GetParam().normals;
    return read_slopes(io::read_image(file), {.green = GetParam().green}, file).map;
  }
  [[nodiscard]] image::Image heights() const {
    const std::filesystem::path file = folder_ / GetParam().heights;
    return read_heights(io::read_image(file), {.kind = Kind::height, .is_depth = GetParam().is_depth}, file);
  }

  std::filesystem::path folder_{};
};

/// Sums over the texels of two maps of slopes.
struct Comparison {
  Comparison(const image::Image& a, const image::Image& b, int channel) {
    double sum[2] = {};
    double squares[2] = {};
    double product = 0;
    const double count = double{1.0 * a.width} * a.height;
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        const double v[] = {a.at(x, y, channel), b.at(x, y, channel)};
        product += v[0] * v[1];
        for (int i = 0; i < 2; ++i) {
          sum[i] += v[i];
          squares[i] += v[i] * v[i];
        }
      }
    const double covariance = product - sum[0] * sum[1] / count;
    const auto variance = [&](int i) { return squares[i] - sum[i] * sum[i] / count; };
    correlation = covariance / std::sqrt(variance(0) * variance(1));
    scale = covariance / variance(0);
  }
  double correlation = 0;
  double scale = 0; ///< of b over a
};

/// Means over five texels along both axes with the weights 1, 4, 6, 4 and 1: a blur by one texel.
image::Image blurred(const image::Image& slopes) {
  constexpr double weights[] = {1, 4, 6, 4, 1};
  image::Image result = image::make_image(slopes.width, slopes.height, 2, image::Depth::float32);
  for (int y = 0; y < slopes.height; ++y)
    for (int x = 0; x < slopes.width; ++x)
      for (int c = 0; c < 2; ++c) {
        double sum = 0;
        for (int j = 0; j < 5; ++j)
          for (int i = 0; i < 5; ++i)
            sum += weights[i] * weights[j] *
                   slopes.at((x + i - 2 + slopes.width) % slopes.width,
                             (y + j - 2 + slopes.height) % slopes.height, c);
        result.at(x, y, c) = static_cast<float>(sum / 256);
      }
  return result;
}

TEST_P(SharedHeights, GiveTheSlopesThatOthersMadeOfThem) {
  const Pair& pair = GetParam();
  const image::Image others = slopes_of_normals();
  for (const Kernel kernel : {Kernel::central, Kernel::sobel, Kernel::scharr, Kernel::bspline}) {
    const image::Image ours = slopes_of_heights(heights(), kernel, Border::repeat, 1);
    ASSERT_EQ(ours.width, others.width);
    for (int c = 0; c < 2; ++c) {
      const Comparison exact(ours, others, c);
      // JPEG files differ from texel to texel by their own noise.
      const Comparison without_noise(blurred(ours), blurred(others), c);
      std::printf("  %-7s %c: correlation %.4f, without noise %.4f; scale %.2f\n",
                  names[static_cast<int>(kernel)], "st"[c], exact.correlation, without_noise.correlation,
                  exact.scale);
      if (kernel != Kernel::central) continue;
      // The list rounds to two or three digits.
      EXPECT_GE(without_noise.correlation,
                pair.correlation[c] - (pair.correlation[c] < 0.98 ? 0.005 : 0.0005))
          << c;
      EXPECT_NEAR(exact.scale, pair.scale[c], 0.08 * pair.scale[c]) << c;
    }
  }
}

double mean_angle(const image::Image& a, const image::Image& b) {
  double sum = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      sum += surfgrad::test::unit_angle(normal_from_derivative(vec2<double>{a.at(x, y, 0), a.at(x, y, 1)}),
                                        normal_from_derivative(vec2<double>{b.at(x, y, 0), b.at(x, y, 1)}));
  return sum / (double{1.0 * a.width} * a.height);
}

// Share of the slopes that no surface has, of maps that were made of heights: rounding to 8 bits and JPEG.
// The bricks have 0.18: their normals are not those of these heights alone, and no heights come nearer.
constexpr double integrable = 0.1;

TEST_P(SharedHeights, NormalsComeBackFromTheHeightsMadeOfThem) {
  const image::Image slopes = slopes_of_normals();
  for (const Kernel kernel : {Kernel::central, Kernel::sobel, Kernel::scharr, Kernel::bspline}) {
    const Integrated made = integrate(slopes, kernel, Border::repeat);
    const double angle = mean_angle(slopes, slopes_of_heights(made.heights, kernel, Border::repeat, 1));
    std::printf("  %-7s %.3f degrees in the mean; %.3f of the slopes on no surface\n",
                names[static_cast<int>(kernel)], angle, made.not_integrable);
    EXPECT_LT(angle, made.not_integrable < integrable ? 1 : 2);
  }
  const Integrated clamped = integrate(slopes, Kernel::bspline, Border::clamp);
  std::printf("  clamped %.3f degrees\n",
              mean_angle(slopes, slopes_of_heights(clamped.heights, Kernel::bspline, Border::clamp, 1)));
}

INSTANTIATE_TEST_SUITE_P(Pairs, SharedHeights, testing::ValuesIn(pairs),
                         [](const auto& pair) { return std::string(pair.param.name); });

} // namespace
} // namespace surfgrad::maps
