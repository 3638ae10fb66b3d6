// Images written band by band: the same bytes as at once, nothing left behind when it goes wrong.

#include "diagnostic/error.hpp"
#include "io/encoders.hpp"
#include "io/file.hpp"
#include "io/image_writer.hpp"
#include "support/file_size_limit.hpp"
#include "support/images.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace surfgrad {
namespace {

using image::Depth;
using image::Image;
using io::Compression;
using io::ImageWriter;
using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Target {
  const char* file;
  Depth depth;
};
constexpr Target targets[] = {{"8.png", Depth::unorm8},   {"16.png", Depth::unorm16},
                              {"8.tif", Depth::unorm8},   {"16.tif", Depth::unorm16},
                              {"32.tif", Depth::float32}, {"half.exr", Depth::half},
                              {"32.exr", Depth::float32}};

/// Smooth where a filter can use it, noisy where none can, and now and then beyond what integers hold.
Image picture(test::Random& random, int width, int height, int channels) {
  Image image = image::make_image(width, height, channels);
  image.has_alpha = channels == 2 || channels == 4;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        image.at(x, y, c) = x < width / 2
                                ? static_cast<float>(x + y + c) / 50.0f
                                : 1.4f * static_cast<float>(random.integer(10000)) / 10000.0f - 0.2f;
  return image;
}

/// What nothing can pack.
Image noise_of(test::Random& random, int side) {
  Image image = image::make_image(side, side, 3);
  for (float& texel : image.texels.floats()) texel = static_cast<float>(random.integer(1 << 24)) / (1 << 24);
  return image;
}

/// The rows [bottom, bottom + count) as an image of their own.
Image band_of(const Image& image, int bottom, int count) {
  Image band = image::make_image(image.width, count, image.channels);
  band.has_alpha = image.has_alpha;
  for (std::size_t i = 0; i < band.texels.size(); ++i)
    band.texels[i] = image.texels[image.index(0, bottom) + i];
  return band;
}

TEST(ImageWriter, BandsOfAnyHeightGiveTheBytesOfTheWholePicture) {
  const std::uint64_t seed = 77;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  const TemporaryFolder folder;
  for (const Target& target : targets)
    for (const Compression compression : {Compression::fast, Compression::small})
      for (int channels = 1; channels <= 4; ++channels) {
        SCOPED_TRACE(std::string(target.file) + ", channels " + std::to_string(channels));
        const Image image = picture(random, 501, 83, channels);
        io::write_image(folder.path() / target.file, image, target.depth, compression);
        const auto whole = io::read_file(folder.path() / target.file);
        for (const int largest_band : {1, 7, 16, 82}) {
          SCOPED_TRACE("bands up to " + std::to_string(largest_band));
          ImageWriter writer(folder.path() / target.file, io::shape_of(image), target.depth, compression);
          for (int left = image.height; left > 0;) {
            const int count = std::min(left, 1 + random.integer(largest_band));
            left -= count;
            if (random.integer(2) == 0)
              writer.write_rows(band_of(image, left, count));
            else
              writer.write_rows(image, left, count);
          }
          writer.commit();
          EXPECT_TRUE(io::read_file(folder.path() / target.file) == whole);
        }
      }
}

TEST(ImageWriter, TheFirstBandIsTheTopOfThePicture) {
  const TemporaryFolder folder;
  for (const Target& target : targets) {
    SCOPED_TRACE(target.file);
    ImageWriter writer(folder.path() / target.file, {1, 2, 1}, target.depth);
    Image band = image::make_image(1, 1, 1);
    band.texels = {1.0f};
    writer.write_rows(band);
    band.texels = {0.0f};
    writer.write_rows(band);
    writer.commit();
    EXPECT_THAT(test::values_of(io::read_image(folder.path() / target.file)), ElementsAre(0.0f, 1.0f));
  }
}

TEST(ImageWriter, RowsGoToTheFileAsTheyCome) {
  test::Random random(9);
  const TemporaryFolder folder;
  const int side = 700;
  const Image noise = noise_of(random, side);
  for (const Target& target : targets) {
    SCOPED_TRACE(target.file);
    const auto size_of_the_only_file = [&] {
      return std::filesystem::directory_iterator(folder.path())->file_size();
    };
    ImageWriter writer(folder.path() / target.file, io::shape_of(noise), target.depth);
    writer.write_rows(noise, side / 2, side / 2);
    const auto half = size_of_the_only_file();
    writer.write_rows(noise, 0, side / 2);
    writer.commit();
    // A strip of a TIFF, the largest piece that is packed as one, holds a quarter megabyte.
    EXPECT_GT(static_cast<double>(half), 0.5 * static_cast<double>(size_of_the_only_file()) - 262144);
    std::filesystem::remove(folder.path() / target.file);
  }
}

TEST(ImageWriter, TakesBandsFromAnyThreadOneAtATime) {
  test::Random random(4);
  const TemporaryFolder folder;
  const Image image = picture(random, 300, 96, 3);
  for (const Target& target : targets) {
    SCOPED_TRACE(target.file);
    io::write_image(folder.path() / target.file, image, target.depth);
    const auto whole = io::read_file(folder.path() / target.file);
    ImageWriter writer(folder.path() / target.file, io::shape_of(image), target.depth);
    int left = image.height;
    const auto next_band = [&](tbb::flow_control& flow) {
      if (left == 0) flow.stop();
      return left == 0 ? 0 : left -= 8;
    };
    const auto computed = [&](int bottom) { return band_of(image, bottom, 8); };
    const auto write = [&](const Image& band) { writer.write_rows(band); };
    tbb::parallel_pipeline(4, tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, next_band) &
                                  tbb::make_filter<int, Image>(tbb::filter_mode::parallel, computed) &
                                  tbb::make_filter<Image, void>(tbb::filter_mode::serial_in_order, write));
    writer.commit();
    EXPECT_TRUE(io::read_file(folder.path() / target.file) == whole);
  }
}

TEST(ImageWriter, BothCompressionsHoldTheSameValues) {
  test::Random random(5);
  const Image image = picture(random, 200, 50, 3);
  for (const io::ImageFormat format : {io::ImageFormat::png, io::ImageFormat::tiff}) {
    const auto fast = io::encode_image(image, Depth::unorm16, format, Compression::fast);
    const auto small = io::encode_image(image, Depth::unorm16, format, Compression::small);
    EXPECT_LT(small.size(), fast.size());
    EXPECT_EQ(io::decode_image(small, "small").texels, io::decode_image(fast, "fast").texels);
  }
}

TEST(ImageWriter, WithoutACommitNothingChanges) {
  const TemporaryFolder folder;
  const std::vector<std::byte> old_content(10, std::byte{1});
  for (const Target& target : targets) {
    SCOPED_TRACE(target.file);
    const auto path = folder.path() / target.file;
    const auto cancel = [&] {
      ImageWriter writer(path, {300, 300, 3}, target.depth);
      writer.write_rows(image::make_image(300, 200, 3));
    };
    cancel();
    EXPECT_THAT(folder.files(), IsEmpty());
    io::write_file(path, old_content);
    cancel();
    EXPECT_THAT(folder.files(), ElementsAre(target.file));
    EXPECT_EQ(io::read_file(path), old_content);
    std::filesystem::remove(path);
  }
}

TEST(ImageWriter, AFullDiskIsToldAndLeavesTheOldFileAlone) {
  const TemporaryFolder folder;
  const std::vector<std::byte> old_content(10, std::byte{1});
  test::Random random(3);
  for (const Target& target : targets)
    // The small one fails only when the file is completed, the large one between rows.
    for (const int height : {2, 400}) {
      SCOPED_TRACE(std::string(target.file) + ", height " + std::to_string(height));
      const auto path = folder.path() / target.file;
      io::write_file(path, old_content);
      const Image image = picture(random, 900, height, 3);
      std::string said = "nothing";
      {
        const test::FileSizeLimit limit(1000);
        try {
          io::write_image(path, image, target.depth);
        } catch (const MachineError& error) {
          said = error.what();
        }
      }
      EXPECT_THAT(said, HasSubstr(std::string(target.file) + ": cannot write"));
      EXPECT_THAT(folder.files(), ElementsAre(target.file));
      EXPECT_EQ(io::read_file(path), old_content);
      std::filesystem::remove(path);
    }
}

TEST(ImageWriter, RefusesWhatWriteImageRefusesBeforeThereAreRows) {
  const TemporaryFolder folder;
  const auto open = [&](const char* name, const io::ImageShape& shape, Depth depth) {
    const ImageWriter writer(folder.path() / name, shape, depth);
  };
  EXPECT_THROW(open("a.jpg", {4, 4, 3}, Depth::unorm8), InputError);
  EXPECT_THROW(open("a.png", {4, 4, 3}, Depth::half), InputError);
  EXPECT_THROW(open("a.png", {4, 0, 3}, Depth::unorm8), InputError);
  EXPECT_THROW(open("a.png", {4, -1, 3}, Depth::unorm8), InputError);
  EXPECT_THROW(open("a.png", {65537, 1, 3}, Depth::unorm8), InputError);
  EXPECT_THROW(open("a.png", {4, 4, 5}, Depth::unorm8), InputError);
  EXPECT_THROW(open("none/a.png", {4, 4, 3}, Depth::unorm8), InputError);
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(ImageWriter, BandsThatDoNotFitAreACallersMistake) {
  const TemporaryFolder folder;
  ImageWriter writer(folder.path() / "a.png", {4, 4, 3}, Depth::unorm8);
  EXPECT_THROW(writer.write_rows(image::make_image(3, 1, 3)), std::invalid_argument);
  EXPECT_THROW(writer.write_rows(image::make_image(4, 1, 1)), std::invalid_argument);
  EXPECT_THROW(writer.write_rows(image::make_image(4, 5, 3)), std::invalid_argument);
  EXPECT_THROW(writer.write_rows(image::make_image(4, 4, 3), 2, 3), std::invalid_argument);
  writer.write_rows(image::make_image(4, 3, 3));
  EXPECT_THROW(writer.commit(), std::logic_error);
}

/// The definition in double: the code whose value is nearest, the upper of two that are.
template <class Code>
Code nearest_code(float value) {
  const double largest = std::numeric_limits<Code>::max();
  if (std::isnan(value)) return 0;
  return static_cast<Code>(std::floor(std::clamp(static_cast<double>(value), 0.0, 1.0) * largest + 0.5));
}

template <class Code>
void expect_nearest_codes() {
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> values{0.0f,
                            -0.0f,
                            -1.0f,
                            1.0f,
                            1.5f,
                            std::numeric_limits<float>::denorm_min(),
                            -infinity,
                            infinity,
                            -1e30f,
                            1e30f,
                            std::numeric_limits<float>::quiet_NaN()};
  constexpr int codes = std::numeric_limits<Code>::max();
  // Every code, and a sixteenth of a step on either side of the border to the next: there the product
  // in single precision, off by at most 2^-8 of a step, cannot cross the border.
  for (int code = 0; code <= codes; ++code)
    for (const double step : {0.0, 7.0 / 16, 9.0 / 16})
      values.push_back(static_cast<float>((code + step) / codes));
  std::vector<Code> found(values.size());
  io::codec::to_codes(values, found.data());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(found[i], nearest_code<Code>(values[i])) << values[i];
}

TEST(ToCodes, AreTheNearestOfEveryValue) {
  expect_nearest_codes<std::uint8_t>();
  expect_nearest_codes<std::uint16_t>();
}

} // namespace
} // namespace surfgrad
