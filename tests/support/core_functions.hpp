#pragma once

/// Every function of the core's listings as one row: how it is called, how its result follows the
/// scale of the scene, and its documented error bound.

#include "support/core_inputs.hpp"
#include <algorithm>
#include <limits>
#include <surfgrad/derivative.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/parallax.hpp>
#include <surfgrad/resolve.hpp>
#include <surfgrad/screen.hpp>
#include <surfgrad/triplanar.hpp>

namespace surfgrad::test {

// clang-format off
template <class T> std::array<T, 1> flat(T a) { return {a}; }
template <class T> std::array<T, 2> flat(vec2<T> a) { return {a.x, a.y}; }
template <class T> std::array<T, 3> flat(vec3<T> a) { return {a.x, a.y, a.z}; }
template <class T> std::array<T, 6> flat(vec3<T> a, vec3<T> b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }
template <class T> std::array<T, 6> flat(const TangentFrame<T>& f) { return flat(f.tangent, f.bitangent); }
template <class T> std::array<T, 6> flat(const ScreenDerivatives<T>& d) { return flat(d.dp_dx, d.dp_dy); }
template <class T> std::array<T, 4> flat(const TextureDerivatives<T>& d) { return {d.dst_dx.x, d.dst_dx.y, d.dst_dy.x, d.dst_dy.y}; }
template <class T> std::array<T, 9> flat(const mat3<T>& m) { return {m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z}; }
template <class T> std::array<T, 6> flat(const TriplanarCoordinates<T>& c) { return {c.x_plane.x, c.x_plane.y, c.y_plane.x, c.y_plane.y, c.z_plane.x, c.z_plane.y}; }
template <class T> std::array<T, 11> flat(const Frame<T>& f) {
  return {f.normal.x, f.normal.y, f.normal.z, f.sigma_x.x, f.sigma_x.y, f.sigma_x.z, f.sigma_y.x, f.sigma_y.y, f.sigma_y.z, f.flip_sign, f.resolve_sign};
}
// clang-format on

/// The same bound, in eps, for N components.
template <std::size_t N>
[[nodiscard]] std::array<double, N> all_within(double bound) {
  std::array<double, N> a;
  a.fill(bound);
  return a;
}

using In = CoreInputs<double>;

/// |a| |b| / |det|: how much two directions with this determinant amplify rounding.
[[nodiscard]] inline double conditioning(vec3<double> a, vec3<double> b, vec3<double> n) {
  return length(a) * length(b) / std::abs(dot(a, cross(b, n)));
}
[[nodiscard]] inline double conditioning(vec2<double> a, vec2<double> b) {
  return length(a) * length(b) / std::abs(cross(a, b));
}
[[nodiscard]] inline double magnitude(const mat3<double>& m) {
  return std::sqrt(dot(m.x, m.x) + dot(m.y, m.y) + dot(m.z, m.z));
}
[[nodiscard]] inline vec3<double> absolute(vec3<double> v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

/// tangent_basis' bound.
[[nodiscard]] inline double tangent_basis_bound(const In& in) {
  const double x = std::abs(in.dst_dy.y);
  const double y = std::abs(in.dst_dx.y);
  const vec3<double> sum = in.dst_dy.y * in.frame.sigma_x - in.dst_dx.y * in.frame.sigma_y;
  return 8 * (x * length(in.frame.sigma_x) + y * length(in.frame.sigma_y)) / length(sum);
}
/// from_parametric_derivative's bound.
[[nodiscard]] inline double parametric_bound(vec3<double> n, vec3<double> du, vec3<double> dv,
                                             vec2<double> dh) {
  const double kappa = conditioning(du, dv, n);
  const double det = std::abs(dot(du, cross(dv, n)));
  return 8 * kappa * std::max(std::abs(dh.x) * length(cross(dv, n)), std::abs(dh.y) * length(cross(n, du))) /
         det;
}
/// screen_offset's bound for each component.
[[nodiscard]] inline vec2<double> offset_bound(const In& in) {
  const double kappa = conditioning(in.dst_dx, in.dst_dy);
  const double term = 8 * kappa * kappa * length(in.texture_offset);
  return {term / length(in.dst_dx), term / length(in.dst_dy)};
}
/// flip_sign is a decision: either sign is right where the orientation is lost in rounding.
[[nodiscard]] inline double sign_bound(vec3<double> n, vec3<double> x, vec3<double> y) {
  return std::abs(dot(y, cross(n, x))) < 1e-5 * length(x) * length(y) ? 1e30 : 0;
}
[[nodiscard]] inline std::array<double, 11> frame_bound(double normal, vec3<double> n, vec3<double> x,
                                                        vec3<double> y) {
  const double sx = (4 + 2 * normal) * length(x);
  const double sy = (4 + 2 * normal) * length(y);
  return {normal, normal, normal, sx, sx, sx, sy, sy, sy, sign_bound(n, x, y), 0};
}
[[nodiscard]] inline double projection_bound(const In& in, bool skip) {
  const double kappa = conditioning(in.frame.dp_dx, in.frame.dp_dy, in.frame.normal);
  const double along = std::abs(dot(in.frame.normal, in.direction));
  const double term =
      std::abs(in.bump_scale) * kappa *
      (length(in.dst_dx) / length(in.frame.dp_dx) + length(in.dst_dy) / length(in.frame.dp_dy));
  return skip ? 16 * kappa * term : 16 * (kappa + 1 / along) * term / along;
}

/// Every formula of listing 17 with its terms taken by magnitude: the bound is 16 eps of it.
[[nodiscard]] inline std::array<double, 6> screen_bound(const In& in) {
  const mat4<double>& m = in.world_from_screen;
  const vec3<double> n = normalize_or_zero(in.frame.normal);
  const auto plane = [&](vec4<double> column, bool absolute_terms) {
    const double d = absolute_terms ? dot(absolute(in.position), absolute(n)) : -dot(in.position, n);
    if (!absolute_terms) return dot(column, vec4<double>{n.x, n.y, n.z, d});
    return std::abs(column.x * n.x) + std::abs(column.y * n.y) + std::abs(column.z * n.z) +
           std::abs(column.w) * d;
  };
  const mat4<double> c = transpose(m);
  const double depth = std::abs(plane(c.z, false));
  const auto slope = [&](vec4<double> column) { // magnitude of -(A / C) and of its error
    return (plane(column, true) + std::abs(plane(column, false)) / depth * plane(c.z, true)) / depth;
  };
  const auto sum = [&](vec4<double> column, double s) {
    return vec4<double>{std::abs(column.x) + s * std::abs(c.z.x), std::abs(column.y) + s * std::abs(c.z.y),
                        std::abs(column.z) + s * std::abs(c.z.z), std::abs(column.w) + s * std::abs(c.z.w)};
  };
  const vec4<double> v0 = sum(c.x, slope(c.x));
  const vec4<double> v1 = sum(c.y, slope(c.y));
  const vec4<double> hit = std::abs(in.x) * v0 + std::abs(in.y) * v1 + sum(c.w, slope(c.w));
  const double ac = -plane(c.x, false) / plane(c.z, false);
  const double bc = -plane(c.y, false) / plane(c.z, false);
  const double dc = -plane(c.w, false) / plane(c.z, false);
  const double w = std::abs(in.x * (c.x.w + ac * c.z.w) + in.y * (c.y.w + bc * c.z.w) + c.w.w + dc * c.z.w);
  const ScreenDerivatives<double> d = screen_derivatives(in.position, in.frame.normal, m, in.x, in.y);
  const vec3<double> p = absolute(in.position);
  const vec3<double> spread = (1 / w) * (vec3<double>{hit.x, hit.y, hit.z} + hit.w * p);
  const auto derivative = [&](vec4<double> v, vec3<double> result) {
    return (1 / w) * (vec3<double>{v.x, v.y, v.z} + v.w * (p + spread) + hit.w * absolute(result));
  };
  const vec3<double> x = 16.0 * derivative(v0, d.dp_dx);
  const vec3<double> y = 16.0 * derivative(v1, d.dp_dy);
  return flat(x, y);
}

/// Calls visit(name, powers, call, bound) for every function.
///
/// powers  how each result scales with the scene: 1 for lengths, 0 for directions and slopes, -1 for
///         their inverses; one power for all components
/// call    generic over the scalar: CoreInputs<T> to std::array<T, N>
/// bound   documented error of each component in eps, to first order; exact where it is 0
template <class Visit>
void for_each_core_function(Visit&& visit) {
  visit(
      "scale_bump", 0, [](const auto& in) { return flat(scale_bump(in.scale, in.gradient)); },
      [](const In& in) { return flat(0.5 * absolute(in.scale * in.gradient)); });
  visit(
      "derivative_from_normal(3)", 0,
      [](const auto& in) { return flat(derivative_from_normal(in.tangent_normal)); },
      [](const In& in) {
        const vec2<double> d = derivative_from_normal(in.tangent_normal);
        return std::array{std::abs(d.x), std::abs(d.y)};
      });
  visit(
      "derivative_from_normal(2)", 0,
      [](const auto& in) { return flat(derivative_from_normal(in.xy_normal)); },
      [](const In& in) {
        const vec2<double> m = in.xy_normal;
        const vec2<double> d = derivative_from_normal(m);
        const double z2 = std::max(1 - dot(m, m), max_abs(m) * max_abs(m) / (max_slope * max_slope));
        return std::array{(2 + 1 / z2) * std::abs(d.x), (2 + 1 / z2) * std::abs(d.y)};
      });
  visit(
      "normal_from_derivative", 0, [](const auto& in) { return flat(normal_from_derivative(in.deriv)); },
      [](const In&) { return all_within<3>(4); });
  visit(
      "derivative_from_heights", 1,
      [](const auto& in) { return flat(derivative_from_heights(in.height, in.height_x, in.height_y)); },
      [](const In& in) {
        return std::array{0.5 * std::abs(in.height_x - in.height), 0.5 * std::abs(in.height_y - in.height)};
      });
  visit(
      "derivative_from_bicubic", 0,
      [](const auto& in) { return flat(derivative_from_bicubic(in.texels, in.fraction)); },
      [](const In& in) {
        double largest = 0;
        for (const vec4<double>& r : {in.texels.x, in.texels.y, in.texels.z, in.texels.w})
          largest = std::max({largest, std::abs(r.x), std::abs(r.y), std::abs(r.z), std::abs(r.w)});
        return all_within<2>(8 * largest);
      });
  visit(
      "make_frame", 1,
      [](const auto& in) {
        const auto f = make_frame(in.raw_normal, in.frame.dp_dx, in.frame.dp_dy);
        return flat(f.sigma_x, f.sigma_y);
      },
      [](const In& in) {
        const auto b = frame_bound(3, normalize_or_zero(in.raw_normal), in.frame.dp_dx, in.frame.dp_dy);
        return std::array{b[3], b[4], b[5], b[6], b[7], b[8]};
      });
  visit(
      "make_frame: normal, signs", 0,
      [](const auto& in) {
        const auto f =
            make_frame(in.raw_normal, in.frame.dp_dx, in.frame.dp_dy, in.sign < in.scale, BackFaces::flip);
        return std::array{f.normal.x, f.normal.y, f.normal.z, f.flip_sign, f.resolve_sign};
      },
      [](const In& in) {
        const auto b = frame_bound(3, normalize_or_zero(in.raw_normal), in.frame.dp_dx, in.frame.dp_dy);
        return std::array{b[0], b[1], b[2], b[9], b[10]};
      });
  visit(
      "rebase_frame", 1,
      [](const auto& in) {
        const auto f = rebase_frame(in.frame, in.direction);
        return flat(f.sigma_x, f.sigma_y);
      },
      [](const In& in) {
        const auto b = frame_bound(0, in.direction, in.frame.dp_dx, in.frame.dp_dy);
        return std::array{b[3], b[4], b[5], b[6], b[7], b[8]};
      });
  visit(
      "mikktspace_basis", 0,
      [](const auto& in) { return flat(mikktspace_basis(in.raw_normal, in.raw_tangent, in.sign)); },
      [](const In& in) {
        const double t = 4 * length(in.raw_tangent) / length(in.raw_normal);
        const double b = 8 * length(in.raw_tangent);
        return std::array{t, t, t, b, b, b};
      });
  visit(
      "tangent_basis", 0, [](const auto& in) { return flat(tangent_basis(in.frame, in.dst_dx, in.dst_dy)); },
      [](const In& in) { return all_within<6>(tangent_basis_bound(in)); });
  visit(
      "from_tbn", 0, [](const auto& in) { return flat(from_tbn(in.deriv, in.tangent, in.bitangent)); },
      [](const In& in) {
        return flat(absolute(in.deriv.x * in.tangent) + absolute(in.deriv.y * in.bitangent));
      });
  visit(
      "from_perturbed_normal", 0,
      [](const auto& in) { return flat(from_perturbed_normal(in.frame.normal, in.perturbed)); },
      [](const In& in) {
        const double along = std::abs(dot(in.frame.normal, normalize_or_zero(in.perturbed)));
        const double g = length(from_perturbed_normal(in.frame.normal, in.perturbed));
        return all_within<3>(4 / along * std::max(1.0, g));
      });
  visit(
      "from_parametric_derivative", 0,
      [](const auto& in) {
        return flat(from_parametric_derivative(in.frame.normal, in.dp_du, in.dp_dv, in.dh_duv));
      },
      [](const In& in) {
        return all_within<3>(parametric_bound(in.frame.normal, in.dp_du, in.dp_dv, in.dh_duv));
      });
  visit(
      "from_height_derivative", 0,
      [](const auto& in) { return flat(from_height_derivative(in.frame, in.dh_duv)); },
      [](const In& in) {
        return all_within<3>(parametric_bound(in.frame.normal, in.frame.dp_dx, in.frame.dp_dy, in.dh_duv));
      });
  visit(
      "from_texel_derivative", 0,
      [](const auto& in) {
        return flat(from_texel_derivative(in.frame, in.dh_duv, in.size, in.dst_dx, in.dst_dy));
      },
      [](const In& in) {
        const vec2<double> dh{std::abs(in.size.x * in.dh_duv.x), std::abs(in.size.y * in.dh_duv.y)};
        const vec2<double> terms{dh.x * std::abs(in.dst_dx.x) + dh.y * std::abs(in.dst_dx.y),
                                 dh.x * std::abs(in.dst_dy.x) + dh.y * std::abs(in.dst_dy.y)};
        return all_within<3>(parametric_bound(in.frame.normal, in.frame.dp_dx, in.frame.dp_dy, terms));
      });
  visit(
      "from_volume_gradient", 0,
      [](const auto& in) { return flat(from_volume_gradient(in.frame.normal, in.gradient)); },
      [](const In& in) { return all_within<3>(4 * length(in.gradient)); });
  visit(
      "resolve_normal", 0, [](const auto& in) { return flat(resolve_normal(in.frame, in.gradient)); },
      [](const In&) { return all_within<3>(4); });
  visit(
      "flip_from_mirror", 0,
      [](const auto& in) { return flat(flip_from_mirror(in.direction, in.frame.normal)); },
      [](const In&) { return all_within<3>(6); });
  visit(
      "transform_normal", 0, [](const auto& in) { return flat(transform_normal(in.matrix, in.gradient)); },
      [](const In& in) {
        const double m = magnitude(in.matrix);
        // The side is a decision: nothing holds where the determinant is lost in rounding.
        const bool lost = std::abs(determinant(in.matrix)) < 1e-5 * m * m * m;
        return all_within<3>(lost ? 1e30 : 8 * m * m * length(in.gradient));
      });
  visit(
      "tangent_normal_matrix", -1,
      [](const auto& in) {
        const auto m = tangent_normal_matrix(in.rotation, in.tangent, in.dp_du, in.dp_dv, in.frame.normal);
        return std::array{m.x.x, m.y.x, m.z.x, m.x.y, m.y.y, m.z.y};
      },
      [](const In& in) {
        const double kappa = conditioning(in.dp_du, in.dp_dv, in.frame.normal);
        const double s = 16 * kappa * kappa * dot(in.tangent, in.tangent);
        const double u = s / length(in.dp_du);
        const double v = s / length(in.dp_dv);
        return std::array{u, u, u, v, v, v};
      });
  visit(
      "tangent_normal_matrix: third column", 0,
      [](const auto& in) {
        const auto m = tangent_normal_matrix(in.rotation, in.tangent, in.dp_du, in.dp_dv, in.frame.normal);
        return std::array{m.x.z, m.y.z, m.z.z};
      },
      [](const In& in) { return all_within<3>(16 * dot(in.tangent, in.tangent)); });
  visit(
      "triplanar_weights", 0, [](const auto& in) { return flat(triplanar_weights(in.frame.normal)); },
      [](const In&) { return all_within<3>(5 + 4 * 3); });
  visit(
      "triplanar_weights, k = 100", 0,
      [](const auto& in) { return flat(triplanar_weights(in.frame.normal, {100})); },
      [](const In&) { return all_within<3>(5 + 4 * 100); });
  visit(
      "triplanar_coordinates", 1,
      [](const auto& in) {
        return flat(triplanar_coordinates(in.position, {.handedness = Handedness::right}));
      },
      [](const In&) { return all_within<6>(0); });
  visit(
      "planar_gradient", 0,
      [](const auto& in) {
        return flat(planar_gradient(PlaneAxis::x, in.deriv, {.origin = TextureOrigin::upper_left}));
      },
      [](const In&) { return all_within<3>(0); });
  visit(
      "triplanar_gradient", 0,
      [](const auto& in) { return flat(triplanar_gradient(in.weights, in.deriv, in.deriv_y, in.deriv_z)); },
      [](const In& in) {
        const auto a = [](vec2<double> d) { return vec2<double>{std::abs(d.x), std::abs(d.y)}; };
        return flat(3.0 * triplanar_gradient(in.weights, a(in.deriv), a(in.deriv_y), a(in.deriv_z)));
      });
  visit(
      "from_triplanar", 0,
      [](const auto& in) {
        return flat(from_triplanar(in.frame.normal, in.weights, in.deriv, in.deriv_y, in.deriv_z,
                                   {.planes = TriplanarPlanes::golubev}));
      },
      [](const In& in) {
        const double terms = in.weights.x * length(in.deriv) + in.weights.y * length(in.deriv_y) +
                             in.weights.z * length(in.deriv_z);
        return all_within<3>(8 * terms);
      });
  visit(
      "project_to_texture_space", 0,
      [](const auto& in) {
        return flat(project_to_texture_space(in.frame, in.direction, in.dst_dx, in.dst_dy, in.bump_scale));
      },
      [](const In& in) { return all_within<2>(projection_bound(in, false)); });
  visit(
      "project_to_texture_space, skipped", 0,
      [](const auto& in) {
        return flat(
            project_to_texture_space(in.frame, in.direction, in.dst_dx, in.dst_dy, in.bump_scale, true));
      },
      [](const In& in) { return all_within<2>(projection_bound(in, true)); });
  visit(
      "screen_offset", 0,
      [](const auto& in) { return flat(screen_offset(in.dst_dx, in.dst_dy, in.texture_offset)); },
      [](const In& in) { return flat(offset_bound(in)); });
  visit(
      "surface_offset", 1,
      [](const auto& in) { return flat(surface_offset(in.frame, in.dst_dx, in.dst_dy, in.texture_offset)); },
      [](const In& in) {
        const vec2<double> v = offset_bound(in);
        return all_within<3>(1.25 * (v.x * length(in.frame.sigma_x) + v.y * length(in.frame.sigma_y)));
      });
  visit(
      "offset_normal", 0,
      [](const auto& in) { return flat(offset_normal(in.frame, in.dn_dx, in.dn_dy, in.deriv)); },
      [](const In& in) {
        const vec3<double> x = in.deriv.x * in.dn_dx;
        const vec3<double> y = in.deriv.y * in.dn_dy;
        return all_within<3>(6 * (1 + length(x) + length(y)) / length(in.frame.normal + x + y));
      });
  visit(
      "screen_derivatives", 1,
      [](const auto& in) {
        return flat(screen_derivatives(in.position, in.frame.normal, in.world_from_screen, in.x, in.y));
      },
      [](const In& in) { return screen_bound(in); });
  visit(
      "projected_derivatives", 0,
      [](const auto& in) {
        return flat(projected_derivatives(in.tangent, in.bitangent, in.dn_dx, in.dn_dy));
      },
      [](const In& in) {
        const TextureDerivatives<double> t = projected_derivatives(
            absolute(in.tangent), absolute(in.bitangent), absolute(in.dn_dx), absolute(in.dn_dy));
        return flat(TextureDerivatives<double>{1.5 * t.dst_dx, 1.5 * t.dst_dy});
      });
  visit(
      "texture_lod", 0, [](const auto& in) { return flat(texture_lod(in.dst_dx, in.dst_dy, in.size)); },
      [](const In& in) {
        return all_within<1>(4 * std::max(1.0, std::abs(texture_lod(in.dst_dx, in.dst_dy, in.size))));
      });
}

} // namespace surfgrad::test
