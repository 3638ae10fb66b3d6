#include "conformance/signatures.hpp"

#include "support/public_functions.hpp"

#include <filesystem>
#include <map>
#include <regex>
#include <stdexcept>
#include <vector>

namespace surfgrad::test {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \n") - first + 1);
}

/// At commas outside all brackets.
std::vector<std::string> split_parameters(const std::string& text) {
  std::vector<std::string> parts;
  int depth = 0;
  std::string part;
  for (const char c : text) {
    if (c == '(' || c == '<' || c == '{' || c == '[') ++depth;
    if (c == ')' || c == '>' || c == '}' || c == ']') --depth;
    if (c == ',' && depth == 0) {
      parts.push_back(trimmed(part));
      part.clear();
    } else {
      part += c;
    }
  }
  if (!trimmed(part).empty()) parts.push_back(trimmed(part));
  return parts;
}

std::string joined(const std::string& name, const std::vector<std::string>& types, std::size_t count) {
  std::string text = name + "(";
  for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + types[i];
  return text + ")";
}

/// GLSL's word for a type of any of the languages.
std::string type_in_glsl(const std::string& word) {
  static const std::map<std::string, std::string> words{
      {"f32", "float"},
      {"i32", "int"},
      {"u32", "uint"},
      {"float2", "vec2"},
      {"float3", "vec3"},
      {"float4", "vec4"},
      {"vec2f", "vec2"},
      {"vec3f", "vec3"},
      {"vec4f", "vec4"},
      {"int3", "ivec3"},
      {"vec3i", "ivec3"},
      {"float3x3", "mat3"},
      {"float4x4", "mat4"},
      {"mat3x3f", "mat3"},
      {"mat4x4f", "mat4"},
      {"array<vec2f, 3>", "vec2[3]"},
      {"T", "float"},
      {"vec2<T>", "vec2"},
      {"vec3<T>", "vec3"},
      {"mat3<T>", "mat3"},
      {"mat4<T>", "mat4"},
      {"mask_t<T>", "bool"},
      {"index_t<T>", "int"},
      {"bits_t<T>", "uint"},
      {"BackFaces", "int"},
      {"PlaneAxis", "int"},
      {"WorleyKind", "int"},
      {"ConeGradient", "int"},
      {"std::uint32_t", "uint"},
      {"Hash", "uint"}, // of the lattice: shaders take the start of a moved one
      {"Basis", "int"}, // of a sum: one of a list, shaders take no functions
  };
  if (const auto found = words.find(word); found != words.end()) return found->second;
  // Structures: Name<T> and Name of C++ are SurfgradName.
  static const std::regex structure("([A-Z][A-Za-z]+)(<T>)?");
  std::smatch match;
  if (word.starts_with("Surfgrad") || !std::regex_match(word, match, structure)) return word;
  return "Surfgrad" + match[1].str();
}

/// The type of "type name", "type name[3]" or "name: type".
std::string type_of_shader_parameter(const std::string& parameter, bool wgsl) {
  if (wgsl) return type_in_glsl(trimmed(parameter.substr(parameter.find(':') + 1)));
  const std::size_t space = parameter.find(' ');
  const std::size_t bracket = parameter.find('[');
  return type_in_glsl(parameter.substr(0, space)) +
         (bracket == std::string::npos ? "" : parameter.substr(bracket));
}

struct CoreParameter {
  std::string type;
  bool has_default;
};
CoreParameter core_parameter(std::string text) {
  const std::size_t equals = text.find('=');
  const bool has_default = equals != std::string::npos;
  text = trimmed(text.substr(0, equals));
  static const std::regex array("const (.*) \\(&[a-z_]+\\)(\\[[0-9]+\\])");
  std::smatch match;
  if (std::regex_match(text, match, array)) return {type_in_glsl(match[1]) + match[2].str(), has_default};
  text = text.substr(0, text.find_last_of(' ')); // the name
  text = std::regex_replace(text, std::regex("^const |&$"), "");
  text = std::regex_replace(text, std::regex("value_t<T>"), "T");
  return {type_in_glsl(text), has_default};
}

/// Functions that take functions: shaders take what these would give.
const std::map<std::string, Signatures>& taken_apart() {
  static const std::map<std::string, Signatures> all{
      {"march_parallax",
       {"march_parallax_begin(vec2, vec2, int)", "march_parallax_asks(SurfgradParallaxMarch)",
        "march_parallax_at(SurfgradParallaxMarch)", "march_parallax_answer(SurfgradParallaxMarch, float)",
        "march_parallax_end(SurfgradParallaxMarch)"}},
      {"gradient_by_differences", {"gradient_by_differences(vec3, float, vec3, vec3)"}},
      {"gradient_by_forward_differences", {"gradient_by_forward_differences(vec3, float, vec3, float)"}},
  };
  return all;
}

} // namespace

Signatures signatures_of_library(Language language) {
  const bool wgsl = language == Language::wgsl;
  static const std::regex c_like("\n[A-Za-z][A-Za-z0-9]* surfgrad_([a-z0-9_]+)\\(");
  static const std::regex of_wgsl("\nfn surfgrad_([a-z0-9_]+)\\(");
  const std::string text = library_text(language);
  Signatures signatures;
  for (std::sregex_iterator i(text.begin(), text.end(), wgsl ? of_wgsl : c_like), end; i != end; ++i) {
    const std::string name = (*i)[1];
    if (name.starts_with("detail_")) continue;
    const std::size_t open = static_cast<std::size_t>(i->position() + i->length()) - 1;
    const std::size_t close = closing_parenthesis(text, open);
    std::vector<std::string> types;
    for (const std::string& parameter : split_parameters(text.substr(open + 1, close - open - 1)))
      types.push_back(type_of_shader_parameter(parameter, wgsl));
    if (!signatures.insert(joined(name, types, types.size())).second)
      throw std::runtime_error(name + " is defined twice");
  }
  return signatures;
}

std::set<std::string> macros_of_library(Language language) {
  static const std::regex macro("\n#define (SURFGRAD_[A-Z_0-9]+)\\(");
  const std::string text = library_text(language);
  std::set<std::string> names;
  for (std::sregex_iterator i(text.begin(), text.end(), macro), end; i != end; ++i) names.insert((*i)[1]);
  return names;
}

Signatures signatures_of_core() {
  Signatures signatures;
  for (const auto& entry : std::filesystem::directory_iterator(SURFGRAD_SOURCE_DIR "/include/surfgrad")) {
    if (is_arithmetic(entry.path().filename().string())) continue;
    for (const Function& function : public_functions(entry.path())) {
      const std::string name = function.place.substr(function.place.find(':') + 1);
      if (const auto found = taken_apart().find(name); found != taken_apart().end()) {
        signatures.insert(found->second.begin(), found->second.end());
        continue;
      }
      std::vector<std::string> types;
      std::size_t required = 0;
      for (const std::string& text : split_parameters(function.parameters)) {
        const CoreParameter parameter = core_parameter(text);
        types.push_back(parameter.type);
        if (!parameter.has_default) required = types.size();
      }
      for (std::size_t count = required; count <= types.size(); ++count)
        signatures.insert(joined(name, types, count));
    }
  }
  return signatures;
}

const Signatures& spelt_out_in_shaders() {
  static const Signatures all{
      "fractal_sum(vec3)",
      "fractal_sum(vec3, SurfgradFractal)",
      "turbulence(vec3)",
      "turbulence(vec3, SurfgradFractal)",
      "ridged(vec3)",
      "ridged(vec3, SurfgradFractal)",
      "hex_tiles(vec2, float, float)",
      "hex_tiles(vec2, float, float, vec2)",
      "hex_weights(SurfgradHexTiles, vec2[3], float)",
  };
  return all;
}

const Signatures& shaders_own() {
  static const Signatures all{
      // What C++ has in vec.hpp and scalar.hpp and languages lack.
      "cross(vec2, vec2)",
      "cofactor(mat3)",
      "max_abs(vec2)",
      "max_abs(vec3)",
      "reciprocal_or_zero(float)",
      "saturated(float)",
      "saturated(vec2)",
      "saturated(vec3)",
      "normalize_or_zero(vec3)",
      // A resolve for vertex tangents alone, with one normalisation.
      "resolve_mikktspace(vec3, vec3, float, vec2)",
      // Sums of octaves in parts: shaders cannot take the function of a basis.
      "basis_noise(vec3, int, uint)",
      "octave_visibility(float)",
      "turbulence_octave(SurfgradNoise)",
      "ridged_octave(SurfgradNoise)",
      "add_octave(SurfgradNoise, SurfgradNoise, float, float, float)",
      // Derivatives across pixels.
      "make_frame_at(vec3, vec3)",
      "make_frame_at(vec3, vec3, bool, int)",
      "tangent_basis_at(SurfgradFrame, vec2)",
  };
  return all;
}

} // namespace surfgrad::test
