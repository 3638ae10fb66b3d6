// A processor that lacks the instruction sets asked for: here, one without any vectors.

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

/// Before main: a process asks once what its processor has.
const bool hidden = [] {
  hwy::SetSupportedTargetsForTest(HWY_SCALAR);
  return true;
}();

std::string complaint() {
  try {
    static_cast<void>(current_isa());
  } catch (const MachineError& error) {
    return error.what();
  }
  return "";
}

TEST(NoVectors, LeaveTheOneLaneFloat) {
  ASSERT_TRUE(hidden);
  unsetenv("SURFGRAD_ISA");
  EXPECT_EQ(current_isa(), Isa::one_lane);
  EXPECT_THAT(available_isas(), testing::ElementsAre(Isa::reference, Isa::lanes, Isa::one_lane));
}

TEST(NoVectors, AskedForAreAFaultOfTheMachine) {
#if HWY_ARCH_X86
  for (const Isa isa : {Isa::sse4, Isa::avx2, Isa::avx512}) {
    const std::string name(name_of(isa));
    setenv("SURFGRAD_ISA", name.c_str(), 1);
    EXPECT_THAT(complaint(), HasSubstr("no " + name + "; it has reference, lanes, float"));
    unsetenv("SURFGRAD_ISA");
    EXPECT_THROW(ForcedIsa{isa}, MachineError);
  }
#else
  GTEST_SKIP() << "the names here are those of x86";
#endif
}

} // namespace
} // namespace surfgrad::simd
