/// The core against what the author's own shader functions returned for random pixel quads
/// (README.md). Where the reference departs from the paper as printed, a named map states how.

#include "support/core_functions.hpp"
#include "support/reference_vectors.hpp"
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

/// The reference's texture origin is upper left: the y of its derivatives is minus listing 4's.
template <class T>
vec2<T> green_flip(vec2<T> deriv) {
  return {deriv.x, -deriv.y};
}

/// The reference's listing 10 divides by |dot(normal, dir)|, the printed one by the signed product.
template <class T>
vec2<T> magnitude_dot(vec2<T> texture_direction, T along) {
  return along < T(0) ? -texture_direction : texture_direction;
}

/// The reference clamps determinants at 1.2e-15 and products at FLT_EPSILON, in scene units; ours are
/// relative to the magnitudes involved. They differ where the reference's clamp takes effect only.
bool reference_clamp(double divisor, double clamp) { return std::abs(divisor) < clamp; }

template <class T>
std::array<T, quad_outputs> evaluate(const Pixel<T>& p, const mat4<T>& world_from_screen) {
  std::array<T, quad_outputs> r;
  const auto put3 = [&](int i, vec3<T> v) {
    r[i] = v.x;
    r[i + 1] = v.y;
    r[i + 2] = v.z;
  };
  const auto put2 = [&](int i, vec2<T> v) {
    r[i] = v.x;
    r[i + 1] = v.y;
  };
  const Frame<T> frame = make_frame(p.normal, p.dp_dx, p.dp_dy);
  put3(0, frame.sigma_x);
  put3(3, frame.sigma_y);
  r[6] = frame.flip_sign;
  put3(7, frame.normal);
  const TangentFrame<T> mikkt = mikktspace_basis(p.normal, p.tangent, p.sign);
  put3(10, mikkt.tangent);
  put3(13, mikkt.bitangent);
  const vec2<T> deriv = green_flip(derivative_from_normal(p.tangent_normal));
  put2(16, deriv);
  const vec3<T> tbn = from_tbn(deriv, mikkt.tangent, mikkt.bitangent);
  put3(18, tbn);
  const TangentFrame<T> made = tangent_basis(frame, p.dst_dx, p.dst_dy);
  put3(21, made.tangent);
  put3(24, made.bitangent);
  put3(27, from_tbn(deriv, made.tangent, made.bitangent));
  put3(30, from_perturbed_normal(frame.normal, p.perturbed));
  put3(33, from_texel_derivative(frame, p.height_deriv, vec2<T>{T(512), T(256)}, p.dst_dx, p.dst_dy));
  put3(36, from_height_derivative(frame, p.height_deriv));
  const vec3<T> volume = from_volume_gradient(frame.normal, p.gradient);
  put3(39, volume);
  const vec3<T> weights = triplanar_weights(frame.normal, T(3));
  put3(42, weights);
  put3(45, from_triplanar(frame.normal, weights, p.deriv_x, p.deriv_y, p.deriv_z));
  const T along = dot(frame.normal, p.direction);
  put2(48,
       magnitude_dot(project_to_texture_space(frame, p.direction, p.dst_dx, p.dst_dy, p.bump_scale), along));
  put2(50, project_to_texture_space(frame, p.direction, p.dst_dx, p.dst_dy, p.bump_scale, true));
  put3(52, surface_offset(frame, p.dst_dx, p.dst_dy, p.offset));
  put3(55, resolve_normal(frame, constant<T>(0.7) * tbn + constant<T>(0.4) * volume));
  const ScreenDerivatives<T> d =
      screen_derivatives(p.screen_position, frame.normal, world_from_screen, p.x, p.y);
  put3(58, d.dp_dx);
  put3(61, d.dp_dy);
  return r;
}

/// Our own error in eps for each group, from the documented bounds at this pixel.
std::array<double, std::size(quad_groups)> own_bounds(const Pixel<double>& p, const mat4<double>& matrix) {
  CoreInputs<double> in{};
  in.frame = make_frame(p.normal, p.dp_dx, p.dp_dy);
  in.position = p.screen_position;
  in.world_from_screen = matrix;
  in.x = p.x;
  in.y = p.y;
  in.direction = p.direction;
  in.dst_dx = p.dst_dx;
  in.dst_dy = p.dst_dy;
  in.texture_offset = p.offset;
  in.bump_scale = p.bump_scale;
  const Frame<double>& f = in.frame;
  // Every function below sees a normal that carries 3 eps of its own: their bounds count twice.
  const double sigma_x = 10 * length(p.dp_dx);
  const double sigma_y = 10 * length(p.dp_dy);
  const double tangent = 4 * length(p.tangent) / length(p.normal);
  const double bitangent = 8 * length(p.tangent);
  const vec2<double> d = derivative_from_normal(p.tangent_normal);
  const double tbn = 2 * (std::abs(d.x) * tangent + std::abs(d.y) * bitangent);
  const double x = std::abs(p.dst_dy.y);
  const double y = std::abs(p.dst_dx.y);
  const double made = (x * (8 * length(f.sigma_x) + sigma_x) + y * (8 * length(f.sigma_y) + sigma_y)) /
                      length(p.dst_dy.y * f.sigma_x - p.dst_dx.y * f.sigma_y);
  const double along = std::abs(dot(f.normal, normalize_or_zero(p.perturbed)));
  const double perturbed = 8 / along * std::max(1.0, length(from_perturbed_normal(f.normal, p.perturbed)));
  const vec2<double> texel{512 * std::abs(p.height_deriv.x), 256 * std::abs(p.height_deriv.y)};
  const vec2<double> texel_terms{texel.x * std::abs(p.dst_dx.x) + texel.y * std::abs(p.dst_dx.y),
                                 texel.x * std::abs(p.dst_dy.x) + texel.y * std::abs(p.dst_dy.y)};
  const double by_texel = 2 * parametric_bound(f.normal, p.dp_dx, p.dp_dy, texel_terms);
  const double by_pixel = 2 * parametric_bound(f.normal, p.dp_dx, p.dp_dy, p.height_deriv);
  const double volume = 10 * length(p.gradient);
  const double weights = 2 * (5 + 4 * 3);
  const double triplanar = (weights + 16) * (length(p.deriv_x) + length(p.deriv_y) + length(p.deriv_z));
  const vec2<double> v = offset_bound(in);
  const double offset =
      2 * (v.x * length(f.sigma_x) + v.y * length(f.sigma_y)) + v.x * sigma_x + v.y * sigma_y;
  const double resolved = 4 + 0.7 * tbn + 0.4 * volume;
  const auto screen = screen_bound(in);
  return {sigma_x,
          sigma_y,
          0,
          3,
          tangent,
          bitangent,
          max_abs(d),
          tbn,
          made,
          made,
          made * 2 * length(d),
          perturbed,
          by_texel,
          by_pixel,
          volume,
          weights,
          triplanar,
          2 * projection_bound(in, false),
          2 * projection_bound(in, true),
          offset,
          resolved,
          2 * std::max({screen[0], screen[1], screen[2]}),
          2 * std::max({screen[3], screen[4], screen[5]})};
}

TEST(Vectors, TheProjectsOwnAreSomeOfAll) {
  const Quads own(own_quads);
  const Quads most(most_quads());
  ASSERT_TRUE(own.complete() && most.complete()) << "the reference vectors are cut short";
  for (int y = 0; y < own.height; ++y)
    for (int x = 0; x < own.width; ++x) {
      ASSERT_EQ(std::memcmp(own.record(x, y), most.record(x, y), quad_inputs * sizeof(float)), 0)
          << x << ", " << y;
      ASSERT_EQ(std::memcmp(own.expected(x, y), most.expected(x, y), quad_outputs * sizeof(float)), 0)
          << x << ", " << y;
    }
}

TEST(Vectors, EveryColumnAgreesInFloat) {
  const Quads quads(most_quads());
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  constexpr double eps = epsilon_v<float>;
  std::array<double, std::size(quad_groups)> worst_relative{};
  std::array<double, std::size(quad_groups)> worst_ratio{};
  std::array<std::string, std::size(quad_groups)> where;
  for (int y = 0; y < quads.height; ++y) {
    for (int x = 0; x < quads.width; ++x) {
      const auto got = evaluate(quads.pixel<float>(x, y), quads.matrix<float>());
      const auto own = own_bounds(quads.pixel<double>(x, y), quads.matrix<double>());
      const float* expected = quads.expected(x, y);
      for (std::size_t k = 0; k < std::size(quad_groups); ++k) {
        const QuadGroup& g = quad_groups[k];
        double size = 0;
        double error = 0;
        for (int i = g.first; i < g.first + g.count; ++i) {
          size = std::max(size, static_cast<double>(std::abs(expected[i])));
          error = std::max(error, std::abs(static_cast<double>(got[i]) - static_cast<double>(expected[i])));
        }
        if (error == 0) continue;
        worst_relative[k] = std::max(worst_relative[k], error / size);
        const double ratio = error / (g.reference_error * size + eps * own[k]);
        if (!(ratio <= worst_ratio[k])) {
          worst_ratio[k] = ratio;
          where[k] = "pixel " + std::to_string(x) + ", " + std::to_string(y);
        }
      }
    }
  }
  for (std::size_t k = 0; k < std::size(quad_groups); ++k) {
    std::printf("  %-34s worst relative difference %.2e, error / bound %.3f\n", quad_groups[k].name,
                worst_relative[k], worst_ratio[k]);
    EXPECT_LE(worst_ratio[k], 1) << quad_groups[k].name << " at " << where[k];
  }
}

TEST(Vectors, EveryColumnAgreesInDouble) {
  // Our formulas in double have no error of their own: what remains is the reference's. Its column in
  // the README is rounded to one digit, which hides up to half a unit of a leading 1, hence 1.5.
  const Quads quads(most_quads());
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  for (const QuadGroup& g : quad_groups) {
    double worst = 0;
    for (int y = 0; y < quads.height; ++y) {
      for (int x = 0; x < quads.width; ++x) {
        const auto got = evaluate(quads.pixel<double>(x, y), quads.matrix<double>());
        const float* expected = quads.expected(x, y);
        double size = 0;
        double error = 0;
        for (int i = g.first; i < g.first + g.count; ++i) {
          size = std::max(size, static_cast<double>(std::abs(expected[i])));
          error = std::max(error, std::abs(got[i] - static_cast<double>(expected[i])));
        }
        worst = std::max(worst, error / size);
      }
    }
    EXPECT_LE(worst, 1.5 * g.reference_error) << g.name;
  }
}

TEST(Vectors, ConventionMapsAreNeededAndSuffice) {
  const Quads quads(most_quads());
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  int turned = 0;
  int flipped = 0;
  int clamped = 0;
  for (int y = 0; y < quads.height; ++y) {
    for (int x = 0; x < quads.width; ++x) {
      const Pixel<double> p = quads.pixel<double>(x, y);
      const Frame<double> f = make_frame(p.normal, p.dp_dx, p.dp_dy);
      turned += dot(f.normal, p.direction) < 0;
      flipped += p.tangent_normal.y != 0;
      clamped += reference_clamp(dot(p.dp_dx, cross(p.dp_dy, f.normal)), 1.2e-15) ||
                 reference_clamp(cross(p.dst_dx, p.dst_dy), 1.2e-15) ||
                 reference_clamp(dot(f.normal, p.perturbed), epsilon_v<float>) ||
                 reference_clamp(dot(f.normal, p.direction), epsilon_v<float>);
    }
  }
  std::printf("  of %d pixels: green_flip matters in %d, magnitude_dot in %d, reference_clamp in %d\n",
              quads.width * quads.height, flipped, turned, clamped);
  const int some = quads.width * quads.height / 20;
  EXPECT_GT(turned, some);
  EXPECT_GT(flipped, some);
  EXPECT_EQ(clamped, 0); // no pixel is degenerate, so that no column needs an exception
}

} // namespace
} // namespace surfgrad::test
