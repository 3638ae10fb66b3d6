/// The core against what the author's own shader functions returned for 2048 random pixel quads.
///
/// The vectors live outside the project (shared/vectors/README.md describes them). Where the
/// reference departs from the paper as printed, a named map states how.

#include "support/core_functions.hpp"
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace surfgrad::test {
namespace {

constexpr int width = 512;
constexpr int height = 16;
constexpr int inputs = 44;
constexpr int outputs = 64;

std::vector<float> read_floats(const char* name) {
  std::ifstream file(std::string(SURFGRAD_SHARED_DIR "/vectors/") + name, std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<float> values(bytes.size() / sizeof(float));
  // An absent file is no floats, and memcpy takes no null pointer even for none.
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

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

/// One pixel's inputs, its differences within the quad included.
template <class T>
struct Pixel {
  vec3<T> position, normal, tangent;
  T sign;
  vec3<T> tangent_normal, perturbed, gradient;
  vec2<T> deriv_x, deriv_y, deriv_z;
  vec3<T> direction;
  T bump_scale;
  vec2<T> offset, height_deriv;
  vec3<T> screen_position;
  T x, y;
  vec3<T> dp_dx, dp_dy;
  vec2<T> dst_dx, dst_dy;
};

class Quads {
 public:
  Quads()
      : in_(read_floats("quads_in.f32")), out_(read_floats("quads_out.f32")),
        matrix_(read_floats("world_from_screen.f32")) {}
  [[nodiscard]] bool complete() const {
    return in_.size() == std::size_t{width} * height * inputs &&
           out_.size() == std::size_t{width} * height * outputs && matrix_.size() == 16;
  }
  [[nodiscard]] const float* expected(int x, int y) const { return &out_[offset(x, y) * outputs]; }

  template <class T>
  [[nodiscard]] mat4<T> matrix() const {
    const auto row = [&](std::size_t r) {
      return vec4<T>{T(matrix_[4 * r]), T(matrix_[4 * r + 1]), T(matrix_[4 * r + 2]), T(matrix_[4 * r + 3])};
    };
    return {row(0), row(1), row(2), row(3)};
  }
  template <class T>
  [[nodiscard]] Pixel<T> pixel(int x, int y) const {
    const float* p = &in_[offset(x, y) * inputs];
    const auto v3 = [&](int i) { return vec3<T>{T(p[i]), T(p[i + 1]), T(p[i + 2])}; };
    const auto v2 = [&](int i) { return vec2<T>{T(p[i]), T(p[i + 1])}; };
    // ddx_fine and ddy_fine: differences in float, on the pixel's own row and column of the quad.
    const float* left = &in_[offset(x & ~1, y) * inputs];
    const float* right = &in_[offset(x | 1, y) * inputs];
    const float* upper = &in_[offset(x, y & ~1) * inputs];
    const float* lower = &in_[offset(x, y | 1) * inputs];
    const auto dx = [&](int i) { return T(right[i] - left[i]); };
    const auto dy = [&](int i) { return T(lower[i] - upper[i]); };
    return {v3(0),
            v3(3),
            v3(6),
            T(p[9]),
            v3(12),
            v3(15),
            v3(18),
            v2(21),
            v2(23),
            v2(25),
            v3(27),
            T(p[30]),
            v2(31),
            v2(33),
            v3(35),
            T(p[38]),
            T(p[39]),
            {dx(0), dx(1), dx(2)},
            {dy(0), dy(1), dy(2)},
            {dx(10), dx(11)},
            {dy(10), dy(11)}};
  }

 private:
  static std::size_t offset(int x, int y) {
    return static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  }
  std::vector<float> in_, out_, matrix_;
};

/// One group of columns: our result, and the error that both sides may have.
struct Group {
  const char* name;
  int first, count;
  double reference_error; ///< the README's: relative to the longest component of the group
};
constexpr Group groups[] = {
    {"sigma_x", 0, 3, 2e-7},
    {"sigma_y", 3, 3, 2e-7},
    {"flip_sign", 6, 1, 0},
    {"normal", 7, 3, 2e-7},
    {"mikktspace tangent", 10, 3, 2e-7},
    {"mikktspace bitangent", 13, 3, 2e-7},
    {"derivative_from_normal", 16, 2, 6e-8},
    {"from_tbn, mikktspace", 18, 3, 3e-7},
    {"tangent_basis tangent", 21, 3, 3e-7},
    {"tangent_basis bitangent", 24, 3, 3e-7},
    {"from_tbn, tangent_basis", 27, 3, 3e-7},
    {"from_perturbed_normal", 30, 3, 2e-5},
    {"from_texel_derivative", 33, 3, 7e-7},
    {"from_height_derivative", 36, 3, 3e-7},
    {"from_volume_gradient", 39, 3, 3e-5},
    {"triplanar_weights", 42, 3, 4e-7},
    {"from_triplanar", 45, 3, 6e-6},
    {"project_to_texture_space", 48, 2, 2e-6},
    {"project_to_texture_space, skipped", 50, 2, 2e-6},
    {"surface_offset", 52, 3, 4e-7},
    {"resolve_normal", 55, 3, 1e-6},
    {"screen_derivatives dp_dx", 58, 3, 4e-4},
    {"screen_derivatives dp_dy", 61, 3, 4e-4},
};

template <class T>
std::array<T, outputs> evaluate(const Pixel<T>& p, const mat4<T>& world_from_screen) {
  std::array<T, outputs> r;
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
std::array<double, std::size(groups)> own_bounds(const Pixel<double>& p, const mat4<double>& matrix) {
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

TEST(Vectors, EveryColumnAgreesInFloat) {
  const Quads quads;
  if (!std::filesystem::exists(SURFGRAD_SHARED_DIR "/vectors"))
    GTEST_SKIP() << "no folder " SURFGRAD_SHARED_DIR "/vectors";
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  constexpr double eps = epsilon_v<float>;
  std::array<double, std::size(groups)> worst_relative{};
  std::array<double, std::size(groups)> worst_ratio{};
  std::array<std::string, std::size(groups)> where;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto got = evaluate(quads.pixel<float>(x, y), quads.matrix<float>());
      const auto own = own_bounds(quads.pixel<double>(x, y), quads.matrix<double>());
      const float* expected = quads.expected(x, y);
      for (std::size_t k = 0; k < std::size(groups); ++k) {
        const Group& g = groups[k];
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
  for (std::size_t k = 0; k < std::size(groups); ++k) {
    std::printf("  %-34s worst relative difference %.2e, error / bound %.3f\n", groups[k].name,
                worst_relative[k], worst_ratio[k]);
    EXPECT_LE(worst_ratio[k], 1) << groups[k].name << " at " << where[k];
  }
}

TEST(Vectors, EveryColumnAgreesInDouble) {
  // Our formulas in double have no error of their own: what remains is the reference's. Its column in
  // the README is rounded to one digit, which hides up to half a unit of a leading 1, hence 1.5.
  const Quads quads;
  if (!std::filesystem::exists(SURFGRAD_SHARED_DIR "/vectors"))
    GTEST_SKIP() << "no folder " SURFGRAD_SHARED_DIR "/vectors";
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  for (const Group& g : groups) {
    double worst = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
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
  const Quads quads;
  if (!std::filesystem::exists(SURFGRAD_SHARED_DIR "/vectors"))
    GTEST_SKIP() << "no folder " SURFGRAD_SHARED_DIR "/vectors";
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  int turned = 0;
  int flipped = 0;
  int clamped = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
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
              width * height, flipped, turned, clamped);
  EXPECT_GT(turned, 100);
  EXPECT_GT(flipped, 100);
  EXPECT_EQ(clamped, 0); // no pixel is degenerate, so that no column needs an exception
}

} // namespace
} // namespace surfgrad::test
