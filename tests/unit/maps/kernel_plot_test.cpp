// The plot of the kernels in docs/maps.md is what the kernels do.

#include "maps/differentiate.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>
#include <string>

namespace surfgrad::maps {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double width = 320;
constexpr double height = 200;
constexpr double left = 46;
constexpr double top = 30;

struct Curve {
  const char* name;
  const char* color;
  std::function<double(double)> value; ///< at w radians a texel
};

std::string panel(double x0, const std::string& title, const std::vector<Curve>& curves) {
  const auto x = [&](double w) { return x0 + left + width * w / pi; };
  const auto y = [&](double v) { return top + height * (1 - v); };
  std::string svg = fmt::format("<text x=\"{}\" y=\"18\">{}</text>\n", x0 + left, title);
  for (int i = 0; i <= 4; ++i) {
    svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
                       "text-anchor=\"end\">{:g}</text>\n",
                       x(0), y(i / 4.0), x(pi), x(0) - 6, y(i / 4.0) + 4, i / 4.0);
    if (i > 0)
      svg += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
                         "text-anchor=\"middle\">{:.3g}</text>\n",
                         x(i * pi / 4), y(0), y(1), x(i * pi / 4), y(0) + 16, 8.0 / i);
  }
  double label = y(0) - 8 - 15.0 * static_cast<double>(curves.size() - 1);
  for (const Curve& curve : curves) {
    std::string points;
    for (int i = 0; i <= 64; ++i) {
      const double w = pi * i / 64;
      points += fmt::format("{:.1f},{:.1f} ", x(w), y(curve.value(w)));
    }
    svg += fmt::format(
        "<polyline points=\"{}\" stroke=\"{}\"/>\n<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n",
        points, curve.color, x(0) + 8, label, curve.color, curve.name);
    label += 15;
  }
  return svg;
}

std::string plot() {
  const auto along = [](Kernel kernel) {
    return [kernel](double w) { return w == 0 ? 1.0 : slope_along(kernel, w) / w; };
  };
  const auto across = [](Kernel kernel) { return [kernel](double v) { return share_across(kernel, v); }; };
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" "
                     "font-family=\"sans-serif\" font-size=\"11\">\n"
                     "<style>.grid{{stroke:#ccc}}polyline{{fill:none;stroke-width:1.6}}</style>\n<rect "
                     "width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
                     2 * (left + width) + 30, top + height + 42) +
         panel(0, "share of the slope of a wave along the axis",
               {{"bspline", "#c33", along(Kernel::bspline)},
                {"central, sobel, scharr", "#36c", along(Kernel::central)}}) +
         panel(left + width + 12, "share of it across the axis",
               {{"bspline, central", "#c33", across(Kernel::bspline)},
                {"scharr", "#2a2", across(Kernel::scharr)},
                {"sobel", "#b70", across(Kernel::sobel)}}) +
         fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">texels a period</text>\n</svg>\n",
                     left + width + 12, top + height + 36);
}

TEST(KernelPlot, InTheDocumentationIsThatOfTheKernels) {
  const std::filesystem::path file = std::filesystem::path(SURFGRAD_SOURCE_DIR) / "docs/images/kernels.svg";
  if (std::getenv("SURFGRAD_UPDATE_GOLDEN") != nullptr) std::ofstream(file) << plot();
  std::ifstream in(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), plot());
}

} // namespace
} // namespace surfgrad::maps
