#include "diagnostic/error.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "support/file_size_limit.hpp"
#include "support/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <sys/stat.h>

namespace fs = std::filesystem;

namespace surfgrad {
namespace {

using image::Depth;
using image::Image;
using io::ImageFormat;
using ::testing::HasSubstr;

/// An empty folder of this test's own, removed with its content.
class ImageOutput : public ::testing::Test {
 protected:
  ImageOutput()
      : folder(fs::temp_directory_path() /
               ("surfgrad_image_output_" + std::to_string(test::Random(std::random_device{}()).bits()))) {
    fs::create_directory(folder);
  }
  ~ImageOutput() override { fs::remove_all(folder); }

  [[nodiscard]] long entries() const { return std::distance(fs::directory_iterator(folder), {}); }

  fs::path folder;
};

template <class Error, class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "did not throw what it should";
  return {};
}

struct Format {
  ImageFormat format;
  Depth depth;
  const char* name;
};
constexpr Format formats[] = {
    {ImageFormat::png, Depth::unorm8, "png 8"},      {ImageFormat::png, Depth::unorm16, "png 16"},
    {ImageFormat::tiff, Depth::unorm8, "tiff 8"},    {ImageFormat::tiff, Depth::unorm16, "tiff 16"},
    {ImageFormat::tiff, Depth::float32, "tiff 32"},  {ImageFormat::exr, Depth::half, "exr half"},
    {ImageFormat::exr, Depth::float32, "exr float"},
};

/// A value that a file of this depth can hold exactly.
float exact_value(test::Random& random, Depth depth) {
  switch (depth) {
  case Depth::unorm8:
    return static_cast<float>(random.integer(256)) / 255.0f;
  case Depth::unorm16:
    return static_cast<float>(random.integer(65536)) / 65535.0f;
  case Depth::half:
    return std::ldexp(static_cast<float>(random.integer(4095) - 2047), random.integer(20) - 14);
  case Depth::float32:
    return std::bit_cast<float>(static_cast<std::uint32_t>(random.bits())); // any bits at all
  }
  return 0;
}

TEST(EncodeImage, EveryFormatDepthAndChannelCountComesBackBitForBit) {
  const std::uint64_t seed = 20240611;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (const Format& f : formats)
    for (int channels = 1; channels <= 4; ++channels) {
      SCOPED_TRACE(std::string(f.name) + ", channels " + std::to_string(channels));
      // Odd sides, and wide enough that a TIFF takes several strips.
      Image image = image::make_image(1999, 53, channels, f.depth);
      for (float& value : image.texels.floats()) value = exact_value(random, f.depth);
      const Image back = io::decode_image(io::encode_image(image, f.depth, f.format), "memory");
      ASSERT_EQ(back.width, image.width);
      ASSERT_EQ(back.height, image.height);
      ASSERT_EQ(back.channels, channels);
      EXPECT_EQ(back.depth, f.depth);
      std::size_t different = 0;
      for (std::size_t i = 0; i < image.texels.size(); ++i)
        different +=
            std::bit_cast<std::uint32_t>(back.texels[i]) != std::bit_cast<std::uint32_t>(image.texels[i]);
      EXPECT_EQ(different, 0u);
    }
}

TEST(EncodeImage, IntegersAreRoundedToNearestAndClamped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const float inputs[] = {-1.0f, nan,  -infinity, 10.49f / 255, 10.51f / 255,
                          1.0f,  1.5f, infinity,  254.4f / 255};
  const int codes[] = {0, 0, 0, 10, 11, 255, 255, 255, 254};
  Image image = image::make_image(9, 1, 1);
  image.texels.floats().assign(std::begin(inputs), std::end(inputs));
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::tiff}) {
    const Image back = io::decode_image(io::encode_image(image, Depth::unorm8, format), "memory");
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_EQ(back.texels[i], static_cast<float>(codes[i]) / 255.0f) << inputs[i];
  }
}

TEST(EncodeImage, DepthsTheFormatLacksAreRefusedWithThoseItHas) {
  const Image image = image::make_image(1, 1, 1);
  const auto said = [&](Depth depth, ImageFormat format) {
    return refusal<InputError>([&] { (void)io::encode_image(image, depth, format); });
  };
  EXPECT_THAT(said(Depth::half, ImageFormat::png), HasSubstr("PNG holds 8-bit or 16-bit integers"));
  EXPECT_THAT(said(Depth::float32, ImageFormat::png), HasSubstr("cannot hold 32-bit floats"));
  EXPECT_THAT(said(Depth::half, ImageFormat::tiff), HasSubstr("TIFF holds"));
  EXPECT_THAT(said(Depth::unorm8, ImageFormat::exr), HasSubstr("EXR holds 16-bit or 32-bit floats"));
}

TEST(EncodeImage, ImagesNoFileCanHoldAreRefused) {
  EXPECT_THROW((void)io::encode_image(image::make_image(0, 4, 1), Depth::unorm8, ImageFormat::png),
               InputError);
  EXPECT_THROW((void)io::encode_image(image::make_image(65537, 1, 1), Depth::unorm8, ImageFormat::png),
               InputError);
  EXPECT_THROW((void)io::encode_image(image::make_image(1, 1, 5), Depth::unorm8, ImageFormat::tiff),
               InputError);
}

TEST_F(ImageOutput, ExtensionDecidesTheFormat) {
  Image image = image::make_image(2, 2, 1);
  image.texels = {0.0f, 0.2f, 0.4f, 1.0f};
  const auto depth_of = [&](const char* name, Depth depth) {
    io::write_image(folder / name, image, depth);
    const Image back = io::read_image(folder / name);
    EXPECT_EQ(back.width, 2);
    return back.depth;
  };
  EXPECT_EQ(depth_of("a.png", Depth::unorm16), Depth::unorm16);
  EXPECT_EQ(depth_of("a.TIF", Depth::float32), Depth::float32);
  EXPECT_EQ(depth_of("a.tiff", Depth::unorm8), Depth::unorm8);
  EXPECT_EQ(depth_of("a.b.exr", Depth::half), Depth::half);
  EXPECT_EQ(entries(), 4);
}

TEST_F(ImageOutput, CheckRefusesWhatWritingWouldAndLeavesNothing) {
  const auto said = [&](const fs::path& name, Depth depth) {
    return refusal<InputError>([&] { io::check_image_output(folder / name, depth); });
  };
  EXPECT_THAT(said("a.jpg", Depth::unorm8), HasSubstr("expected one of: .png, .tif, .tiff, .exr"));
  EXPECT_THAT(said("png", Depth::unorm8), HasSubstr("no image format for the extension \"\""));
  EXPECT_THAT(said("a.png", Depth::half), HasSubstr("PNG cannot hold 16-bit floats"));
  EXPECT_THAT(said("none/a.png", Depth::unorm8), HasSubstr("does not exist"));
  fs::create_directory(folder / "folder.png");
  EXPECT_THAT(said("folder.png", Depth::unorm8), HasSubstr("is a folder"));
  fs::remove(folder / "folder.png");

  io::check_image_output(folder / "a.png", Depth::unorm8);
  EXPECT_EQ(entries(), 0);
}

TEST_F(ImageOutput, FolderThatTakesNoFilesIsTheMachinesFault) {
  // No one can create files there, not even an administrator.
  const fs::path closed = "/proc/self";
  if (!fs::is_directory(closed)) GTEST_SKIP() << "no folder that refuses everybody on this system";
  EXPECT_THAT(refusal<MachineError>([&] { io::check_image_output(closed / "a.png", Depth::unorm8); }),
              HasSubstr("cannot create a file"));
  EXPECT_THROW(io::write_file(closed / "a.png", {}), MachineError);
}

TEST_F(ImageOutput, OnlyRegularFilesAreReplaced) {
  // A pipe stands for devices too: a test must not put those at risk.
  const fs::path pipe = folder / "pipe.png";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(io::write_file(pipe, {}), InputError);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(entries(), 1);
}

TEST_F(ImageOutput, FailedWriteLeavesTheOldFileAndNothingElse) {
  const std::vector<std::byte> old_content(10, std::byte{1});
  io::write_file(folder / "a.bin", old_content);
  // The first fails only when the last buffered bytes go out, the second while writing.
  for (const std::size_t size : {std::size_t{1500}, std::size_t{1} << 20}) {
    const std::vector<std::byte> content(size, std::byte{2});
    std::string said;
    {
      const test::FileSizeLimit limit(1000);
      said = refusal<MachineError>([&] { io::write_file(folder / "a.bin", content); });
    }
    EXPECT_THAT(said, HasSubstr("a.bin: cannot write"));
    EXPECT_EQ(entries(), 1);
    EXPECT_EQ(io::read_file(folder / "a.bin"), old_content);
  }
}

TEST_F(ImageOutput, SymbolicLinksSurvive) {
  io::write_file(folder / "target", {});
  fs::create_symlink("target", folder / "link");
  const std::vector<std::byte> content(3, std::byte{7});
  io::write_file(folder / "link", content);
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(io::read_file(folder / "target"), content);
}

TEST_F(ImageOutput, LinksToNothingYetAreFollowed) {
  fs::create_directory(folder / "deep");
  fs::create_symlink("deep/second", folder / "first");
  fs::create_symlink("../target", folder / "deep/second");
  const std::vector<std::byte> content(3, std::byte{7});
  io::write_file(folder / "first", content);
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_TRUE(fs::is_symlink(folder / "deep/second"));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder / "target")));
  EXPECT_EQ(io::read_file(folder / "target"), content);

  fs::create_symlink("circle", folder / "circle");
  EXPECT_THROW(io::write_file(folder / "circle", content), MachineError);
  EXPECT_TRUE(fs::is_symlink(folder / "circle"));
}

TEST_F(ImageOutput, ReplacedFilesKeepTheirPermissions) {
  const fs::path file = folder / "a.bin";
  io::write_file(file, {});
  for (const unsigned bits : {0600u, 0664u, 0755u}) {
    fs::permissions(file, fs::perms(bits));
    io::write_file(file, std::vector<std::byte>(3, std::byte{7}));
    EXPECT_EQ(static_cast<unsigned>(fs::status(file).permissions()), bits);
  }
}

TEST_F(ImageOutput, RelativeNamesGoToTheCurrentFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  io::write_file("here.bin", {});
  fs::current_path(before);
  EXPECT_TRUE(fs::exists(folder / "here.bin"));
  EXPECT_EQ(entries(), 1);
}

} // namespace
} // namespace surfgrad
