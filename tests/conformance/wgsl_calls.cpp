#include "conformance/rows.hpp"

#include <map>

namespace surfgrad::test {
namespace {

/// What a function is called with so many arguments, and what they leave to be said.
struct Spelling {
  const char* name;
  const char* rest = "";
};

using Overloads = std::map<std::pair<std::string, int>, Spelling>;

const Overloads& overloads() {
  static const Overloads all{
      {{"make_frame", 1}, {"make_frame_normal"}},
      {{"make_frame", 5}, {"make_frame_two_sided"}},
      {{"make_frame_at", 4}, {"make_frame_at_two_sided"}},
      {{"rebase_frame", 4}, {"rebase_frame_moved"}},
      {{"triplanar_weights", 1}, {"triplanar_weights", ", 3.0"}},
      {{"triplanar_coordinates", 1}, {"triplanar_coordinates", ", SURFGRAD_LISTING_13"}},
      {{"planar_gradient", 2}, {"planar_gradient", ", SURFGRAD_LISTING_13"}},
      {{"triplanar_gradient", 4}, {"triplanar_gradient", ", SURFGRAD_LISTING_13"}},
      {{"from_triplanar", 5}, {"from_triplanar", ", SURFGRAD_LISTING_13"}},
      {{"project_to_texture_space", 5}, {"project_to_texture_space", ", false"}},
      {{"cone_decal", 5}, {"cone_decal", ", SURFGRAD_CONE_GRADIENT_EXACT"}},
      {{"wedge_decal", 6}, {"wedge_decal", ", SURFGRAD_CONE_GRADIENT_EXACT"}},
      {{"perlin", 2}, {"perlin_moved"}},
      {{"simplex", 2}, {"simplex_moved"}},
      {{"worley", 1}, {"worley", ", SURFGRAD_WORLEY_KIND_F1"}},
      {{"worley", 3}, {"worley_moved"}},
      {{"fractal_sum", 3}, {"fractal_sum", ", SURFGRAD_BASIS_PERLIN"}},
      {{"turbulence", 3}, {"turbulence", ", SURFGRAD_BASIS_PERLIN"}},
      {{"ridged", 3}, {"ridged", ", SURFGRAD_BASIS_PERLIN"}},
      {{"hex_weights", 2}, {"hex_weights", ", 7.0, 1.5"}},
      {{"hex_tiles", 1}, {"hex_tiles", ", 1.0, 0.5, v2(1.0, 1.0), hex_origin(0u, v2(0.0, 0.0))"}},
      {{"hex_tiles", 2}, {"hex_tiles", ", 0.5, v2(1.0, 1.0), hex_origin(0u, v2(0.0, 0.0))"}},
  };
  return all;
}

/// Overloads by type: their names.
const std::map<std::string, std::string>& typed_names() {
  static const std::map<std::string, std::string> all{
      {"derivative_from_normal(vec2)", "derivative_from_normal_vec2"},
      {"scale_bump(float, vec2)", "scale_bump_vec2"},
      {"tangent_normal_matrix(mat3, vec3, vec3, vec3, vec3)", "tangent_normal_matrix_vec3"},
      {"saturated(vec2)", "saturated_vec2"},
      {"saturated(vec3)", "saturated_vec3"},
      {"max_abs(vec2)", "max_abs_vec2"},
  };
  return all;
}

/// Overloads by type: what the rows call instead.
const std::map<std::string, std::string>& by_type() {
  static const std::map<std::string, std::string> all{
      {"derivative_from_normal(2)", "put2(surfgrad_derivative_from_normal_vec2($xy_normal))"},
      {"scale_bump(2)", "put2(surfgrad_scale_bump_vec2($scale, $deriv))"},
      {"tangent_normal_matrix",
       "put_columns(surfgrad_tangent_normal_matrix_vec3($rotation, $tangent, $dp_du, "
       "$dp_dv, $frame.normal), 0, 2)"},
      {"tangent_normal_matrix: third column", "put_columns(surfgrad_tangent_normal_matrix_vec3($rotation, "
                                              "$tangent, $dp_du, $dp_dv, $frame.normal), 2, 3)"},
      {"saturated",
       "put_vectors(v3(surfgrad_saturated($scale), 0.0, 0.0) + surfgrad_saturated_vec3($gradient), "
       "surfgrad_saturated_vec2($deriv))"},
      {"max_abs, cross", "put3(v3(surfgrad_max_abs($gradient), surfgrad_max_abs_vec2($deriv), "
                         "surfgrad_cross($deriv, $deriv_y)))"},
  };
  return all;
}

/// The parenthesis that closes the one at `open`, and how many arguments stand between them.
struct Arguments {
  std::size_t end;
  int count;
};
Arguments arguments_from(const std::string& text, std::size_t open) {
  int depth = 0;
  int count = 1;
  for (std::size_t i = open;; ++i) {
    if (text.at(i) == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return {i, count};
    if (text[i] == ',' && depth == 1) ++count;
  }
}

} // namespace

std::string wgsl_name(const std::string& signature) {
  if (const auto found = typed_names().find(signature); found != typed_names().end()) return found->second;
  const std::size_t open = signature.find('(');
  const std::string name = signature.substr(0, open);
  const auto found = overloads().find({name, arguments_from(signature, open).count});
  if (found == overloads().end()) return name;
  return found->second.rest[0] == 0 ? found->second.name : "";
}

std::string wgsl_call(const Row& row) {
  if (const auto found = by_type().find(row.name); found != by_type().end()) return found->second;
  std::string text = row.call;
  const std::string prefix = "surfgrad_";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at + 1)) {
    const std::size_t open = text.find('(', at);
    const std::string name = text.substr(at + prefix.size(), open - at - prefix.size());
    const Arguments arguments = arguments_from(text, open);
    const auto found = overloads().find({name, arguments.count});
    if (found == overloads().end()) continue;
    text.insert(arguments.end, found->second.rest);
    text.replace(at + prefix.size(), name.size(), found->second.name);
  }
  return text;
}

} // namespace surfgrad::test
