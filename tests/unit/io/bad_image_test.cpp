#include "diagnostic/error.hpp"
#include "image_bytes.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "support/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace surfgrad {
namespace {

using image::Depth;
using image::Image;
using io::ImageFormat;
using test::Bytes;
using test::exr_file;
using test::exr_header;
using test::hdr_file;
using test::png_chunk;
using test::png_file;
using test::tga_file;
using test::tiff_file;
using test::tiff_tags;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(std::span<const std::byte> bytes, const char* name) {
  try {
    (void)io::decode_image(bytes, name);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was decoded";
  return {};
}

struct Sample {
  std::string name;
  Bytes bytes;
  std::size_t spare = 0; ///< bytes at the end that may be missing unnoticed
};

Bytes encoded(Depth depth, ImageFormat format) {
  Image image = image::make_image(5, 4, 3);
  for (std::size_t i = 0; i < image.texels.size(); ++i)
    image.texels[i] = static_cast<float>(i * i % 61) / 61.0f;
  Bytes bytes;
  for (const std::byte b : io::encode_image(image, depth, format))
    bytes.u8(std::to_integer<std::uint32_t>(b));
  return bytes;
}

/// Small valid files of every format and of several of its variants.
std::vector<Sample> samples() {
  std::vector<Sample> list;
  const auto add = [&](const char* name, Bytes bytes) { list.push_back({name, std::move(bytes), 0}); };
  // The checksum of the empty end chunk: every decoder may stop at the name of that chunk.
  const auto add_png = [&](const char* name, Bytes bytes) { list.push_back({name, std::move(bytes), 4}); };
  add_png("own 8-bit.png", encoded(Depth::unorm8, ImageFormat::png));
  add_png("own 16-bit.png", encoded(Depth::unorm16, ImageFormat::png));
  add_png("palette.png", png_file({.width = 2, .color_type = 3}, {0, 1, 0},
                                  png_chunk("PLTE", {10, 20, 30, 40, 50, 60}).add(png_chunk("tRNS", {7}))));
  add_png("interlaced.png", png_file({.width = 2, .height = 2, .interlaced = 1}, {0, 1, 0, 2, 0, 3, 4}));
  add("own 16-bit.tif", encoded(Depth::unorm16, ImageFormat::tiff));
  add("own float.tif", encoded(Depth::float32, ImageFormat::tiff));
  add("plain.tif", tiff_file(tiff_tags(2, 2, 8, 3, 2), {{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}}));
  add("own half.exr", encoded(Depth::half, ImageFormat::exr));
  add("plain.exr", exr_file({.channels = {{"Y"}}, .max_y = 1}, {test::floats({1}), test::floats({2})}));
  add("grey.jpg", test::jpeg_grey());
  add("color.jpg", test::jpeg_color());
  add("flat.tga", tga_file({.width = 2, .height = 2}, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  add("runs.tga", tga_file({.width = 5, .type = 11, .bits = 8}, {0x82, 7, 0x01, 8, 9}));
  add("palette.tga",
      tga_file({.width = 2, .type = 1, .bits = 8, .palette_count = 2}, {1, 2, 3, 4, 5, 6, 1, 0}));
  add("flat.hdr", hdr_file("-Y 2 +X 1", {128, 64, 32, 129, 255, 0, 1, 136}));
  add("runs.hdr",
      hdr_file("-Y 1 +X 8", {2, 2, 0, 8, 136, 9, 136, 8, 136, 7, 131, 136, 5, 137, 137, 137, 137, 137}));
  return list;
}

TEST(BadImage, EveryTruncationOfEveryFormatIsRefused) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    ASSERT_NO_THROW((void)io::decode_image(sample.bytes.span(), sample.name));
    for (std::size_t size = 0; size < sample.bytes.size() - sample.spare; ++size) {
      SCOPED_TRACE(size);
      const std::string said = refusal(sample.bytes.first(size), sample.name.c_str());
      EXPECT_THAT(said, HasSubstr(sample.name));
    }
  }
}

TEST(BadImage, DamagedBytesAreRefusedOrDecodedButNeverWorse) {
  const std::uint64_t seed = 77;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  long refused = 0, decoded = 0;
  const auto attempt = [&](const Bytes& bytes, const std::string& name) {
    try {
      const Image image = io::decode_image(bytes.span(), name);
      ASSERT_EQ(image.texels.size(), image.index(0, image.height));
      ++decoded;
    } catch (const InputError&) {
      ++refused;
    }
  };
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    for (std::size_t i = 0; i < sample.bytes.size(); ++i)
      for (const std::byte value :
           {std::byte{0}, std::byte{0x7f}, std::byte{0xff}, std::byte(random.integer(256))}) {
        Bytes bytes = sample.bytes;
        bytes[i] = value;
        attempt(bytes, sample.name);
      }
    for (int round = 0; round < 500; ++round) {
      Bytes bytes = sample.bytes;
      for (int change = 0; change < 4; ++change)
        bytes[random.bits() % bytes.size()] = std::byte(random.integer(256));
      attempt(bytes, sample.name);
    }
  }
  std::printf("  damaged files: %ld refused, %ld decoded\n", refused, decoded);
  EXPECT_GT(refused, decoded / 100);
}

// A declared size is believed only as far as the bytes of the file can bear it. None of these
// files is larger than a kilobyte, and none may cost an allocation of its declared size.

TEST(BadImage, HugeDeclaredSizesAreRefusedWithTheLimits) {
  const auto limits = AllOf(HasSubstr("65536"), HasSubstr("268435456"));
  EXPECT_THAT(refusal(png_file({.width = 0x7fffffff, .height = 0x7fffffff}, {0, 0}).span(), "x.png"), limits);
  EXPECT_THAT(refusal(png_file({.width = 65536, .height = 65536}, {0, 0}).span(), "x.png"), limits);
  EXPECT_THAT(refusal(tiff_file(tiff_tags(0x7fffffff, 1, 8, 1, 1), {{0}}).span(), "x.tif"), limits);
  EXPECT_THAT(refusal(tiff_file(tiff_tags(65537, 1, 8, 1, 1), {{0}}).span(), "x.tif"), limits);
  const auto exr = [](std::int32_t min, std::int32_t max) {
    return exr_file({.channels = {{"Y"}}, .min_x = min, .min_y = min, .max_x = max, .max_y = max},
                    {test::floats({1})});
  };
  EXPECT_THAT(refusal(exr(-0x7fffffff, 0x7fffffff).span(), "x.exr"), limits);
  EXPECT_THAT(refusal(exr(5, 4).span(), "x.exr"), limits);
  EXPECT_THAT(refusal(tga_file({.width = 65535, .height = 65535}, {0}).span(), "x.tga"), limits);
  EXPECT_THAT(refusal(hdr_file("-Y 2147483647 +X 2147483647", {0}).span(), "x.hdr"), limits);
  EXPECT_THAT(refusal(hdr_file("-Y -4 +X 4", {0}).span(), "x.hdr"), limits);
}

TEST(BadImage, SizesWithinTheLimitsThatTheBytesCannotFillAreRefused) {
  const auto damaged = HasSubstr("is damaged or truncated");
  const auto too_little = AllOf(damaged, HasSubstr("bytes of file can hold"));
  EXPECT_THAT(refusal(png_file({.width = 16384, .height = 16384}, {0, 0}).span(), "x.png"), too_little);
  EXPECT_THAT(refusal(tiff_file(tiff_tags(16384, 16384, 8, 1, 1), {{0}}).span(), "x.tif"), too_little);
  auto tags = tiff_tags(16384, 16384, 32, 4, 2);
  tags.push_back({339, 3});
  tags[3].value = 8; // Deflate
  EXPECT_THAT(refusal(tiff_file(tags, {{0}}).span(), "x.tif"), too_little);
  EXPECT_THAT(
      refusal(exr_file({.channels = {{"Y"}}, .max_x = 16383, .max_y = 16383}, {test::floats({1})}).span(),
              "x.exr"),
      too_little);
  EXPECT_THAT(refusal(tga_file({.width = 16384, .height = 16384}, {0}).span(), "x.tga"), damaged);
  EXPECT_THAT(refusal(hdr_file("-Y 16384 +X 16384", {2, 2, 64, 0}).span(), "x.hdr"), damaged);
  EXPECT_THAT(refusal(hdr_file("-Y 16384 +X 4", {0}).span(), "x.hdr"), damaged);
  Bytes jpeg = test::jpeg_grey();
  for (const std::size_t at : {76u, 78u}) jpeg[at] = std::byte{0x30}; // 12296 x 12304
  EXPECT_THAT(refusal(jpeg.span(), "x.jpg"), too_little);
}

TEST(BadImage, HugeTilesAndAttributesAreRefused) {
  const std::vector<test::TiffTag> tags{{256, 1}, {257, 1}, {258, 8},     {259, 8},
                                        {262, 1}, {277, 1}, {322, 65536}, {323, 4096}};
  EXPECT_THAT(refusal(tiff_file(tags, {{0}}, true).span(), "x.tif"), HasSubstr("bytes of file can hold"));
  EXPECT_THAT(refusal(exr_header({.channels = {{"Y"}}, .tile = 16384}).span(), "x.exr"),
              HasSubstr("tiles of 16384"));
  EXPECT_THAT(refusal(exr_header({.channels = {{"Y"}}, .max_x = 99, .max_y = 99, .tile = 1}).span(), "x.exr"),
              HasSubstr("declares 10000 tiles"));
  Bytes long_text;
  long_text.text("comments").u8(0).text("string").u8(0).u32_little(0x7fffffff);
  EXPECT_THAT(refusal(exr_header({.channels = {{"Y"}}}, long_text).span(), "x.exr"), HasSubstr("breaks off"));
  const Bytes preview =
      test::exr_attribute("preview", "preview", Bytes().u32_little(65536).u32_little(65536));
  EXPECT_THAT(refusal(exr_header({.channels = {{"Y"}}}, preview).span(), "x.exr"), HasSubstr("preview"));
}

TEST(BadImage, HdrRunsThatWouldNeverEndAreRefused) {
  // A count of zero advances nothing.
  EXPECT_THAT(refusal(hdr_file("-Y 1 +X 8", {2, 2, 0, 8, 0, 0, 0, 0}).span(), "x.hdr"), HasSubstr("run"));
  EXPECT_THAT(refusal(hdr_file("-Y 1 +X 8", {2, 2, 0, 8, 200, 1}).span(), "x.hdr"), HasSubstr("run"));
}

TEST(BadImage, UnknownContentIsRefusedWithTheFormatsThatCanBeRead) {
  const auto known = HasSubstr("expected one of: PNG, TIFF, OpenEXR, JPEG, Radiance HDR, TGA");
  EXPECT_THAT(refusal(Bytes().text("once upon a time there was a text file\n").span(), "a.png"), known);
  EXPECT_THAT(refusal(Bytes().text("DDS |").span(), "a.dds"), known);
  EXPECT_THAT(refusal(std::vector<std::byte>(100), "zeros"), known);
  EXPECT_THAT(refusal({}, "a.png"), HasSubstr("a.png: is empty"));
}

TEST(BadImage, FilesThatCannotBeReadAreNamedWithTheReason) {
  const auto said = [](const fs::path& file) {
    try {
      (void)io::read_image(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("was read");
  };
  const fs::path folder = fs::temp_directory_path();
  EXPECT_THAT(said(folder / "surfgrad_no_such_file.png"),
              HasSubstr("surfgrad_no_such_file.png: no such file"));
  EXPECT_THAT(said(folder), HasSubstr("is a folder"));
  EXPECT_THAT(said(""), HasSubstr("no such file"));
  const fs::path device = "/dev/zero";
  if (fs::exists(device)) {
    EXPECT_THAT(said(device), HasSubstr("not a regular file"));
  }
}

} // namespace
} // namespace surfgrad
