// What a mip level reflects against what it stands for: the widened roughness holds the energy.

#include "image/map.hpp"
#include "io/image_file.hpp"
#include "support/random.hpp"

#include <surfgrad/derivative.hpp>
#include <surfgrad/moments.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <vector>

namespace surfgrad {
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

vec3<double> direction(test::Random& random, double widest) {
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const double tilt = random.uniform(0, widest);
  return {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)};
}

/// Relative errors of what is reflected.
struct Losses {
  double widened = 0;  ///< of the mean over all lights and viewers
  double plain = 0;    ///< the same without widening
  double each_way = 0; ///< mean of the errors, with widening, for each light and viewer
};

/// A normal map as slopes and their squares, with mip levels.
struct Moments {
  image::SlopeMap slopes;
  image::Map squares;
};

Moments moments_of(const std::filesystem::path& file) {
  Moments result{image::make_slope_map(io::read_image(file), image::NormalChannels::automatic, true), {}};
  result.squares = image::make_slope_moments(result.slopes.map);
  return result;
}

/// Patches of 16x16 texels lit and seen from many sides, against one texel of level 4.
///
/// scale  of the bumps
Losses losses_of(const Moments& map, double scale, double alpha, test::Random& random) {
  constexpr int level = 4;
  const image::Map& slopes = map.slopes.map;
  const image::Map& squares = map.squares;
  const int side = 1 << level;
  const auto normal = [&](vec2<double> slope) { return normal_from_derivative(scale * slope); };
  double truth = 0, energy = 0, plain_energy = 0, error = 0;
  for (int pair = 0; pair < 64; ++pair) {
    const vec3<double> to_viewer = direction(random, 1.0);
    const vec3<double> to_light = direction(random, 1.0);
    double fine = 0, coarse = 0, plain = 0;
    for (int patch = 0; patch < 64; ++patch) {
      const int x = random.integer(slopes.width(level));
      const int y = random.integer(slopes.height(level));
      for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
          const int u = x * side + i;
          const int v = y * side + j;
          fine += reflected(normal({slopes.value(0, u, v, 0), slopes.value(0, u, v, 1)}), to_viewer, to_light,
                            alpha) /
                  (side * side);
        }
      const SlopeMoments<double> m{{slopes.value(level, x, y, 0), slopes.value(level, x, y, 1)},
                                   {squares.value(level, x, y, 0), squares.value(level, x, y, 1)},
                                   squares.value(level, x, y, 2)};
      const SlopeMoments<double> scaled{scale * m.mean, scale * scale * m.square, scale * scale * m.product};
      coarse += reflected(normal(m.mean), to_viewer, to_light, roughness_from_moments(alpha, scaled));
      plain += reflected(normal(m.mean), to_viewer, to_light, alpha);
    }
    truth += fine;
    energy += coarse;
    plain_energy += plain;
    error += std::abs(coarse - fine);
  }
  return {std::abs(energy / truth - 1), std::abs(plain_energy / truth - 1), error / truth};
}

/// Means over some maps.
struct Means {
  Losses sum{};
  int count = 0;
  void add(const Losses& losses) {
    sum.widened += losses.widened;
    sum.plain += losses.plain;
    sum.each_way += losses.each_way;
    ++count;
  }
  void print(const char* what) const {
    std::printf("  %s: off by %.2f %%, %.2f %% without widening; %.2f %% each way\n", what,
                percent(sum.widened), percent(sum.plain), percent(sum.each_way));
  }
  [[nodiscard]] double percent(double value) const { return 100 * value / count; }
};

// Widening takes slopes for normally distributed. They are not where texels point into the surface or nearly
// so (their slopes are clamped at 128, and one of them outweighs a patch), and where bumps hide each other.
TEST(SpecularEnergy, OfAMipLevelIsThatOfItsTexelsWithWidenedRoughness) {
  const std::filesystem::path tiles = SURFGRAD_SHARED_DIR "/assets/normal_tile";
  if (!std::filesystem::exists(tiles)) GTEST_SKIP() << tiles << " is absent";
  constexpr unsigned seed = 1771;
  Means whole, quarter;
  for (const char* name :
       {"yughues_242/pattern_242_normal.png", "ogre_nm/NMBalls.png", "ogre_nm/NMStripes.png",
        "mmikk_details/Pirate_details.png", "mmikk_details/sofa.png", "mmikk_details/details.png",
        "mx_mesh_wire/mesh_wire_norm.png"}) {
    const Moments map = moments_of(tiles / name);
    for (const double roughness : {0.3, 0.5, 0.7}) {
      test::Random random(seed);
      const Losses losses = losses_of(map, 1, roughness * roughness, random);
      std::printf(
          "  %-36s roughness %.1f: off by %5.2f %%, %6.2f %% without widening; %5.2f %% each way; %lld "
          "texels point inwards\n",
          name, roughness, 100 * losses.widened, 100 * losses.plain, 100 * losses.each_way,
          static_cast<long long>(map.slopes.inward_texels));
      whole.add(losses);
      if (map.slopes.inward_texels == 0) quarter.add(losses_of(map, 0.25, roughness * roughness, random));
    }
  }
  std::printf("  seed %u\n", seed);
  whole.print("all maps");
  quarter.print("those without texels that point inwards, bumps a quarter as high");
  EXPECT_LT(whole.sum.widened, 0.5 * whole.sum.plain);
  EXPECT_LT(quarter.percent(quarter.sum.widened), 5);
}

} // namespace
} // namespace surfgrad
