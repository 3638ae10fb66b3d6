#include "conformance/open_results.hpp"

#include <map>

namespace surfgrad::test {
namespace {

/// What the shaders' saturated numbers reach: SURFGRAD_DETAIL_SATURATED.
constexpr double saturated_most = 2.12676466e37;

/// What Mesa's lavapipe and SwiftShader leave, in whichever language more.
const std::map<std::string, OpenResults>& all_open() {
  // clang-format off
  static const std::map<std::string, OpenResults> all{
      {"derivative_from_normal(3)", {.edges = {.near = 4, .magnitude = 4, .vanished = 2}, .largest = 128}},
      {"derivative_from_normal(2)", {.edges = {.vanished = 1}, .largest = 128}},
      {"normal_from_derivative", {.edges = {.near = 4, .magnitude = 4}, .largest = 1}},
      {"derivative_from_bicubic", {.edges = {.near = 2, .magnitude = 2}}},
      {"make_frame", {.edges = {.near = 6, .magnitude = 16, .vanished = 6}}},
      {"make_frame: normal, signs", {.edges = {.near = 18, .magnitude = 6, .vanished = 3}, .largest = 1}},
      {"mikktspace_basis", {.edges = {.near = 12, .magnitude = 12}}},
      {"tangent_basis", {.edges = {.magnitude = 24}, .largest = 1}},
      {"from_tbn", {.edges = {.magnitude = 1}}},
      {"from_perturbed_normal", {.edges = {.near = 2, .magnitude = 16}}},
      {"from_parametric_derivative", {.ill_conditioned = 0.002, .edges = {.magnitude = 28, .vanished = 28}}},
      {"from_height_derivative", {.ill_conditioned = 0.002, .edges = {.magnitude = 1, .vanished = 10}}},
      {"from_texel_derivative", {.ill_conditioned = 0.002, .edges = {.magnitude = 1, .vanished = 91}}},
      {"resolve_normal", {.edges = {.near = 6, .magnitude = 6, .vanished = 8}, .largest = 1}},
      {"transform_normal", {.ill_conditioned = 0.61, .edges = {.magnitude = 6}}},
      {"tangent_normal_matrix", {.ill_conditioned = 0.005, .edges = {.magnitude = 26, .vanished = 222}, .largest = saturated_most}},
      {"tangent_normal_matrix: third column", {.edges = {.magnitude = 8, .vanished = 39}, .largest = saturated_most}},
      {"triplanar_weights", {.largest = 1}},
      {"triplanar_weights, k = 100", {.largest = 1}},
      {"project_to_texture_space", {.ill_conditioned = 0.011, .edges = {.magnitude = 4, .vanished = 24}, .largest = saturated_most}},
      {"project_to_texture_space, skipped", {.ill_conditioned = 0.008, .edges = {.magnitude = 4, .vanished = 22}, .largest = saturated_most}},
      {"screen_offset", {.edges = {.magnitude = 16, .vanished = 50}, .largest = saturated_most}},
      {"surface_offset", {.edges = {.magnitude = 16, .vanished = 84}, .largest = 2 * saturated_most}},
      {"offset_normal", {.largest = 1}},
      {"screen_derivatives", {.ill_conditioned = 0.107, .edges = {.vanished = 114}, .largest = saturated_most}},
      {"texture_lod", {.edges = {.near = 6, .magnitude = 36}}},
      {"make_frame(normal)", {.edges = {.near = 10, .magnitude = 6, .vanished = 72}, .largest = 1}},
      {"make_frame: back faces SAME", {.edges = {.near = 20, .magnitude = 23, .vanished = 9}}},
      {"make_frame: back faces MIRROR", {.edges = {.near = 24, .magnitude = 22, .vanished = 9}}},
      {"make_frame: back faces FLIP", {.edges = {.near = 24, .magnitude = 22, .vanished = 9}}},
      {"resolve_mikktspace", {.edges = {.near = 6, .magnitude = 58, .vanished = 16, .overflown = 10}, .largest = 1}},
      {"tangent_normal_matrix: scale matrix", {.ill_conditioned = 0.611, .edges = {.magnitude = 8, .vanished = 93}, .largest = saturated_most}},
      {"normalize_or_zero", {.edges = {.near = 9, .magnitude = 6}, .largest = 1}},
      {"saturated", {.edges = {.vanished = 11}}},
      {"max_abs, cross", {.edges = {.vanished = 2}}},
      {"cofactor", {.ill_conditioned = 0.037}},
      {"decal_gradient", {.edges = {.magnitude = 1}}},
      {"box_decal", {.edges = {.near = 2}}},
      {"cone_decal", {.edges = {.near = 2}}},
      {"wedge_decal", {.edges = {.near = 2, .magnitude = 10}}},
      {"cone_decal: scale-free", {.edges = {.near = 2}}},
      {"wedge_decal: scale-free", {.edges = {.near = 2, .magnitude = 9}}},
      {"sphere_decal", {.edges = {.near = 8}}},
      {"capsule_decal", {.edges = {.near = 6, .magnitude = 6}}},
      {"decal_gradient_from_normal", {.edges = {.near = 2, .magnitude = 12}}},
      {"march_parallax", {.edges = {.magnitude = 24}}},
      {"march_parallax: in one statement", {.edges = {.magnitude = 24}}},
      {"hex_tiles", {.ill_conditioned = 0.002, .edges = {.near = 6, .magnitude = 3}}},
      {"hex_tiles: rotation", {.ill_conditioned = 0.002, .edges = {.near = 6, .magnitude = 3}}},
      {"hex_tiles: moved", {.ill_conditioned = 0.002, .edges = {.near = 12, .magnitude = 1}}},
      {"hex_weights", {.largest = 1}},
      {"hex_weights: exponent", {.largest = 1}},
      {"roughness_from_moments", {.largest = 1}},
      {"sin_cos_turns", {.largest = 1}},
      {"gradient_by_differences", {.ill_conditioned = 0.359, .edges = {.magnitude = 1}}},
      {"gradient_by_differences: macro", {.ill_conditioned = 0.359, .edges = {.magnitude = 1}}},
      {"gradient_by_forward_differences", {.ill_conditioned = 0.005}},
      {"gradient_by_forward_differences: macro", {.ill_conditioned = 0.005}},
      {"simplex", {.ill_conditioned = 0.001}},
      {"simplex: moved", {.edges = {.near = 5}}},
      {"worley: f2 - f1", {.ill_conditioned = 0.016}},
      {"power", {.edges = {.vanished = 14}, .largest = saturated_most}},
      {"octave_visibility", {.ill_conditioned = 0.009, .largest = 1}},
      {"basis_noise", {.edges = {.near = 5}}},
      {"fractal_sum of SIMPLEX", {.ill_conditioned = 0.717, .edges = {.near = 2}}},
      {"fractal_sum of WORLEY_F1", {.ill_conditioned = 0.001}},
      {"fractal_sum of WORLEY_F2_MINUS_F1", {.ill_conditioned = 0.052}},
      {"turbulence", {.ill_conditioned = 0.001}},
      {"turbulence of SIMPLEX", {.ill_conditioned = 0.718, .edges = {.near = 18}}},
      {"turbulence of WORLEY_F1", {.ill_conditioned = 0.001}},
      {"turbulence of WORLEY_F2_MINUS_F1", {.ill_conditioned = 0.054}},
      {"ridged", {.ill_conditioned = 0.001}},
      {"ridged of SIMPLEX", {.ill_conditioned = 0.67, .edges = {.near = 18}}},
      {"ridged of WORLEY_F1", {.ill_conditioned = 0.001}},
      {"ridged of WORLEY_F2_MINUS_F1", {.ill_conditioned = 0.054}},
  };
  // clang-format on
  return all;
}

} // namespace

OpenResults open_results(const Row& row) {
  const auto found = all_open().find(row.name);
  return found == all_open().end() ? OpenResults{} : found->second;
}

} // namespace surfgrad::test
