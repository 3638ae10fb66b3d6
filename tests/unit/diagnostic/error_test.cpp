#include "diagnostic/error.hpp"

#include <gtest/gtest.h>

namespace surfgrad {
namespace {

TEST(InputError, SaysFileLinePlaceProblemAndRemedyInOneLine) {
  const InputError error({"a/stack.json", 7, "layers[2].uv", "is 9", "expected 0 to 7"});
  EXPECT_STREQ(error.what(), "a/stack.json:7: layers[2].uv: is 9; expected 0 to 7");
}

TEST(InputError, LeavesOutWhatDoesNotApply) {
  EXPECT_STREQ(InputError({.problem = "is empty"}).what(), "is empty");
  EXPECT_STREQ(InputError({.file = "a.png", .problem = "is empty"}).what(), "a.png: is empty");
}

TEST(InputError, KeepsControlCharactersOfHostileNamesOffTheTerminal) {
  const InputError error({.file = "a\n\x1b[2J.png", .problem = "is empty"});
  EXPECT_STREQ(error.what(), "a??[2J.png: is empty");
}

} // namespace
} // namespace surfgrad
