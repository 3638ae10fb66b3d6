#include "image/texels.hpp"

#include "io/image_file.hpp"
#include "io/image_writer.hpp"
#include "support/images.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace surfgrad::image {
namespace {

template <class Code>
std::vector<Code> all_codes() {
  std::vector<Code> codes(std::numeric_limits<Code>::max() + std::size_t{1});
  std::iota(codes.begin(), codes.end(), Code{0});
  return codes;
}

template <class Code>
void expect_the_same_floats_however_they_are_read(double most) {
  const Texels texels(all_codes<Code>());
  std::vector<float> scratch(texels.size());
  const float* read = texels.read(0, texels.size(), scratch.data());
  Texels written = texels;
  const std::vector<float>& floats = written.floats();
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const auto value = static_cast<float>(static_cast<double>(i) / most);
    ASSERT_EQ(texels[i], value);
    ASSERT_EQ(read[i], value);
    ASSERT_EQ(floats[i], value);
  }
  EXPECT_EQ(texels, written);
  EXPECT_EQ(texels.bytes(), sizeof(Code) * texels.size());
  EXPECT_EQ(written.bytes(), sizeof(float) * texels.size());
}

TEST(Texels, CodesReadAsTheSameFloatsElementByElementInRowsAndOnceWritten) {
  expect_the_same_floats_however_they_are_read<std::uint8_t>(255);
  expect_the_same_floats_however_they_are_read<std::uint16_t>(65535);
}

TEST(Texels, OfWhichOneIsWrittenKeepTheOthers) {
  Texels texels(Texels::Codes8{0, 51, 255});
  texels[1] = 0.3f;
  EXPECT_EQ(texels, (Texels{0.0f, 0.3f, 1.0f}));
  EXPECT_NE(texels, (Texels{0.0f, 0.3f}));
  EXPECT_NE(texels, (Texels{0.0f, 0.3f, 0.9f}));
}

TEST(Texels, RowsAreReadFromWhereTheyBegin) {
  std::vector<float> scratch(2);
  EXPECT_EQ(Texels(Texels::Codes8{0, 51, 255}).read(1, 2, scratch.data())[1], 1.0f);
  const Texels floats{0.5f, -2.0f, 7.0f};
  EXPECT_EQ(floats.read(1, 2, scratch.data())[1], 7.0f);
}

TEST(Texels, OfIntegerFilesTakeNoMoreThanTheFileUnpacked) {
  test::Random random(12);
  for (const Depth depth : {Depth::unorm8, Depth::unorm16})
    for (const io::ImageFormat format : {io::ImageFormat::png, io::ImageFormat::tiff}) {
      const Image image = test::random_image(random, 21, 13, 3, depth);
      const Image back = io::decode_image(io::encode_image(image, depth, format), "memory");
      EXPECT_EQ(back.texels, image.texels);
      EXPECT_EQ(back.texels.bytes(), 21u * 13 * 3 * (depth == Depth::unorm8 ? 1 : 2));
      // What is written of codes is what is written of their floats.
      EXPECT_EQ(io::encode_image(back, depth, format), io::encode_image(image, depth, format));
    }
}

} // namespace
} // namespace surfgrad::image
