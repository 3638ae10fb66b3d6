/// Noise, its sums and powers, and the elementary functions below them.

#include "conformance/rows.hpp"
#include "support/core_functions.hpp"

#include <surfgrad/fractal.hpp>
#include <surfgrad/noise.hpp>
#include <surfgrad/noise_hash.hpp>
#include <surfgrad/power.hpp>
#include <surfgrad/trigonometry.hpp>
#include <surfgrad/worley.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace surfgrad::test {
namespace {

using Exact = ShaderInputs<double>;

template <class T>
std::array<T, 4> flat(const Noise<T>& n) {
  return {n.value, n.gradient.x, n.gradient.y, n.gradient.z};
}

std::array<double, 4> value_and_gradient(double value, double gradient) {
  return {value, gradient, gradient, gradient};
}

constexpr std::uint32_t start = 987654321u;
// Ties of distances and signs of noise this near are decided by rounding.
constexpr double tie = 1e-5;

template <class T>
Noise<T> worley_at(vec3<T> p, WorleyKind kind) {
  return worley(p, kind, MovedLatticeHash<T>{start});
}

/// Distances to the three nearest feature points, at most 1 each.
std::array<double, 3> nearest_distances(vec3<double> p, std::uint32_t from) {
  const MovedLatticeHash<double> hash{from};
  const vec3<double> low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
  std::vector<double> distances{1, 1, 1};
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const std::uint32_t h =
            hash(static_cast<int>(low.x) + x, static_cast<int>(low.y) + y, static_cast<int>(low.z) + z);
        const auto feature = [&](double corner, int step, int bit) {
          return corner + step + 0.5 / 1024 + static_cast<double>((h >> bit) & 1023u) / 1024;
        };
        const vec3<double> d{p.x - feature(low.x, x, 0), p.y - feature(low.y, y, 10),
                             p.z - feature(low.z, z, 20)};
        distances.push_back(std::min(length(d), 1.0));
      }
  std::sort(distances.begin(), distances.end());
  return {distances[0], distances[1], distances[2]};
}

/// value 4 eps a distance, gradient 8 eps / distance; open where two distances tie.
std::array<double, 4> worley_bound(vec3<double> p, WorleyKind kind, std::uint32_t from) {
  const auto d = nearest_distances(p, from);
  const bool second = kind == WorleyKind::f2_minus_f1;
  const bool decided =
      d[1] - d[0] > tie && (!second || d[2] - d[1] > tie) && (second ? d[1] : d[0]) < 1 - tie;
  if (!decided && d[0] < 1 - tie) return {8, undecided, undecided, undecided};
  return value_and_gradient(second ? 8 : 4, 8 / d[0] + (second ? 8 / d[1] : 0));
}

/// Bounds of a basis at an octave's point.
using BasisBound = std::array<double, 4> (*)(vec3<double>);
std::array<double, 4> perlin_bound(vec3<double>) { return value_and_gradient(32, 128); }
std::array<double, 4> simplex_bound(vec3<double> p) {
  return value_and_gradient(64 * (1 + length(p)), 512 * (1 + length(p)));
}
std::array<double, 4> worley_f1_bound(vec3<double> p) { return worley_bound(p, WorleyKind::f1, 0); }
std::array<double, 4> worley_f2_bound(vec3<double> p) { return worley_bound(p, WorleyKind::f2_minus_f1, 0); }

struct Basis {
  const char* word;
  BasisBound bound;
  Noise<double> (*at)(vec3<double>);
};
const Basis bases[] = {
    {"PERLIN", perlin_bound, [](vec3<double> p) { return perlin(p); }},
    {"SIMPLEX", simplex_bound, [](vec3<double> p) { return simplex(p); }},
    {"WORLEY_F1", worley_f1_bound, [](vec3<double> p) { return worley(p, WorleyKind::f1); }},
    {"WORLEY_F2_MINUS_F1", worley_f2_bound,
     [](vec3<double> p) { return worley(p, WorleyKind::f2_minus_f1); }},
};

/// A basis for the core's sums, chosen by its place in `bases`.
template <class T>
auto basis_of(int index) {
  return [index](vec3<T> p) {
    switch (index) {
    case 0:
      return perlin(p);
    case 1:
      return simplex(p);
    case 2:
      return worley(p, WorleyKind::f1);
    default:
      return worley(p, WorleyKind::f2_minus_f1);
    }
  };
}

/// The documented bound of a sum: that of the basis times (lacunarity * gain)^i, octave by octave, and
/// 2 eps an octave of the largest term. Lacunarity 2 keeps every octave's point exact.
std::array<double, 4> sum_bound(const Basis& basis, vec3<double> p, double width, bool has_kinks) {
  constexpr int octaves = 4;
  std::array<double, 4> eps{};
  double frequency = 1;
  double amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    const vec3<double> q = frequency * p;
    const auto of_basis = basis.bound(q);
    const Noise<double> n = basis.at(q);
    // A ridge squares the crest: twice the error of the value, times the gradient.
    const double value = 2 * of_basis[0] + 2 * octaves;
    eps[0] += amplitude * value;
    const double slope = max_abs(n.gradient);
    for (int c = 1; c < 4; ++c) eps[c] += amplitude * frequency * (2 * of_basis[c] + slope * value);
    // The sign of an octave's value decides on that of its gradient.
    if (has_kinks && std::abs(n.value) < tie * 10)
      for (int c = 1; c < 4; ++c) eps[c] = undecided;
    frequency *= 2;
    amplitude *= 0.5;
  }
  (void)width;
  return eps;
}

enum class Sum { fractal, turbulence, ridged };

template <class T>
Noise<T> sum_of(Sum sum, vec3<T> p, T width, int basis) {
  const Fractal<T> fractal{4, T(2), T(0.5)};
  switch (sum) {
  case Sum::fractal:
    return fractal_sum(p, fractal, width, basis_of<T>(basis));
  case Sum::turbulence:
    return turbulence(p, fractal, width, basis_of<T>(basis));
  default:
    return ridged(p, fractal, width, basis_of<T>(basis));
  }
}

void add_sums(std::vector<Row>& rows) {
  const std::pair<Sum, const char*> sums[] = {
      {Sum::fractal, "fractal_sum"}, {Sum::turbulence, "turbulence"}, {Sum::ridged, "ridged"}};
  for (const auto& [sum, word] : sums) {
    rows.push_back(make_row(
        word, std::string("put_noise(surfgrad_") + word + "($place, fractal(4, 2.0, 0.5), $width))",
        [sum = sum](const auto& in) { return flat(sum_of(sum, in.place, in.width, 0)); },
        [sum = sum](const Exact& in) {
          return sum_bound(bases[0], in.place, in.width, sum != Sum::fractal);
        }));
    for (int b = 1; b < 4; ++b)
      rows.push_back(make_row(
          std::string(word) + " of " + bases[b].word,
          std::string("put_noise(surfgrad_") + word +
              "($place, fractal(4, 2.0, 0.5), $width, SURFGRAD_BASIS_" + bases[b].word + "))",
          [sum = sum, b](const auto& in) { return flat(sum_of(sum, in.place, in.width, b)); },
          [sum = sum, b](const Exact& in) {
            return sum_bound(bases[b], in.place, in.width, sum != Sum::fractal);
          }));
  }
}

/// A function for differences: smooth, and in the shaders' harness too.
template <class T>
T hills(vec3<T> p) {
  return p.x * p.x + p.y * p.z - T(0.5) * p.z * p.z;
}

/// What a sum of one's own is made of.
void add_octaves(std::vector<Row>& rows) {
  rows.push_back(make_row(
      "octave_visibility", "put1(surfgrad_octave_visibility($turn))",
      [](const auto& in) { return std::array{detail::octave_visibility(in.turn)}; },
      [](const Exact&) { return std::array{16.0}; })); // 1 - t^2 (3 - 2 t) and its t = 2 x - 1/2
  rows.push_back(make_row(
      "basis_noise", "put_noise(surfgrad_basis_noise($place, SURFGRAD_BASIS_SIMPLEX, 987654321u))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return flat(simplex(in.place, MovedLatticeHash<T>{start}));
      },
      [](const Exact& in) { return simplex_bound(in.place); }));
  // An octave is a sum of one octave, of the noise that is added.
  const auto octave = [&](Sum sum, const char* word) {
    rows.push_back(make_row(
        std::string(word) + "_octave",
        std::string("put_noise(surfgrad_") + word + "_octave(noise($height_map.x, $gradient)))",
        [sum](const auto& in) {
          using T = std::decay_t<decltype(in.fade)>;
          const Noise<T> n{in.height_map.x, in.core.gradient};
          const auto basis = [n](vec3<T>) { return n; };
          const Fractal<T> one{1, T(2), T(1)};
          return flat(sum == Sum::turbulence ? turbulence(in.place, one, T(0), basis)
                                             : ridged(in.place, one, T(0), basis));
        },
        [](const Exact& in) {
          const double slope = 6 * max_abs(in.core.gradient);
          return std::array{4.0, slope, slope, slope};
        }));
  };
  octave(Sum::turbulence, "turbulence");
  octave(Sum::ridged, "ridged");
  rows.push_back(make_row(
      "add_octave",
      "put_noise(surfgrad_add_octave(noise($alpha, $tangent), noise($height_map.x, $gradient), 2.0, 0.5, "
      "$width))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        const T weight = T(0.5) * detail::octave_visibility(T(2) * in.width);
        const vec3<T> gradient = in.core.tangent + (weight * T(2)) * in.core.gradient;
        return std::array{in.alpha + weight * in.height_map.x, gradient.x, gradient.y, gradient.z};
      },
      [](const Exact& in) {
        const vec3<double> slope = 18.0 * (absolute(in.core.tangent) + absolute(in.core.gradient));
        return std::array{18 * (in.alpha + std::abs(in.height_map.x)), slope.x, slope.y, slope.z};
      }));
}

void add_elementary(std::vector<Row>& rows) {
  rows.push_back(make_row(
      "log2", "put1(surfgrad_log2($positive))", [](const auto& in) { return std::array{log2(in.positive)}; },
      [](const Exact& in) { return std::array{vulkan_log2_error(std::log2(in.positive))}; }));
  rows.push_back(make_row(
      "exp2", "put1(surfgrad_exp2($far.x))", [](const auto& in) { return std::array{exp2(in.far.x)}; },
      [](const Exact& in) { return std::array{vulkan_exp2_error(in.far.x) * std::exp2(in.far.x)}; }));
  rows.push_back(make_row(
      "pow", "put1(surfgrad_pow($positive, $exponent))",
      [](const auto& in) { return std::array{pow(in.positive, in.exponent)}; },
      [](const Exact& in) {
        return std::array{vulkan_pow_error(in.positive, in.exponent) * std::pow(in.positive, in.exponent)};
      }));
  rows.push_back(make_row(
      "sin_cos_turns", "put_sin_cos(surfgrad_sin_cos_turns($far.y))",
      [](const auto& in) {
        const auto r = sin_cos_turns(in.far.y);
        return std::array{r.sin, r.cos};
      },
      [](const Exact& in) { // 1.5 ulp: nowhere a division
        const auto r = sin_cos_turns(in.far.y);
        return std::array{1.5 * std::abs(r.sin), 1.5 * std::abs(r.cos)};
      }));
  const auto differences = [&](const char* name, const char* call) {
    rows.push_back(make_row(
        name, call,
        [](const auto& in) {
          using T = std::decay_t<decltype(in.fade)>;
          return test::flat(
              gradient_by_differences([](vec3<T> p) { return hills(p); }, in.core.gradient, T(0.015625)));
        },
        [](const Exact& in) { // 3 eps of the terms of f on either side, over the step
          const double size = 1 + max_abs(in.core.gradient);
          return all_within<3>(3 * size * size / 0.015625);
        }));
  };
  differences("gradient_by_differences",
              "put3(surfgrad_gradient_by_differences($gradient, 0.015625, hills_beside($gradient, 0.015625), "
              "hills_beside($gradient, -0.015625)))");
  differences("gradient_by_differences: macro", "put3(gradient_of_hills($gradient, 0.015625))");
  const auto forward = [&](const char* name, const char* call) {
    rows.push_back(make_row(
        name, call,
        [](const auto& in) {
          using T = std::decay_t<decltype(in.fade)>;
          return test::flat(gradient_by_forward_differences(
              [](vec3<T> p) { return hills(p); }, in.core.gradient, hills(in.core.gradient), T(0.015625)));
        },
        [](const Exact& in) {
          const double size = 1 + max_abs(in.core.gradient);
          return all_within<3>(6 * size * size / 0.015625);
        }));
  };
  forward("gradient_by_forward_differences",
          "put3(surfgrad_gradient_by_forward_differences($gradient, 0.015625, hills_beside($gradient, "
          "0.015625), hills($gradient)))");
  forward("gradient_by_forward_differences: macro", "put3(forward_gradient_of_hills($gradient, 0.015625))");
}

void add_hashes(std::vector<Row>& rows) {
  // Words as their two halves: exact in float.
  const auto halves = [](std::uint32_t word) {
    return std::array{static_cast<double>(word & 0xffffu), static_cast<double>(word >> 16)};
  };
  rows.push_back(make_row(
      "lattice_hash", "put_word(surfgrad_lattice_hash(whole($place.x), whole($place.y), whole($place.z)))",
      [halves](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        const auto whole = [](T v) { return to_index(min(max(std::floor(v), T(-5e8)), T(5e8))); };
        return halves(lattice_hash<T>(whole(in.place.x), whole(in.place.y), whole(in.place.z)));
      },
      [](const Exact&) {
        return std::array{0.0, 0.0};
      }));
  rows.push_back(make_row(
      "lattice_start", "put_word(surfgrad_lattice_start(4000000000u, 7u, 123456789u))",
      [halves](const auto&) { return halves(lattice_start(4000000000u, 7u, 123456789u)); },
      [](const Exact&) {
        return std::array{0.0, 0.0};
      }));
}

} // namespace

void add_noise_rows(std::vector<Row>& rows) {
  add_elementary(rows);
  add_hashes(rows);
  rows.push_back(make_row(
      "perlin", "put_noise(surfgrad_perlin($place))", [](const auto& in) { return flat(perlin(in.place)); },
      [](const Exact& in) { return perlin_bound(in.place); }));
  rows.push_back(make_row(
      "perlin: moved", "put_noise(surfgrad_perlin($place, 987654321u))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return flat(perlin(in.place, MovedLatticeHash<T>{start}));
      },
      [](const Exact& in) { return perlin_bound(in.place); }));
  rows.push_back(make_row(
      "simplex", "put_noise(surfgrad_simplex($place))",
      [](const auto& in) { return flat(simplex(in.place)); },
      [](const Exact& in) { return simplex_bound(in.place); }));
  rows.push_back(make_row(
      "simplex: moved", "put_noise(surfgrad_simplex($place, 987654321u))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return flat(simplex(in.place, MovedLatticeHash<T>{start}));
      },
      [](const Exact& in) { return simplex_bound(in.place); }));
  rows.push_back(make_row(
      "worley", "put_noise(surfgrad_worley($place))", [](const auto& in) { return flat(worley(in.place)); },
      [](const Exact& in) { return worley_bound(in.place, WorleyKind::f1, 0); }));
  rows.push_back(make_row(
      "worley: f2 - f1", "put_noise(surfgrad_worley($place, SURFGRAD_WORLEY_KIND_F2_MINUS_F1))",
      [](const auto& in) { return flat(worley(in.place, WorleyKind::f2_minus_f1)); },
      [](const Exact& in) { return worley_bound(in.place, WorleyKind::f2_minus_f1, 0); }));
  rows.push_back(make_row(
      "worley: moved", "put_noise(surfgrad_worley($place, SURFGRAD_WORLEY_KIND_F1, 987654321u))",
      [](const auto& in) { return flat(worley_at(in.place, WorleyKind::f1)); },
      [](const Exact& in) { return worley_bound(in.place, WorleyKind::f1, start); }));
  rows.push_back(make_row(
      "power", "put_noise(surfgrad_power(noise($positive, $gradient), $exponent))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return flat(power(Noise<T>{in.positive, in.core.gradient}, in.exponent));
      },
      [](const Exact& in) {
        const auto n = flat(power(Noise<double>{in.positive, in.core.gradient}, in.exponent));
        const double relative = vulkan_pow_error(in.positive, in.exponent - 1) + 2;
        return std::array{relative * std::abs(n[0]), relative * std::abs(n[1]), relative * std::abs(n[2]),
                          relative * std::abs(n[3])};
      }));
  rows.back().nan = NanPolicy::may_vanish; // its results saturate
  add_octaves(rows);
  add_sums(rows);
}

} // namespace surfgrad::test
