/// No function of the core is without a twin in every language, overload by overload; no function of a
/// library is without a case that runs it, no case without bounds, and no bound is looser than the case's own
/// operations allow.

#include "conformance/signatures.hpp"
#include "conformance/spirv_calls.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

/// What is in a and not in b.
std::vector<std::string> missing(const Signatures& b, const Signatures& a) {
  std::vector<std::string> names;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(names));
  return names;
}

TEST(Registry, GlslHasATwinOfEveryFunctionOfTheCoreAndNoOther) {
  const Signatures core = signatures_of_core();
  EXPECT_GE(core.size(), 70U) << "the headers are no longer read as they are written";
  EXPECT_THAT(missing(core, spelt_out_in_shaders()), ::testing::IsEmpty())
      << "spelt out, and no form of the core";
  const Signatures glsl = signatures_of_library(Language::glsl);
  Signatures expected = shaders_own();
  for (const std::string& signature : core)
    if (!spelt_out_in_shaders().contains(signature)) expected.insert(signature);
  EXPECT_THAT(missing(glsl, expected), ::testing::IsEmpty()) << "without a twin in GLSL";
  EXPECT_THAT(missing(expected, glsl), ::testing::IsEmpty()) << "of GLSL, and not of the core";
}

TEST(Registry, HlslHasTheFunctionsOfGlsl) {
  const Signatures glsl = signatures_of_library(Language::glsl);
  const Signatures hlsl = signatures_of_library(Language::hlsl);
  EXPECT_THAT(missing(hlsl, glsl), ::testing::IsEmpty()) << "without a twin in HLSL";
  EXPECT_THAT(missing(glsl, hlsl), ::testing::IsEmpty()) << "of HLSL alone";
  EXPECT_EQ(macros_of_library(Language::glsl), macros_of_library(Language::hlsl));
}

/// Functions by the names that WGSL gives them.
Signatures spelt_in_wgsl(const Signatures& glsl) {
  Signatures signatures;
  for (const std::string& signature : glsl) {
    const std::string name = wgsl_name(signature);
    if (name.empty()) continue;
    EXPECT_TRUE(signatures.insert(name + signature.substr(signature.find('('))).second) << signature;
  }
  return signatures;
}

TEST(Registry, WgslHasTheFunctionsOfGlslByItsOwnNames) {
  const Signatures expected = spelt_in_wgsl(signatures_of_library(Language::glsl));
  const Signatures wgsl = signatures_of_library(Language::wgsl);
  EXPECT_THAT(missing(wgsl, expected), ::testing::IsEmpty()) << "without a twin in WGSL";
  EXPECT_THAT(missing(expected, wgsl), ::testing::IsEmpty()) << "of WGSL alone";
}

std::vector<const Row*> pointers_to(const std::vector<Row>& rows) {
  std::vector<const Row*> all;
  for (const Row& row : rows) all.push_back(&row);
  return all;
}

class CompiledRows : public ::testing::TestWithParam<Language> {
 protected:
  static ShaderFunctions compute() {
    return functions_of(compiled_function_by_function(GetParam(), gpu::ShaderStage::compute,
                                                      compute_text(GetParam(), pointers_to(rows()))));
  }
  static ShaderFunctions fragment() {
    return functions_of(compiled_function_by_function(
        GetParam(), gpu::ShaderStage::fragment, fragment_text(GetParam(), pointers_to(fragment_rows()))));
  }
};
INSTANTIATE_TEST_SUITE_P(Languages, CompiledRows, ::testing::ValuesIn(languages),
                         [](const auto& each) { return name_of(each.param); });

/// What functions other than the library's own call of the library.
void add_run(Signatures& run, const ShaderFunctions& functions) {
  const std::string prefix = "surfgrad_";
  for (const auto& [caller, function] : functions)
    for (const std::string& called : function.calls)
      if (!caller.starts_with(prefix) && called.starts_with(prefix)) run.insert(called.substr(prefix.size()));
}

/// Loose operations that a row states and its shader has not, and the reverse.
void expect_stated(const Row& row, const std::set<Loose>& operations) {
  const Looseness& stated = row.looseness;
  EXPECT_LE(stated.divisions > 0, operations.contains(Loose::division)) << row.name << " divides nowhere";
  EXPECT_LE(stated.inverse_roots > 0, operations.contains(Loose::inverse_root))
      << row.name << " takes no inverse root";
  EXPECT_LE(stated.roots > 0, operations.contains(Loose::root)) << row.name << " takes no root";
  EXPECT_LE(static_cast<bool>(row.of_powers), operations.contains(Loose::power))
      << row.name << " has no power";
  EXPECT_LE(stated.factor(), 5) << row.name << ": no operation of Vulkan's rounds as loosely";
}

TEST_P(CompiledRows, RunEveryFunctionAndStateWhatTheyRoundLoosely) {
  const ShaderFunctions in_compute = compute();
  const ShaderFunctions in_fragment = fragment();
  Signatures run;
  add_run(run, in_compute);
  add_run(run, in_fragment);
  const Signatures library = signatures_of_library(GetParam());
  EXPECT_GE(library.size(), 80U) << "the library is no longer read as it is written";
  EXPECT_THAT(missing(run, library), ::testing::IsEmpty()) << "run by no row";
  for (std::size_t r = 0; r < rows().size(); ++r)
    expect_stated(rows()[r], operations_under(in_compute, "row_" + std::to_string(r)));
  for (std::size_t r = 0; r < fragment_rows().size(); ++r)
    expect_stated(fragment_rows()[r], operations_under(in_fragment, "row_" + std::to_string(r)));
}

TEST(Registry, EveryMacroHasACase) {
  for (const Language language : {Language::glsl, Language::hlsl}) {
    std::ifstream file(std::string(SURFGRAD_SOURCE_DIR "/tests/conformance/harness.") + name_of(language));
    std::ostringstream harness;
    harness << file.rdbuf();
    const auto macros = macros_of_library(language);
    EXPECT_GE(macros.size(), 3U);
    for (const std::string& macro : macros)
      EXPECT_THAT(harness.str(), ::testing::HasSubstr(macro + "(")) << name_of(language);
  }
}

TEST(Registry, EveryCaseHasABoundForEveryResult) {
  Random random(1);
  const ShaderInputs<float> in = random_shader_inputs(random);
  std::set<std::string> names;
  for (const auto* some : {&rows(), &fragment_rows()})
    for (const Row& row : *some) {
      EXPECT_TRUE(names.insert(row.name).second) << row.name << " stands twice";
      EXPECT_TRUE(row.bound) << row.name << " has no bound";
      if (!row.bound) continue;
      EXPECT_EQ(row.device_bound(convert<double>(in)).size(), row.in_float(in).size()) << row.name;
      EXPECT_FALSE(row.in_float(in).empty()) << row.name;
      EXPECT_FALSE(row.used_fields().empty() && row.name != "lattice_start") << row.name << " has no inputs";
    }
}

} // namespace
} // namespace surfgrad::test
