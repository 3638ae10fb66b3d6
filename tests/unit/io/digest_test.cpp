// Digests of contents in one piece and in many.

#include "io/digest.hpp"

#include "diagnostic/error.hpp"
#include "io/file.hpp"
#include "support/random.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace surfgrad::io {
namespace {

std::vector<std::byte> random_bytes(std::size_t count) {
  constexpr unsigned seed = 61;
  test::Random random(seed);
  std::vector<std::byte> bytes(count);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random.integer(256));
  return bytes;
}

TEST(Digest, IsXxh3) {
  // XXH3_128bits of nothing, as its specification has it.
  EXPECT_EQ(digest({}), "99aa06d3014798d86001c324468d497f");
}

TEST(Digest, OfPiecesIsThatOfTheWhole) {
  const std::vector<std::byte> bytes = random_bytes(100000);
  for (const std::size_t piece : {1u, 7u, 256u, 99999u}) {
    Digest pieces;
    const std::span<const std::byte> all(bytes);
    for (std::size_t i = 0; i < bytes.size(); i += piece)
      pieces.add(all.subspan(i, std::min(piece, bytes.size() - i)));
    EXPECT_EQ(pieces.text(), digest(bytes)) << piece;
  }
}

TEST(Digest, OfAFileIsThatOfItsContent) {
  const test::TemporaryFolder folder;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, (std::size_t{1} << 20) - 1,
                                 std::size_t{1} << 20, (std::size_t{2} << 20) + 1}) {
    const std::vector<std::byte> bytes = random_bytes(size);
    write_file(folder.path() / "f", bytes);
    EXPECT_EQ(digest_of_file(folder.path() / "f"), digest(bytes)) << size;
  }
  EXPECT_THROW((void)digest_of_file(folder.path() / "gone"), InputError);
  EXPECT_THROW((void)digest_of_file(folder.path()), InputError);
}

} // namespace
} // namespace surfgrad::io
