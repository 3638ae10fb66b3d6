// Which instruction set is in use: the fastest there is, the one asked for, or none and a reason.

#include "simd/isa.hpp"

#include "diagnostic/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdlib>
#include <string>

namespace surfgrad::simd {
namespace {

using testing::HasSubstr;

class InstructionSet : public testing::Test {
 protected:
  void SetUp() override { unsetenv("SURFGRAD_ISA"); }
  void TearDown() override {
    unsetenv("SURFGRAD_ISA");
    hwy::SetSupportedTargetsForTest(0);
  }
  static void ask_for(const std::string& word) { setenv("SURFGRAD_ISA", word.c_str(), 1); }
  /// As if this processor had no vectors at all.
  static void hide_vectors() { hwy::SetSupportedTargetsForTest(HWY_SCALAR); }

  template <class Error>
  static std::string complaint() {
    try {
      static_cast<void>(current_isa());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
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

TEST_F(InstructionSet, WithoutVectorsIsTheOneLaneFloat) {
  hide_vectors();
  EXPECT_EQ(current_isa(), Isa::one_lane);
  EXPECT_THAT(available_isas(), testing::ElementsAre(Isa::reference, Isa::lanes, Isa::one_lane));
}

TEST_F(InstructionSet, ThatTheProcessorLacksIsAFaultOfTheMachine) {
  const std::vector<Isa> had = available_isas();
  hide_vectors();
  int lacking = 0;
  for (const Isa isa : had) {
    if (isa == Isa::reference || isa == Isa::lanes || isa == Isa::one_lane) continue;
    ++lacking;
    const std::string name(name_of(isa));
    ask_for(name);
    EXPECT_THAT(complaint<MachineError>(), HasSubstr("no " + name + "; it has reference, lanes, float"));
    EXPECT_THROW(ForcedIsa{isa}, MachineError);
  }
  if (lacking == 0) GTEST_SKIP() << "this program holds no vectors";
}

TEST_F(InstructionSet, ThatThereIsNotIsAFaultOfTheUser) {
  for (const char* word : {"nonsense", "AVX2", "avx2 ", "sse", "1"}) {
    ask_for(word);
    const std::string said = complaint<InputError>();
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
