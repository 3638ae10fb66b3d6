// Small pictures of real input, looked at once and kept. `tests/golden/update` makes them anew: look at
// every one that changed before committing it.

#include "golden/golden_scenes.hpp"
#include "io/image_file.hpp"
#include "render/render.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace surfgrad {
namespace {

constexpr int side = 256;

class Golden : public testing::TestWithParam<GoldenScene> {};

TEST_P(Golden, PictureIsTheOneThatWasLookedAt) {
  const GoldenScene& golden = GetParam();
  if (!golden.model.empty() && !std::filesystem::exists(shared_assets()))
    GTEST_SKIP() << "no real assets at " << shared_assets();
  const render::Picture picture = render::render(load(golden), {side, side, 2});
  const std::filesystem::path file =
      std::filesystem::path(SURFGRAD_SOURCE_DIR) / "tests/golden" / (golden.name + ".png");
  if (std::getenv("SURFGRAD_UPDATE_GOLDEN") != nullptr) {
    io::write_image(file, picture.image, image::Depth::unorm8);
    GTEST_SKIP() << "wrote " << file;
  }
  const image::Image kept = io::read_image(file);
  ASSERT_EQ(kept.width, side);
  ASSERT_EQ(kept.height, side);
  // Metric: share of samples more than 2 codes (of 255) off. The pictures are deterministic but for
  // the last bit of the C library's inverse sine and tangent in tangents: 0.1 %.
  int off = 0;
  double worst = 0;
  for (std::size_t i = 0; i < kept.texels.size(); ++i) {
    const double difference = std::abs(std::round(picture.image.texels[i] * 255) - kept.texels[i] * 255);
    off += difference > 2.5;
    worst = std::max(worst, difference);
  }
  std::printf("%s: worst %.0f codes, %d of %zu samples off, %lld degenerate\n", golden.name.c_str(), worst,
              off, kept.texels.size(), static_cast<long long>(picture.degenerate));
  EXPECT_LE(off, static_cast<int>(kept.texels.size()) / 1000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Golden, testing::ValuesIn(golden_scenes()),
                         [](const auto& scene) { return scene.param.name; });

} // namespace
} // namespace surfgrad
