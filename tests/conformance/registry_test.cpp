/// No function of the core is without a twin in every language, a case and a bound; no function of a library
/// is without a case.

#include "conformance/languages.hpp"
#include "support/public_functions.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace surfgrad::test {
namespace {

/// What the rows call, the harnesses' own functions included: those pass arrays and loops to the library.
std::string all_calls() {
  std::string text;
  for (const Row& row : rows()) text += row.call + "\n";
  std::ifstream harness(SURFGRAD_SOURCE_DIR "/tests/conformance/harness.glsl");
  std::ostringstream of_harness;
  of_harness << harness.rdbuf();
  return text + of_harness.str();
}

/// march_parallax, which takes a function, is begun, answered and ended: any function of that name counts.
bool mentions(const std::string& text, const std::string& name) {
  return std::regex_search(text, std::regex("\\bsurfgrad_" + name + "(_[a-z0-9_]+)?\\("));
}

/// Functions that a library defines at the start of a line, without those for its own use.
std::set<std::string> functions_of_library(Language language) {
  static const std::regex c_like("(?:^|\\n)[A-Za-z][A-Za-z0-9]* surfgrad_([a-z0-9_]+)\\(");
  static const std::regex wgsl("(?:^|\\n)fn surfgrad_([a-z0-9_]+)\\(");
  const std::string text = library_text(language);
  std::set<std::string> names;
  const std::regex& definition = language == Language::wgsl ? wgsl : c_like;
  for (std::sregex_iterator i(text.begin(), text.end(), definition), end; i != end; ++i)
    if (const std::string name = (*i)[1]; !name.starts_with("detail_")) names.insert(name);
  return names;
}

std::set<std::string> functions_of_core() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SURFGRAD_SOURCE_DIR "/include/surfgrad")) {
    if (is_arithmetic(entry.path().filename().string())) continue;
    for (const Function& function : public_functions(entry.path()))
      names.insert(function.place.substr(function.place.find(':') + 1));
  }
  return names;
}

TEST(Registry, EveryFunctionOfTheCoreHasATwinInEveryLanguage) {
  const auto names = functions_of_core();
  EXPECT_GE(names.size(), 50u) << "the headers are no longer read as they are written";
  for (const Language language : languages) {
    const std::string library = library_text(language);
    for (const std::string& name : names)
      EXPECT_TRUE(mentions(library, name)) << name << " has no twin in " << name_of(language);
  }
}

TEST(Registry, EveryFunctionOfTheCoreHasACase) {
  const std::string calls = all_calls();
  for (const std::string& name : functions_of_core())
    EXPECT_TRUE(mentions(calls, name)) << name << " has no case";
}

/// Functions of fragment shaders: others with dFdx of an argument in place of a derivative.
bool takes_derivatives(const std::string& name) {
  return name == "make_frame_at" || name == "tangent_basis_at" || name == "make_frame_at_two_sided";
}

TEST(Registry, EveryFunctionOfALibraryHasACase) {
  for (const Language language : languages) {
    std::string calls;
    std::vector<const Row*> all;
    for (const Row& row : rows()) all.push_back(&row);
    // What is left of the shader behind the library.
    calls = shader_text(language, all).substr(library_text(language).size());
    const auto names = functions_of_library(language);
    EXPECT_GE(names.size(), 80u) << "the library is no longer read as it is written";
    for (const std::string& name : names)
      EXPECT_TRUE(takes_derivatives(name) || mentions(calls, name))
          << "surfgrad_" << name << " of " << name_of(language) << " has no case";
  }
}

TEST(Registry, EveryCaseHasABoundForEveryResult) {
  Random random(1);
  const ShaderInputs<float> in = random_shader_inputs(random);
  std::set<std::string> names;
  for (const Row& row : rows()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name << " stands twice";
    EXPECT_EQ(row.bound(convert<double>(in)).size(), row.in_float(in).size()) << row.name;
    EXPECT_FALSE(row.in_float(in).empty()) << row.name;
  }
}

} // namespace
} // namespace surfgrad::test
