/// The functions of the paper's listings: the C++ side and the documented bounds are those of the core's
/// own tests.

#include "conformance/rows.hpp"
#include "support/core_functions.hpp"

#include <map>
#include <stdexcept>

namespace surfgrad::test {
namespace {

const std::map<std::string, std::string>& shader_calls() {
  static const std::map<std::string, std::string> calls{
      {"scale_bump", "put3(surfgrad_scale_bump($scale, $gradient))"},
      {"derivative_from_normal(3)", "put2(surfgrad_derivative_from_normal($tangent_normal))"},
      {"derivative_from_normal(2)", "put2(surfgrad_derivative_from_normal($xy_normal))"},
      {"normal_from_derivative", "put3(surfgrad_normal_from_derivative($deriv))"},
      {"derivative_from_heights", "put2(surfgrad_derivative_from_heights($height, $height_x, $height_y))"},
      {"derivative_from_bicubic", "put2(surfgrad_derivative_from_bicubic($texels, $fraction))"},
      {"make_frame", "put_sigma(surfgrad_make_frame($raw_normal, frame_dp_dx, frame_dp_dy))"},
      {"make_frame: normal, signs",
       "put_signs(surfgrad_make_frame($raw_normal, frame_dp_dx, frame_dp_dy, ($sign < $scale), "
       "SURFGRAD_BACK_FACES_FLIP))"},
      {"rebase_frame", "put_sigma(surfgrad_rebase_frame($frame, $direction))"},
      {"mikktspace_basis", "put_basis(surfgrad_mikktspace_basis($raw_normal, $raw_tangent, $sign))"},
      {"tangent_basis", "put_basis(surfgrad_tangent_basis($frame, $dst_dx, $dst_dy))"},
      {"from_tbn", "put3(surfgrad_from_tbn($deriv, $tangent, $bitangent))"},
      {"from_perturbed_normal", "put3(surfgrad_from_perturbed_normal(frame_normal, $perturbed))"},
      {"from_parametric_derivative",
       "put3(surfgrad_from_parametric_derivative(frame_normal, $dp_du, $dp_dv, $dh_duv))"},
      {"from_height_derivative", "put3(surfgrad_from_height_derivative($frame, $dh_duv))"},
      {"from_texel_derivative",
       "put3(surfgrad_from_texel_derivative($frame, $dh_duv, $size, $dst_dx, $dst_dy))"},
      {"from_volume_gradient", "put3(surfgrad_from_volume_gradient(frame_normal, $gradient))"},
      {"resolve_normal", "put3(surfgrad_resolve_normal($frame, $gradient))"},
      {"flip_from_mirror", "put3(surfgrad_flip_from_mirror($direction, frame_normal))"},
      {"transform_normal", "put3(surfgrad_transform_normal($matrix, $gradient))"},
      {"tangent_normal_matrix", "put_columns(surfgrad_tangent_normal_matrix($rotation, $tangent, $dp_du, "
                                "$dp_dv, frame_normal), 0, 2)"},
      {"tangent_normal_matrix: third column", "put_columns(surfgrad_tangent_normal_matrix($rotation, "
                                              "$tangent, $dp_du, $dp_dv, frame_normal), 2, 3)"},
      {"triplanar_weights", "put3(surfgrad_triplanar_weights(frame_normal))"},
      {"triplanar_weights, k = 100", "put3(surfgrad_triplanar_weights(frame_normal, 100.0))"},
      {"triplanar_coordinates",
       "put_coordinates(surfgrad_triplanar_coordinates($position, convention(SURFGRAD_HANDEDNESS_RIGHT, "
       "SURFGRAD_TEXTURE_ORIGIN_LOWER_LEFT, SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN)))"},
      {"planar_gradient",
       "put3(surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_X, $deriv, convention(SURFGRAD_HANDEDNESS_LEFT, "
       "SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT, SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN)))"},
      {"triplanar_gradient", "put3(surfgrad_triplanar_gradient($weights, $deriv, $deriv_y, $deriv_z))"},
      {"from_triplanar", "put3(surfgrad_from_triplanar(frame_normal, $weights, $deriv, $deriv_y, $deriv_z, "
                         "convention(SURFGRAD_HANDEDNESS_LEFT, SURFGRAD_TEXTURE_ORIGIN_LOWER_LEFT, "
                         "SURFGRAD_TRIPLANAR_PLANES_GOLUBEV)))"},
      {"project_to_texture_space",
       "put2(surfgrad_project_to_texture_space($frame, $direction, $dst_dx, $dst_dy, $bump_scale))"},
      {"project_to_texture_space, skipped",
       "put2(surfgrad_project_to_texture_space($frame, $direction, $dst_dx, $dst_dy, $bump_scale, true))"},
      {"screen_offset", "put2(surfgrad_screen_offset($dst_dx, $dst_dy, $texture_offset))"},
      {"surface_offset", "put3(surfgrad_surface_offset($frame, $dst_dx, $dst_dy, $texture_offset))"},
      {"offset_normal", "put3(surfgrad_offset_normal($frame, $dn_dx, $dn_dy, $deriv))"},
      {"screen_derivatives",
       "put_screen(surfgrad_screen_derivatives($position, frame_normal, $world_from_screen, $x, $y))"},
      {"projected_derivatives",
       "put_texture(surfgrad_projected_derivatives($tangent, $bitangent, $dn_dx, $dn_dy))"},
      {"texture_lod", "put1(surfgrad_texture_lod($dst_dx, $dst_dy, $size))"},
  };
  return calls;
}

/// What Vulkan's logarithms and powers add.
double api_error(const std::string& name, const CoreInputs<double>& in) {
  // A weight is a power of a ratio up to 1, over a sum of such: the error of r^k is largest at r = 1.
  if (name == "triplanar_weights") return 2 * vulkan_pow_error(1, 3);
  if (name == "triplanar_weights, k = 100") return 2 * vulkan_pow_error(1, 100);
  if (name == "texture_lod") return 0.5 * vulkan_log2_error(2 * texture_lod(in.dst_dx, in.dst_dy, in.size));
  throw std::out_of_range("no power in " + name);
}

/// Rows whose functions clamp, or count a length by its inverse, which is 0 for Inf.
constexpr const char* clamping[] = {"derivative_from_normal(3)",
                                    "derivative_from_normal(2)",
                                    "make_frame",
                                    "make_frame: normal, signs",
                                    "make_frame(normal)",
                                    "resolve_mikktspace",
                                    "make_frame: back faces SAME",
                                    "make_frame: back faces MIRROR",
                                    "make_frame: back faces FLIP",
                                    "from_parametric_derivative",
                                    "from_height_derivative",
                                    "from_texel_derivative",
                                    "resolve_normal",
                                    "tangent_normal_matrix",
                                    "tangent_normal_matrix: third column",
                                    "tangent_normal_matrix: scale matrix",
                                    "project_to_texture_space",
                                    "project_to_texture_space, skipped",
                                    "screen_offset",
                                    "surface_offset",
                                    "screen_derivatives",
                                    "saturated",
                                    "max_abs, cross"};

} // namespace

void add_listing_rows(std::vector<Row>& rows) {
  for_each_core_function([&](const char* name, int, auto call, auto bound) {
    const std::string key = name;
    if (!shader_calls().contains(key)) throw std::out_of_range("no shader call for " + key);
    std::string text = shader_calls().at(key);
    // The frame's own parts: its normal and derivatives, where a function takes no frame.
    for (const char* part : {"frame_normal", "frame_dp_dx", "frame_dp_dy"})
      for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 12))
        text.replace(at, std::string_view(part).size(),
                     std::string("$frame.") + std::string(std::string_view(part).substr(6)));
    rows.push_back(make_row(
        key, text, [call](const auto& in) { return call(in.core); },
        [bound](const ShaderInputs<double>& in) { return bound(in.core); }));
    if (key.starts_with("triplanar_weights") || key == "texture_lod")
      rows.back().of_powers = [key](const ShaderInputs<double>& in) {
        return std::vector<double>(key == "texture_lod" ? 1 : 3, api_error(key, in.core));
      };
  });

  // What the core's table leaves to others: overloads and the frame without derivatives.
  rows.push_back(make_row(
      "make_frame(normal)", "put_frame(surfgrad_make_frame($raw_normal))",
      [](const auto& in) { return flat(make_frame(in.core.raw_normal)); },
      [](const ShaderInputs<double>&) {
        std::array<double, 11> eps{};
        eps[0] = eps[1] = eps[2] = 3;
        return eps;
      }));
  for (const auto& [mode, number] :
       {std::pair{BackFaces::same, "SAME"}, {BackFaces::mirror, "MIRROR"}, {BackFaces::flip, "FLIP"}})
    rows.push_back(make_row(
        std::string("make_frame: back faces ") + number,
        std::string("put_frame(surfgrad_make_frame($raw_normal, $frame.dp_dx, $frame.dp_dy, false, "
                    "SURFGRAD_BACK_FACES_") +
            number + "))",
        [mode = mode](const auto& in) {
          return flat(make_frame(in.core.raw_normal, in.core.frame.dp_dx, in.core.frame.dp_dy, false, mode));
        },
        [](const ShaderInputs<double>& in) {
          return frame_bound(3, normalize_or_zero(in.core.raw_normal), in.core.frame.dp_dx,
                             in.core.frame.dp_dy);
        }));
  rows.push_back(make_row(
      "rebase_frame: moved", "put_frame(surfgrad_rebase_frame($frame, $direction, $dp_du, $dp_dv))",
      [](const auto& in) {
        return flat(rebase_frame(in.core.frame, in.core.direction, in.core.dp_du, in.core.dp_dv));
      },
      [](const ShaderInputs<double>& in) {
        return frame_bound(0, in.core.direction, in.core.dp_du, in.core.dp_dv);
      }));
  rows.push_back(make_row(
      "resolve_mikktspace", "put3(surfgrad_resolve_mikktspace($raw_normal, $raw_tangent, $sign, $deriv))",
      [](const auto& in) {
        const auto basis = mikktspace_basis(in.core.raw_normal, in.core.raw_tangent, in.core.sign);
        return flat(resolve_normal(make_frame(in.core.raw_normal),
                                   from_tbn(in.core.deriv, basis.tangent, basis.bitangent)));
      },
      [](const ShaderInputs<double>& in) {
        // The terms of n - deriv.x t - deriv.y b round by their own sizes, and may cancel.
        const vec3<double> n = in.core.raw_normal;
        const vec3<double> t = in.core.deriv.x * in.core.raw_tangent;
        const vec3<double> b = in.core.deriv.y * cross(n, in.core.raw_tangent);
        const double terms =
            length(n) + length(t) + 2 * std::abs(in.core.deriv.y) * length(n) * length(in.core.raw_tangent);
        const double sum = length(n - t - (in.core.sign > 0 ? 1.0 : -1.0) * b);
        return all_within<3>(4 * std::max(1.0, terms / sum));
      }));
  rows.push_back(make_row(
      "scale_bump(2)", "put2(surfgrad_scale_bump($scale, $deriv))",
      [](const auto& in) { return flat(scale_bump(in.core.scale, in.core.deriv)); },
      [](const ShaderInputs<double>& in) {
        const vec2<double> d = in.core.scale * in.core.deriv;
        return std::array{0.5 * std::abs(d.x), 0.5 * std::abs(d.y)};
      }));
  rows.push_back(make_row(
      "tangent_normal_matrix: scale matrix",
      "put_columns(surfgrad_tangent_normal_matrix($rotation, $matrix, $dp_du, $dp_dv, $frame.normal), 2, 3)",
      [](const auto& in) {
        const auto m = tangent_normal_matrix(in.core.rotation, in.core.matrix, in.core.dp_du, in.core.dp_dv,
                                             in.core.frame.normal);
        return std::array{m.x.z, m.y.z, m.z.z};
      },
      [](const ShaderInputs<double>& in) {
        const double m = magnitude(in.core.matrix);
        // The side is a decision: nothing holds where the determinant is lost in rounding.
        const bool lost = std::abs(determinant(in.core.matrix)) < 1e-5 * m * m * m;
        return all_within<3>(lost ? undecided : 16 * m * m);
      }));
  rows.push_back(make_row(
      "triplanar_coordinates: listing 13", "put_coordinates(surfgrad_triplanar_coordinates($position))",
      [](const auto& in) { return flat(triplanar_coordinates(in.core.position)); },
      [](const ShaderInputs<double>&) { return all_within<6>(0); }));
  const auto planar = [&](PlaneAxis axis, const char* word, TriplanarConvention convention,
                          const char* convention_call) {
    rows.push_back(make_row(
        std::string("planar_gradient: ") + word +
            (convention_call != nullptr ? ", all conventions turned" : ""),
        std::string("put3(surfgrad_planar_gradient(SURFGRAD_PLANE_AXIS_") + word + ", $deriv" +
            (convention_call != nullptr ? convention_call : "") + "))",
        [axis, convention](const auto& in) { return flat(planar_gradient(axis, in.core.deriv, convention)); },
        [](const ShaderInputs<double>&) { return all_within<3>(0); }));
  };
  const TriplanarConvention turned{Handedness::right, TextureOrigin::upper_left, TriplanarPlanes::mikkelsen};
  const char* turned_call = ", convention(SURFGRAD_HANDEDNESS_RIGHT, SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT, "
                            "SURFGRAD_TRIPLANAR_PLANES_MIKKELSEN)";
  for (const auto& [axis, word] : {std::pair{PlaneAxis::x, "X"}, {PlaneAxis::y, "Y"}, {PlaneAxis::z, "Z"}}) {
    planar(axis, word, {}, nullptr);
    planar(axis, word, turned, turned_call);
  }
  rows.push_back(make_row(
      "triplanar_gradient: golubev",
      "put3(surfgrad_triplanar_gradient($weights, $deriv, $deriv_y, $deriv_z, "
      "convention(SURFGRAD_HANDEDNESS_LEFT, SURFGRAD_TEXTURE_ORIGIN_UPPER_LEFT, "
      "SURFGRAD_TRIPLANAR_PLANES_GOLUBEV)))",
      [](const auto& in) {
        return flat(
            triplanar_gradient(in.core.weights, in.core.deriv, in.core.deriv_y, in.core.deriv_z,
                               {.origin = TextureOrigin::upper_left, .planes = TriplanarPlanes::golubev}));
      },
      [](const ShaderInputs<double>& in) {
        const auto a = [](vec2<double> d) { return vec2<double>{std::abs(d.x), std::abs(d.y)}; };
        return flat(3.0 * triplanar_gradient(in.core.weights, a(in.core.deriv), a(in.core.deriv_y),
                                             a(in.core.deriv_z), {.planes = TriplanarPlanes::golubev}));
      }));
  rows.push_back(make_row(
      "from_triplanar: listing 13",
      "put3(surfgrad_from_triplanar($frame.normal, $weights, $deriv, $deriv_y, $deriv_z))",
      [](const auto& in) {
        return flat(from_triplanar(in.core.frame.normal, in.core.weights, in.core.deriv, in.core.deriv_y,
                                   in.core.deriv_z));
      },
      [](const ShaderInputs<double>& in) {
        return all_within<3>(8 * (in.core.weights.x * length(in.core.deriv) +
                                  in.core.weights.y * length(in.core.deriv_y) +
                                  in.core.weights.z * length(in.core.deriv_z)));
      }));
  rows.push_back(make_row(
      "normalize_or_zero", "put3(surfgrad_normalize_or_zero($gradient))",
      [](const auto& in) { return flat(normalize_or_zero(in.core.gradient)); },
      [](const ShaderInputs<double>&) { return all_within<3>(3); }));
  rows.push_back(make_row(
      "reciprocal_or_zero", "put1(surfgrad_reciprocal_or_zero($scale))",
      [](const auto& in) { return flat(reciprocal_or_zero(in.core.scale)); },
      [](const ShaderInputs<double>& in) { return all_within<1>(0.5 / std::abs(in.core.scale)); }));
  rows.push_back(make_row(
      "saturated",
      "put_vectors(v3(surfgrad_saturated($scale), 0.0, 0.0) + surfgrad_saturated($gradient), "
      "surfgrad_saturated($deriv))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.core.scale)>;
        const vec3<T> v = vec3<T>{saturated(in.core.scale), T(0), T(0)} + saturated(in.core.gradient);
        const vec2<T> w = saturated(in.core.deriv);
        return std::array{v.x, v.y, v.z, w.x, w.y};
      },
      [](const ShaderInputs<double>& in) {
        return std::array{std::abs(in.core.scale) + std::abs(in.core.gradient.x), 0.0, 0.0, 0.0, 0.0};
      }));
  rows.push_back(make_row(
      "max_abs, cross",
      "put3(v3(surfgrad_max_abs($gradient), surfgrad_max_abs($deriv), surfgrad_cross($deriv, $deriv_y)))",
      [](const auto& in) {
        return std::array{max_abs(in.core.gradient), max_abs(in.core.deriv),
                          cross(in.core.deriv, in.core.deriv_y)};
      },
      [](const ShaderInputs<double>& in) {
        return std::array{0.0, 0.0,
                          1.5 * (std::abs(in.core.deriv.x * in.core.deriv_y.y) +
                                 std::abs(in.core.deriv.y * in.core.deriv_y.x))};
      }));
  rows.push_back(make_row(
      "cofactor", "put_columns(surfgrad_cofactor($matrix), 0, 3)",
      [](const auto& in) {
        const auto c = cofactor(in.core.matrix);
        return std::array{c.x.x, c.y.x, c.z.x, c.x.y, c.y.y, c.z.y, c.x.z, c.y.z, c.z.z};
      },
      [](const ShaderInputs<double>& in) {
        const double m = magnitude(in.core.matrix);
        return all_within<9>(1.5 * m * m);
      }));
  for (Row& row : rows) {
    for (const char* name : clamping)
      if (row.name == name) row.nan = NanPolicy::may_vanish;
    row.overflows = row.name == "resolve_mikktspace";
  }
}

} // namespace surfgrad::test
