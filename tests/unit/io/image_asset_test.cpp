#include "diagnostic/error.hpp"
#include "io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

namespace fs = std::filesystem;

namespace surfgrad {
namespace {

/// Image files under the folder of real assets, by extension; empty where there is none.
std::multimap<std::string, fs::path> asset_images() {
  std::multimap<std::string, fs::path> files;
  std::error_code absent;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SURFGRAD_SHARED_DIR) / "assets", absent))
    if (entry.is_regular_file()) files.emplace(entry.path().extension().string(), entry.path());
  return files;
}

TEST(AssetImages, EveryOneDecodesToFiniteTexels) {
  const auto files = asset_images();
  if (files.empty()) GTEST_SKIP() << "no assets in " SURFGRAD_SHARED_DIR;
  int count = 0;
  for (const char* extension : {".png", ".tif", ".tiff", ".jpg", ".jpeg", ".exr", ".hdr", ".tga"})
    for (auto [i, end] = files.equal_range(extension); i != end; ++i, ++count) {
      SCOPED_TRACE(i->second);
      image::Image image;
      ASSERT_NO_THROW(image = io::read_image(i->second));
      ASSERT_EQ(image.texels.size(), image.index(0, image.height));
      const bool integer = image.depth == image::Depth::unorm8 || image.depth == image::Depth::unorm16;
      float low = image.texels[0], high = image.texels[0];
      for (const float value : image.texels.floats()) {
        ASSERT_TRUE(std::isfinite(value));
        low = std::min(low, value);
        high = std::max(high, value);
      }
      EXPECT_LT(low, high) << "every one of them shows something";
      EXPECT_TRUE(!integer || (low >= 0.0f && high <= 1.0f));
    }
  std::printf("  %d images decoded\n", count);
  EXPECT_GT(count, 0);
}

TEST(AssetImages, DdsIsRefusedWithTheFormatsThatCanBeRead) {
  const auto files = asset_images();
  const auto dds = files.find(".dds");
  if (dds == files.end()) GTEST_SKIP() << "no DDS file in " SURFGRAD_SHARED_DIR "/assets";
  try {
    (void)io::read_image(dds->second);
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("expected one of: PNG"));
  }
}

} // namespace
} // namespace surfgrad
