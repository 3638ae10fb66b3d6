/// Every public function of the core says when it is degenerate, how far it errs and where it is from.

#include "support/public_functions.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace surfgrad::test {
namespace {

/// A field is a line's text before the first double space; one may name several: "degenerate, error".
bool has_field(const Function& function, const std::string& field) {
  for (const std::string& line : function.comment) {
    const std::string label = line.substr(0, line.find("  "));
    if (label.size() < line.size() && (", " + label + ",").find(", " + field + ",") != std::string::npos)
      return true;
  }
  return false;
}

TEST(DocComments, StateDegenerateCasesErrorAndSource) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SURFGRAD_SOURCE_DIR "/include/surfgrad")) {
    if (is_arithmetic(entry.path().filename().string())) continue;
    for (const Function& function : public_functions(entry.path())) {
      ++count;
      for (const char* field : {"degenerate", "error", "source"})
        EXPECT_TRUE(has_field(function, field)) << function.place << " lacks the field " << field;
    }
  }
  // Fewer would mean that the headers are no longer read as they are written.
  EXPECT_GE(count, 60);
}

} // namespace
} // namespace surfgrad::test
