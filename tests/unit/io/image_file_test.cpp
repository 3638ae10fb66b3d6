#include "io/image_file.hpp"

#include "diagnostic/error.hpp"
#include "image_bytes.hpp"
#include "support/images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace surfgrad {
namespace {

using image::Depth;
using image::Image;
using test::Bytes;
using test::exr_file;
using test::hdr_file;
using test::png_chunk;
using test::png_file;
using test::tga_file;
using test::tiff_file;
using test::tiff_tags;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Image decode(const Bytes& file, const char* name = "given") { return io::decode_image(file.span(), name); }

/// What decoding says; fails the test where it does not throw InputError.
std::string refusal(const Bytes& file) {
  try {
    (void)decode(file);
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was decoded";
  return {};
}

constexpr float u8(int code) { return static_cast<float>(code) / 255.0f; }
constexpr float u16(int code) { return static_cast<float>(code) / 65535.0f; }

// Expected texels below are listed from the bottom row up, as image::Image stores them; the files
// store the top row first unless a test says otherwise.

TEST(ReadPng, GreyOfEveryBitDepthScalesToOne) {
  struct Case {
    int bits;
    Bytes row;
    float left, right;
  };
  const Case cases[] = {{1, {0, 0x40}, 0.0f, 1.0f},
                        {2, {0, 0x60}, u8(85), u8(170)},
                        {4, {0, 0x1e}, u8(17), u8(14 * 17)},
                        {8, {0, 1, 254}, u8(1), u8(254)},
                        {16, {0, 0x12, 0x34, 0xff, 0xfe}, u16(0x1234), u16(0xfffe)}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.bits);
    const Image image = decode(png_file({.width = 2, .height = 1, .bits = c.bits}, c.row));
    EXPECT_EQ(image.channels, 1);
    EXPECT_EQ(image.depth, c.bits == 16 ? Depth::unorm16 : Depth::unorm8);
    EXPECT_THAT(test::values_of(image), ElementsAre(c.left, c.right));
  }
}

TEST(ReadPng, LastRowOfTheFileIsRowZero) {
  const Image image = decode(png_file({.width = 2, .height = 2}, {0, 1, 2, 0, 3, 4}));
  EXPECT_THAT(test::values_of(image), ElementsAre(u8(3), u8(4), u8(1), u8(2)));
}

TEST(ReadPng, InterlacedRowsLandWhereTheyBelong) {
  // Adam7 of 2 x 2: the first pixel, the second, then the second row.
  const Image image = decode(png_file({.width = 2, .height = 2, .interlaced = 1}, {0, 1, 0, 2, 0, 3, 4}));
  EXPECT_THAT(test::values_of(image), ElementsAre(u8(3), u8(4), u8(1), u8(2)));
}

TEST(ReadPng, ColorAndAlphaKeepTheirOrder) {
  EXPECT_THAT(test::values_of(decode(png_file({.color_type = 2}, {0, 1, 2, 3}))),
              ElementsAre(u8(1), u8(2), u8(3)));
  EXPECT_THAT(test::values_of(decode(png_file({.color_type = 4}, {0, 1, 2}))), ElementsAre(u8(1), u8(2)));
  EXPECT_THAT(test::values_of(decode(png_file({.color_type = 6}, {0, 1, 2, 3, 4}))),
              ElementsAre(u8(1), u8(2), u8(3), u8(4)));
  EXPECT_THAT(test::values_of(decode(png_file({.bits = 16, .color_type = 4}, {0, 1, 2, 3, 4}))),
              ElementsAre(u16(0x0102), u16(0x0304)));
}

TEST(ReadPng, PaletteIsExpanded) {
  const Bytes palette = png_chunk("PLTE", {10, 20, 30, 40, 50, 60});
  const Image opaque = decode(png_file({.width = 2, .color_type = 3}, {0, 1, 0}, palette));
  EXPECT_EQ(opaque.channels, 3);
  EXPECT_THAT(test::values_of(opaque), ElementsAre(u8(40), u8(50), u8(60), u8(10), u8(20), u8(30)));

  const Bytes transparent = Bytes(palette).add(png_chunk("tRNS", {7}));
  const Image clear = decode(png_file({.color_type = 3}, {0, 0}, transparent));
  EXPECT_THAT(test::values_of(clear), ElementsAre(u8(10), u8(20), u8(30), u8(7)));
}

TEST(ReadPng, TransparentGreyBecomesGreyAndAlpha) {
  for (const int bits : {8, 16}) {
    SCOPED_TRACE(bits);
    const Bytes row = bits == 8 ? Bytes{0, 9, 5} : Bytes{0, 0, 9, 0, 5};
    const Image image = decode(png_file({.width = 2, .bits = bits}, row, png_chunk("tRNS", {0, 5})));
    EXPECT_EQ(image.channels, 2);
    const float scale = bits == 8 ? u8(1) : u16(1);
    EXPECT_THAT(test::values_of(image), ElementsAre(9 * scale, 1.0f, 5 * scale, 0.0f));
  }
}

TEST(ReadPng, GammaIsNotApplied) {
  const Bytes gamma = png_chunk("gAMA", Bytes().u32_big(45455));
  EXPECT_THAT(test::values_of(decode(png_file({}, {0, 100}, gamma))), ElementsAre(u8(100)));
}

TEST(ReadTiff, IntegersAndFloatsKeepTheirPrecision) {
  const Image eight = decode(tiff_file(tiff_tags(2, 1, 8, 1, 1), {{1, 254}}));
  EXPECT_EQ(eight.depth, Depth::unorm8);
  EXPECT_THAT(test::values_of(eight), ElementsAre(u8(1), u8(254)));

  const Image sixteen = decode(tiff_file(tiff_tags(1, 1, 16, 1, 1), {{0x34, 0x12}}));
  EXPECT_EQ(sixteen.depth, Depth::unorm16);
  EXPECT_THAT(test::values_of(sixteen), ElementsAre(u16(0x1234)));

  auto tags = tiff_tags(1, 1, 32, 3, 2);
  tags.push_back({339, 3}); // IEEE floats
  const Image wide = decode(tiff_file(tags, {test::floats({-1.5f, 1e30f, 0.1f})}));
  EXPECT_EQ(wide.depth, Depth::float32);
  EXPECT_THAT(test::values_of(wide), ElementsAre(-1.5f, 1e30f, 0.1f));

  tags = tiff_tags(2, 1, 16, 1, 1);
  tags.push_back({339, 3});
  const Image half = decode(tiff_file(tags, {{0x00, 0x3c, 0x00, 0xc1}})); // 1.0 and -2.5
  EXPECT_EQ(half.depth, Depth::half);
  EXPECT_THAT(test::values_of(half), ElementsAre(1.0f, -2.5f));
}

TEST(ReadTiff, OrientationDecidesWhichRowIsTheBottom) {
  auto tags = tiff_tags(1, 2, 8, 1, 1);
  EXPECT_THAT(test::values_of(decode(tiff_file(tags, {{1, 2}}))), ElementsAre(u8(2), u8(1)));
  tags.push_back({274, 4});
  EXPECT_THAT(test::values_of(decode(tiff_file(tags, {{1, 2}}))), ElementsAre(u8(1), u8(2)));
  tags.back().value = 6;
  EXPECT_THAT(refusal(tiff_file(tags, {{1, 2}})), HasSubstr("orientation 6"));
}

TEST(ReadTiff, WhiteIsZeroIsTurnedRound) {
  EXPECT_THAT(test::values_of(decode(tiff_file(tiff_tags(2, 1, 8, 1, 0), {{0, 200}}))),
              ElementsAre(u8(255), u8(55)));
}

TEST(ReadTiff, StripsAndSeparatePlanesAreJoined) {
  auto tags = tiff_tags(1, 3, 8, 3, 2);
  tags.back().value = 2; // rows a strip: the second strip of each plane has one
  tags.push_back({284, 2});
  const Image image = decode(tiff_file(tags, {{1, 2}, {3}, {11, 12}, {13}, {21, 22}, {23}}));
  EXPECT_THAT(test::values_of(image),
              ElementsAre(u8(3), u8(13), u8(23), u8(2), u8(12), u8(22), u8(1), u8(11), u8(21)));
}

TEST(ReadTiff, TilesPastTheEdgeAreCutOff) {
  // 17 x 2 texels in two tiles of 16 x 16; the codes count up in the part inside.
  std::vector<test::TiffTag> tags{{256, 17}, {257, 2}, {258, 8},  {259, 1},
                                  {262, 1},  {277, 1}, {322, 16}, {323, 16}};
  Bytes left, right;
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x) {
      left.u8(y < 2 ? 100 * y + x : 99);
      right.u8(y < 2 && x < 1 ? 100 * y + 16 : 99);
    }
  const Image image = decode(tiff_file(tags, {left, right}, true));
  ASSERT_EQ(image.width, 17);
  for (int x = 0; x < 17; ++x) {
    EXPECT_EQ(image.at(x, 1, 0), u8(x));
    EXPECT_EQ(image.at(x, 0, 0), u8(100 + x));
  }
}

TEST(ReadTiff, UnsupportedSamplesAreRefusedByName) {
  EXPECT_THAT(refusal(tiff_file(tiff_tags(8, 1, 1, 1, 1), {{0}})), HasSubstr("1-bit samples"));
  EXPECT_THAT(refusal(tiff_file(tiff_tags(1, 1, 8, 4, 5), {{0, 0, 0, 0}})),
              HasSubstr("photometric interpretation 5"));
  EXPECT_THAT(refusal(tiff_file(tiff_tags(1, 1, 8, 5, 2), {{0, 0, 0, 0, 0}})), HasSubstr("5 samples"));
}

TEST(ReadExr, DataWindowDecidesAndTheLastLineIsRowZero) {
  const test::ExrShape shape{
      .channels = {{"B"}, {"G"}, {"R"}}, .min_x = -3, .min_y = 7, .max_x = -2, .max_y = 8};
  // A line holds the samples of each channel in turn.
  const Image image =
      decode(exr_file(shape, {test::floats({3, 6, 2, 5, 1, 4}), test::floats({9, 12, 8, 11, 7, 10})}));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.depth, Depth::float32);
  EXPECT_THAT(test::values_of(image), ElementsAre(7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6));
}

TEST(ReadExr, ChannelsAreChosenByName) {
  const auto texels = [](std::vector<test::ExrChannel> channels) {
    Bytes line;
    for (std::size_t i = 0; i < channels.size(); ++i) line.add(test::floats({static_cast<float>(i)}));
    return test::values_of(decode(exr_file({.channels = std::move(channels)}, {line})));
  };
  EXPECT_THAT(texels({{"A"}, {"B"}, {"G"}, {"R"}, {"Z"}}), ElementsAre(3, 2, 1, 0));
  EXPECT_THAT(texels({{"A"}, {"Y"}, {"Z"}}), ElementsAre(1, 0));
  EXPECT_THAT(texels({{"X"}, {"Y"}, {"Z"}}), ElementsAre(0, 1, 2)) << "a vector, not a luminance";
  EXPECT_THAT(texels({{"a"}, {"b"}, {"c"}, {"d"}, {"e"}}), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(texels({{"n.B"}, {"n.G"}, {"n.R"}}), ElementsAre(2, 1, 0)) << "the only layer";
  EXPECT_THAT(texels({{"Y"}, {"n.B"}, {"n.G"}, {"n.R"}}), ElementsAre(0)) << "the unnamed layer comes first";
}

TEST(ReadExr, HalfIsKept) {
  const Image image = decode(exr_file({.channels = {{"Y", 1}}, .max_x = 1}, {{0x00, 0x3c, 0x00, 0xc1}}));
  EXPECT_EQ(image.depth, Depth::half);
  EXPECT_THAT(test::values_of(image), ElementsAre(1.0f, -2.5f));
}

TEST(ReadExr, SubsampledIntegerAndDeepChannelsAreRefusedByName) {
  const test::ExrShape subsampled{.channels = {{"R", 2, 2}}, .max_x = 1, .max_y = 1};
  EXPECT_THAT(refusal(exr_file(subsampled, {test::floats({1}), {}})),
              HasSubstr("channel \"R\": EXR is subsampled"));
  EXPECT_THAT(refusal(exr_file({.channels = {{"R", 0}}}, {test::floats({1})})),
              HasSubstr("EXR holds integers"));
  EXPECT_THAT(refusal(exr_file({.channels = {{"R"}}, .version_flags = 0x800}, {test::floats({1})})),
              HasSubstr("deep"));
}

TEST(ReadJpeg, GreyCodesComeBackExactly) {
  const Image image = decode(test::jpeg_grey());
  EXPECT_EQ(image.width, 8);
  ASSERT_EQ(image.height, 16);
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.at(3, 15, 0), u8(200));
  EXPECT_EQ(image.at(3, 0, 0), u8(40));
}

TEST(ReadJpeg, ColorIsConvertedFromYCbCr) {
  const Image image = decode(test::jpeg_color());
  ASSERT_EQ(image.channels, 3);
  // Y, Cb and Cr are each rounded to a code, and 1.772 times half a code is the most that adds.
  const float tolerance = u8(2);
  EXPECT_NEAR(image.at(4, 15, 0), 1.0f, tolerance);
  EXPECT_NEAR(image.at(4, 15, 1), 0.0f, tolerance);
  EXPECT_NEAR(image.at(4, 15, 2), 0.0f, tolerance);
  EXPECT_NEAR(image.at(4, 0, 0), 0.0f, tolerance);
  EXPECT_NEAR(image.at(4, 0, 2), 1.0f, tolerance);
}

TEST(ReadJpeg, FourInksAreRefused) { EXPECT_THAT(refusal(test::jpeg_cmyk()), HasSubstr("CMYK")); }

TEST(ReadTga, RowsAndChannelsAreTurnedRight) {
  const Bytes pixels{1, 2, 3, 4, 5, 6}; // blue first
  const Image upward = decode(tga_file({.height = 2}, pixels), "x.tga");
  EXPECT_THAT(test::values_of(upward), ElementsAre(u8(3), u8(2), u8(1), u8(6), u8(5), u8(4)));
  const Image downward = decode(tga_file({.height = 2, .flags = 0x20}, pixels), "x.tga");
  EXPECT_THAT(test::values_of(downward), ElementsAre(u8(6), u8(5), u8(4), u8(3), u8(2), u8(1)));
}

TEST(ReadTga, RunsAndPalettesAreExpanded) {
  const Bytes runs{0x82, 7, 0x01, 8, 9}; // three times 7, then 8, 9
  EXPECT_THAT(test::values_of(decode(tga_file({.width = 5, .type = 11, .bits = 8}, runs))),
              ElementsAre(u8(7), u8(7), u8(7), u8(8), u8(9)));
  const Bytes palette{1, 2, 3, 4, 5, 6, /* pixels */ 1, 0};
  EXPECT_THAT(
      test::values_of(decode(tga_file({.width = 2, .type = 1, .bits = 8, .palette_count = 2}, palette))),
      ElementsAre(u8(6), u8(5), u8(4), u8(3), u8(2), u8(1)));
}

TEST(ReadTga, RowsFromTheRightAreRefused) {
  EXPECT_THROW((void)decode(tga_file({.flags = 0x10}, {1, 2, 3}), "x.tga"), InputError);
}

TEST(ReadHdr, FlatAndRunLengthRowsKeepTheirValues) {
  // mantissa * 2^(exponent - 136)
  const Image flat = decode(hdr_file("-Y 2 +X 1", {128, 64, 32, 129, 255, 0, 1, 136}));
  EXPECT_EQ(flat.depth, Depth::float32);
  EXPECT_THAT(test::values_of(flat), ElementsAre(255.0f, 0.0f, 1.0f, 1.0f, 0.5f, 0.25f));

  const Bytes row{2, 2, 0, 8, 136, 9, 136, 8, 136, 7, /* exponents */ 131, 136, 5, 137, 137, 137, 137, 137};
  const Image coded = decode(hdr_file("-Y 1 +X 8", row));
  for (int x = 0; x < 8; ++x) {
    const float scale = x < 3 ? 1.0f : 2.0f;
    EXPECT_EQ(coded.at(x, 0, 0), 9 * scale);
    EXPECT_EQ(coded.at(x, 0, 2), 7 * scale);
  }
}

TEST(ReadImage, ContentDecidesNotTheName) {
  EXPECT_EQ(decode(png_file({}, {0, 5}), "picture.jpg").texels[0], u8(5));
  EXPECT_EQ(decode(png_file({}, {0, 5}), "picture.tga").texels[0], u8(5));
}

} // namespace
} // namespace surfgrad
