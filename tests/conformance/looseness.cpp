/// The operations that Vulkan rounds more loosely than C++ on the way to each row's result. The registry test
/// compares these statements with what the compiled rows hold.

#include "conformance/rows.hpp"

#include <map>

namespace surfgrad::test {
namespace {

/// Roundings as the row's bound counts them; then divisions, inverse roots and roots.
const std::map<std::string, Looseness>& looseness_of() {
  static const std::map<std::string, Looseness> all{
      {"derivative_from_normal(3)", {1, 1, 0, 0}},
      {"derivative_from_normal(2)", {2, 0, 1, 0}},
      {"normal_from_derivative", {4, 0, 1, 0}},
      {"normalize_or_zero", {3, 0, 1, 0}},
      {"reciprocal_or_zero", {0.5, 1, 0, 0}},
      // sigma takes the unit normal twice.
      {"make_frame", {10, 0, 2, 0}},
      {"make_frame: normal, signs", {3, 0, 1, 0}},
      {"make_frame(normal)", {3, 0, 1, 0}},
      {"make_frame: back faces SAME", {3, 0, 1, 0}},
      {"make_frame: back faces MIRROR", {3, 0, 1, 0}},
      {"make_frame: back faces FLIP", {3, 0, 1, 0}},
      {"make_frame_at", {3, 0, 1, 0}},
      {"make_frame_at: back faces MIRROR", {3, 0, 1, 0}},
      {"make_frame_at: back faces FLIP", {3, 0, 1, 0}},
      {"mikktspace_basis", {4, 0, 1, 0}},
      // What vectors are divided by before they are normalised cancels.
      {"tangent_basis", {8, 0, 1, 0}},
      {"tangent_basis_at", {8, 0, 1, 0}},
      {"offset_normal", {6, 0, 1, 0}},
      {"resolve_normal", {4, 0, 1, 0}},
      {"resolve_mikktspace", {4, 0, 1, 0}},
      {"from_perturbed_normal", {4, 1, 1, 0}},
      {"decal_gradient_from_normal", {11, 1, 1, 0}},
      // The inverse magnitudes of two derivatives cancel against the determinant that they enter.
      {"from_parametric_derivative", {8, 1, 0, 0}},
      {"from_height_derivative", {8, 1, 0, 0}},
      {"from_texel_derivative", {8, 1, 0, 0}},
      {"screen_offset", {8, 1, 0, 0}},
      {"surface_offset", {10, 1, 0, 0}},
      {"project_to_texture_space", {16, 2, 0, 0}},
      {"project_to_texture_space, skipped", {16, 1, 0, 0}},
      // Cofactors hold the inverse size of the scale twice.
      {"tangent_normal_matrix", {16, 3, 0, 0}},
      {"tangent_normal_matrix: third column", {16, 2, 0, 0}},
      {"tangent_normal_matrix: scale matrix", {16, 2, 0, 0}},
      // The slope of depth, and w twice; the plane's own length cancels.
      {"screen_derivatives", {16, 3, 0, 0}},
      // The sum of the weights: what the largest is divided by cancels.
      {"triplanar_weights", {17, 1, 0, 0}},
      {"triplanar_weights, k = 100", {405, 1, 0, 0}},
      // grad_s is the inverse of twice a size, one rounding as a bound: the others count four and more.
      {"box_decal", {1, 1, 0, 0}},
      // In falloff: the distance, its share of the radius, the fade.
      {"cone_decal", {12, 2, 0, 1}},
      {"wedge_decal", {12, 2, 0, 1}},
      {"cone_decal: scale-free", {12, 2, 0, 1}},
      {"wedge_decal: scale-free", {12, 2, 0, 1}},
      {"sphere_decal", {8, 2, 0, 1}},
      {"capsule_decal", {8, 2, 0, 1}},
      // The height of a step and the share of the crossing within it.
      {"march_parallax", {4, 2, 0, 0}},
      {"march_parallax: in one statement", {4, 2, 0, 0}},
      {"hex_tiles", {4, 1, 0, 0}},
      {"hex_tiles: rotation", {4, 1, 0, 0}},
      {"hex_tiles: moved", {4, 1, 0, 0}},
      // The sine of a slope, the sum of the weights and what the largest is divided by.
      {"hex_weights", {16, 3, 0, 1}},
      {"hex_weights: exponent", {16, 3, 0, 1}},
      {"roughness_from_moments", {2, 0, 0, 1}},
      {"gradient_by_differences", {3, 1, 0, 0}},
      {"gradient_by_forward_differences", {6, 1, 0, 0}},
      {"gradient_by_differences: macro", {3, 1, 0, 0}},
      {"gradient_by_forward_differences: macro", {6, 1, 0, 0}},
      // A distance and the direction that is divided by it.
      {"worley", {4, 0, 0, 1}},
      {"worley: f2 - f1", {8, 1, 0, 1}},
      {"worley: moved", {4, 0, 0, 1}},
      {"fractal_sum of WORLEY_F1", {4, 0, 0, 1}},
      {"fractal_sum of WORLEY_F2_MINUS_F1", {8, 1, 0, 1}},
      {"turbulence of WORLEY_F1", {4, 0, 0, 1}},
      {"turbulence of WORLEY_F2_MINUS_F1", {8, 1, 0, 1}},
      {"ridged of WORLEY_F1", {4, 0, 0, 1}},
      {"ridged of WORLEY_F2_MINUS_F1", {8, 1, 0, 1}},
  };
  return all;
}

} // namespace

void loosen(std::vector<Row>& rows) {
  for (Row& row : rows)
    if (const auto found = looseness_of().find(row.name); found != looseness_of().end())
      row.looseness = found->second;
}

} // namespace surfgrad::test
