// Which instruction set is in use: the fastest there is, the one asked for, or none and a reason. (What the
// processor lacks: no_vectors_test.cpp.)

#include "simd/isa.hpp"

#include "diagnostic/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace surfgrad::simd {
namespace {

using testing::HasSubstr;

class InstructionSet : public testing::Test {
 protected:
  void SetUp() override { unsetenv("SURFGRAD_ISA"); }
  void TearDown() override { unsetenv("SURFGRAD_ISA"); }
  static void ask_for(const std::string& word) { setenv("SURFGRAD_ISA", word.c_str(), 1); }
};

TEST_F(InstructionSet, InUseIsTheFastestUnlessOneIsAskedFor) {
  EXPECT_EQ(current_isa(), available_isas().back());
  ask_for("");
  EXPECT_EQ(current_isa(), available_isas().back());
  for (const Isa isa : available_isas()) {
    ask_for(std::string(name_of(isa)));
    EXPECT_EQ(current_isa(), isa) << name_of(isa);
  }
}

TEST_F(InstructionSet, ThatThereIsNotIsAFaultOfTheUser) {
  for (const char* word : {"nonsense", "AVX2", "avx2 ", "sse", "1"}) {
    ask_for(word);
    std::string said;
    try {
      static_cast<void>(current_isa());
    } catch (const InputError& error) {
      said = error.what();
    }
    EXPECT_THAT(said, HasSubstr(word));
    EXPECT_THAT(said, HasSubstr("is no instruction set of this program; use one of reference, lanes, float"));
  }
}

TEST_F(InstructionSet, ForcedOnesNestAndOverrideTheOneAskedFor) {
  ask_for("nonsense");
  const ForcedIsa outer(Isa::one_lane);
  EXPECT_EQ(current_isa(), Isa::one_lane);
  {
    const ForcedIsa inner(Isa::reference);
    EXPECT_EQ(current_isa(), Isa::reference);
  }
  EXPECT_EQ(current_isa(), Isa::one_lane);
}

} // namespace
} // namespace surfgrad::simd
