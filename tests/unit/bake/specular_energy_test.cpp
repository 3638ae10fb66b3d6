// What a mip level reflects against what it stands for: the widened roughness holds the energy.

#include "bake/roughness.hpp"
#include "io/image_file.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <ostream>
#include <string>

namespace surfgrad::bake {
namespace {

/// GGX with Smith's correlated masking, times the cosine to the light; no Fresnel term.
double reflected(vec3<double> n, vec3<double> to_viewer, vec3<double> to_light, double alpha) {
  const vec3<double> h = normalize_or_zero(to_viewer + to_light);
  const double nh = dot(n, h);
  const double nv = dot(n, to_viewer);
  const double nl = dot(n, to_light);
  if (nv <= 0 || nl <= 0) return 0;
  const double a2 = alpha * alpha;
  const double d = nh * nh * (a2 - 1) + 1;
  const double distribution = a2 / (std::numbers::pi * d * d);
  const double masking =
      0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  return distribution * masking * nl;
}

/// The digits of i behind the point, in reverse. Pairs of these in two primes fill the unit square evenly,
/// four of them all pairs of directions, so that sums settle sooner than with random numbers.
///
/// source  Halton 1960
double radical_inverse(int i, int base) {
  double result = 0;
  for (double digit = 1.0 / base; i > 0; i /= base, digit /= base) result += i % base * digit;
  return result;
}

/// A direction of those within `widest` of the normal, each as often where uv is evenly spread.
vec3<double> direction(vec2<double> uv, double widest) {
  const double turn = 2 * std::numbers::pi * uv.x;
  const double cosine = 1 - uv.y * (1 - std::cos(widest));
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

vec3<double> normal_at(const image::Image& map, int x, int y) {
  return normalize_or_zero(
      vec3<double>{2.0 * map.at(x, y, 0) - 1, 2.0 * map.at(x, y, 1) - 1, 2.0 * map.at(x, y, 2) - 1});
}

/// Relative errors of what is reflected.
struct Errors {
  double energy = 0;   ///< of the mean over lights and viewers
  double each_way = 0; ///< mean over these of the errors
};

/// A map baked on a square, and what its level 4 says, in floats.
class Patches {
 public:
  static constexpr int level = 4;
  static constexpr int side = 1 << level;

  /// scale  of the bumps
  Patches(const std::filesystem::path& file, double scale)
      : scene_(test::scene_of(test::plane(1))), options_(options_for(io::read_image(file))) {
    test::add_image(scene_, "a", io::read_image(file));
    stack::NormalMapLayer layer = test::normal_layer("a");
    layer.common.scale = scale;
    scene_.materials[0].layers = {layer};
    fine_ = bake(scene_, options_).map;
    statistics_ = std::make_unique<NormalStatistics>(normal_statistics(scene_, options_));
    coarse_ = normal_level(*statistics_, level, options_);
  }

  /// What patches of 16x16 texels reflect, against one texel of level 4: with its roughness, and with the
  /// base's.
  struct Compared {
    Errors widened{};
    Errors plain{};
  };
  [[nodiscard]] Compared compared(double roughness, double widest) const {
    const double alpha = roughness * roughness;
    const image::Image wide = roughness_map(*statistics_, level, BaseRoughness(roughness), options_, false);
    Sums widened, plain;
    constexpr int pairs = 2048;
    constexpr int patches = 4;
    for (int pair = 0; pair < pairs; ++pair) {
      const auto part = [&](int base) { return radical_inverse(pair + 1, base); };
      const vec3<double> to_viewer = direction({part(2), part(3)}, widest);
      const vec3<double> to_light = direction({part(5), part(7)}, widest);
      double fine = 0, with = 0, without = 0;
      for (int patch = 0; patch < patches; ++patch) {
        const int place = patches * pair + patch;
        const int x = static_cast<int>(radical_inverse(place, 2) * coarse_.width);
        const int y = static_cast<int>(radical_inverse(place, 3) * coarse_.height);
        for (int j = 0; j < side; ++j)
          for (int i = 0; i < side; ++i)
            fine += reflected(normal_at(fine_, side * x + i, side * y + j), to_viewer, to_light, alpha) /
                    (side * side);
        const vec3<double> n = normal_at(coarse_, x, y);
        with += reflected(n, to_viewer, to_light, std::pow(double{wide.at(x, y, 0)}, 2));
        without += reflected(n, to_viewer, to_light, alpha);
      }
      widened.add(fine, with);
      plain.add(fine, without);
    }
    return {widened.errors(), plain.errors()};
  }

 private:
  /// Sides of whole patches: a mip level's texel is then one.
  static Options options_for(const image::Image& map) {
    const auto whole = [](int texels) { return (texels + side - 1) / side * side; };
    return {.width = whole(map.width), .height = whole(map.height), .depth = image::Depth::float32};
  }

  struct Sums {
    double truth = 0, energy = 0, error = 0;
    void add(double fine, double coarse) {
      truth += fine;
      energy += coarse;
      error += std::abs(coarse - fine);
    }
    [[nodiscard]] Errors errors() const { return {energy / truth - 1, error / truth}; }
  };

  scene::Scene scene_;
  Options options_;
  image::Image fine_{};
  std::unique_ptr<NormalStatistics> statistics_{};
  image::Image coarse_{};
};

/// Means over some maps and roughnesses, in percent.
struct Means {
  double energy = 0, plain = 0, each_way = 0, plain_each_way = 0;
  int count = 0;
  void add(const Patches::Compared& c) {
    energy += 100 * std::abs(c.widened.energy);
    plain += 100 * std::abs(c.plain.energy);
    each_way += 100 * c.widened.each_way;
    plain_each_way += 100 * c.plain.each_way;
    ++count;
  }
  [[nodiscard]] Means mean() const {
    return {energy / count, plain / count, each_way / count, plain_each_way / count, 1};
  }
  void print(const char* what) const {
    const Means m = mean();
    std::printf("  %s: off by %.2f %%, %.1f %% without widening; each way %.1f %%, %.1f %% without\n", what,
                m.energy, m.plain, m.each_way, m.plain_each_way);
  }
};

/// Over the shared tileable maps and three roughnesses.
Means measured(double scale, double widest) {
  Means sum;
  for (const char* name :
       {"yughues_242/pattern_242_normal.png", "ogre_nm/NMBalls.png", "ogre_nm/NMStripes.png",
        "mmikk_details/Pirate_details.png", "mmikk_details/sofa.png", "mmikk_details/details.png",
        "mx_mesh_wire/mesh_wire_norm.png"}) {
    const Patches patches(std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets/normal_tile" / name, scale);
    for (const double roughness : {0.3, 0.5, 0.7}) {
      const Patches::Compared c = patches.compared(roughness, widest);
      std::printf("  %-36s roughness %.1f: off by %6.2f %%, %6.2f %% without widening; each way %5.2f %%\n",
                  name, roughness, 100 * c.widened.energy, 100 * c.plain.energy, 100 * c.widened.each_way);
      sum.add(c);
    }
  }
  return sum;
}

struct Case {
  const char* what;
  double scale;  ///< of the bumps
  double widest; ///< angle of light and viewer to the normal
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.what; }
};

class SpecularEnergy : public testing::TestWithParam<Case> {};

TEST_P(SpecularEnergy, OfAMipLevelIsThatOfItsTexelsWithWidenedRoughness) {
  if (!std::filesystem::exists(SURFGRAD_SHARED_DIR "/assets/normal_tile")) GTEST_SKIP() << "no shared maps";
  const Means sum = measured(GetParam().scale, GetParam().widest);
  sum.print(GetParam().what);
  EXPECT_LT(sum.mean().energy, 5);
  EXPECT_LT(sum.mean().energy, sum.mean().plain);
  EXPECT_LT(sum.mean().each_way, 0.75 * sum.mean().plain_each_way);
}

INSTANTIATE_TEST_SUITE_P(Cases, SpecularEnergy,
                         testing::Values(Case{"light and viewer anywhere over the surface", 1,
                                              std::numbers::pi / 2},
                                         Case{"light and viewer within 1 radian of the normal", 1, 1.0},
                                         Case{"within 1 radian, bumps a quarter as high", 0.25, 1.0}),
                         [](const auto& one) { return "Case" + std::to_string(one.index); });

} // namespace
} // namespace surfgrad::bake
