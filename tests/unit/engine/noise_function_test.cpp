// Noise functions of the stack and functions that a program brings: values, exact gradients, lanes.

#include "engine/noise_function.hpp"
#include "simd/emulated_lanes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"
#include "unit/core/gradient_check.hpp"

#include <bit>
#include <string>
#include <vector>

namespace surfgrad::engine {
namespace {

using simd::emulated_width;
using simd::EmulatedFloat;
using stack::NoiseBasis;
using stack::NoiseFunction;
using stack::NoiseKind;
using stack::VolumeFunction;
using test::Random;

constexpr std::uint64_t seed = 20240701;

struct Case {
  std::string name;
  NoiseFunction function;
};

/// Every function over every basis.
std::vector<Case> every_function() {
  NoiseFunction f;
  f.octaves = 3;
  f.lacunarity = 1.9;
  f.gain = 0.6;
  f.frequency = 1.7;
  f.offset = {0.3, -2.1, 5.2};
  std::vector<Case> cases;
  for (const auto& kind : stack::words_of<NoiseKind>) {
    f.function = kind.value;
    const bool alone = kind.value == NoiseKind::perlin || kind.value == NoiseKind::simplex ||
                       kind.value == NoiseKind::worley;
    for (const auto& basis : stack::words_of<NoiseBasis>) {
      f.basis = basis.value;
      const bool cells = kind.value == NoiseKind::worley || (!alone && basis.value == NoiseBasis::worley);
      for (const auto& worley : stack::words_of<WorleyKind>) {
        f.worley = worley.value;
        if (!cells && worley.value != WorleyKind::f1) continue;
        std::string name(kind.text);
        if (!alone) name.append(" of ").append(basis.text);
        if (cells) name.append(" ").append(worley.text);
        cases.push_back({name, f});
      }
      if (alone) break;
    }
  }
  return cases;
}

bool has_kinks(const NoiseFunction& f) {
  const bool alone_smooth = f.function == NoiseKind::perlin || f.function == NoiseKind::simplex;
  const bool smooth_sum = f.function == NoiseKind::fractal_sum && f.basis != NoiseBasis::worley;
  return !alone_smooth && !smooth_sum;
}

/// The function with its largest gradient scaled to 4, a first octave's: check_gradient tells kinks from
/// rounding at that size.
test::GradientCheck check_scaled(const NoiseFunction& f, double width) {
  double largest = 0;
  test::PointSource points(seed, 6);
  for (int i = 0; i < 2000; ++i) largest = std::max(largest, length(evaluate(f, points(), width).gradient));
  const double scale = 4 / largest;
  return test::check_gradient(
      [&](vec3<double> p) {
        const Noise<double> n = evaluate(f, p, width);
        return Noise<double>{scale * n.value, scale * n.gradient};
      },
      test::PointSource(seed, 6), 2000, 0x1p-19);
}

TEST(NoiseFunction, GradientByThePositionIsExact) {
  int cases = 0;
  // Whole; with octaves in the middle of their fade; raised to a power that makes dents.
  for (const auto& [width, power] : {std::pair{0.0, 1.0}, {0.12, 1.0}, {0.0, 2.5}, {0.12, 3.0}}) {
    for (Case c : every_function()) {
      c.function.power = power;
      const test::GradientCheck check = check_scaled(c.function, width);
      test::print((c.name + ", width " + std::to_string(width) + ", power " + std::to_string(power)).c_str(),
                  check);
      EXPECT_NEAR(check.largest_gradient, 4, 1e-9) << c.name;
      EXPECT_LT(check.relative_error(), 1e-6) << c.name; // the project's bound for exact gradients
      if (has_kinks(c.function))
        EXPECT_LT(check.kink_share(), 0.01) << c.name;
      else
        EXPECT_EQ(check.kinks, 0) << c.name;
      ++cases;
    }
  }
  EXPECT_EQ(cases, 4 * 16);
}

/// A noise from the core, and what its octaves make of it, from the definition.
double defined(const NoiseFunction& f, vec3<double> position, double width) {
  const auto noise = [&](NoiseBasis basis, vec3<double> p) {
    return basis == NoiseBasis::perlin    ? perlin(p).value
           : basis == NoiseBasis::simplex ? simplex(p).value
                                          : worley(p, f.worley).value;
  };
  const auto visible = [](double cells) {
    const double t = std::clamp((cells - 0.25) / 0.5, 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
  };
  const vec3<double> p = f.frequency * (position - f.offset);
  double sum = 0;
  switch (f.function) {
  case NoiseKind::perlin:
    sum = visible(f.frequency * width) * noise(NoiseBasis::perlin, p);
    break;
  case NoiseKind::simplex:
    sum = visible(f.frequency * width) * noise(NoiseBasis::simplex, p);
    break;
  case NoiseKind::worley:
    sum = visible(f.frequency * width) * noise(NoiseBasis::worley, p);
    break;
  default:
    for (int i = 0; i < f.octaves; ++i) {
      const double frequency = std::pow(f.lacunarity, i);
      const double v = noise(f.basis, frequency * p);
      const double crest = 1 - std::abs(v);
      sum += std::pow(f.gain, i) * visible(frequency * f.frequency * width) *
             (f.function == NoiseKind::turbulence ? std::abs(v)
              : f.function == NoiseKind::ridged   ? crest * crest
                                                  : v);
    }
  }
  return f.power == 1 ? sum : std::pow(std::max(sum, 0.0), f.power);
}

TEST(NoiseFunction, ValueIsThatOfTheDefinition) {
  Random random(seed);
  // Coordinates reach some 80 cells: their rounding times the slope, some 100 eps.
  test::Worst worst("value against the definition");
  for (Case c : every_function())
    for (int i = 0; i < 500; ++i) {
      c.function.power = i % 3 == 0 ? 1.0 : random.uniform(0.5, 4);
      const vec3<double> p = random.vector3(-6, 6);
      const double width = i % 2 == 0 ? 0.0 : random.uniform(0, 0.3);
      worst.add(evaluate(c.function, p, width).value, defined(c.function, p, width), 1e-11, i);
    }
}

TEST(NoiseFunction, OffsetMovesThePatternByThatMuch) {
  Random random(seed);
  NoiseFunction f;
  f.frequency = 3;
  const NoiseFunction still = f;
  f.offset = {0.5, -1.25, 2};
  for (int i = 0; i < 100; ++i) {
    const vec3<double> p = random.vector3();
    const Noise<double> moved = evaluate(f, p + f.offset, 0.0);
    const Noise<double> here = evaluate(still, p, 0.0);
    EXPECT_NEAR(moved.value, here.value, 1e-13);
    EXPECT_NEAR(max_abs(moved.gradient - here.gradient), 0, 1e-12);
  }
}

TEST(NoiseFunction, FadesOutAsThePixelNearsACell) {
  const vec3<double> p{0.3, -1.7, 2.2};
  for (Case c : every_function()) {
    c.function.octaves = 1;
    const Noise<double> whole = evaluate(c.function, p, 0.0);
    EXPECT_NE(max_abs(whole.gradient), 0) << c.name;
    EXPECT_EQ(evaluate(c.function, p, 0.25 / c.function.frequency).value, whole.value) << c.name;
    EXPECT_NEAR(evaluate(c.function, p, 0.5 / c.function.frequency).value, whole.value / 2, 1e-15) << c.name;
    EXPECT_NEAR(max_abs(evaluate(c.function, p, 0.751 / c.function.frequency).gradient), 0, 0) << c.name;
  }
}

template <class T>
void expect_finite_at_extremes() {
  constexpr T inf = std::numeric_limits<T>::infinity();
  constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  for (Case c : every_function())
    for (const double frequency : {5e-324, 1.0, 1e12})
      for (const double power : {5e-324, 0.5, 1.0, 30.0, 1e12})
        for (const T x : {T(0), T(0.3), T(-1e12), inf, nan})
          for (const T width : {T(0), T(0.1), inf, nan}) {
            c.function.gain = 1;
            c.function.octaves = 16;
            c.function.frequency = frequency;
            c.function.power = power;
            const Noise<T> n = evaluate(c.function, vec3<T>{x, T(0.7), x}, width);
            EXPECT_TRUE(std::isfinite(n.value) && std::isfinite(max_abs(n.gradient)))
                << c.name << ", frequency " << frequency << ", power " << power << ", x " << x << ", width "
                << width;
          }
}

TEST(NoiseFunction, StaysFiniteForEveryParameterADocumentMayHold) {
  expect_finite_at_extremes<float>();
  expect_finite_at_extremes<double>();
}

/// Compares a pack of points and pixel sizes with one lane at a time, bit for bit.
template <class Call>
void expect_equal_lanes(const std::string& name, Call call) {
  Random random(seed);
  for (int round = 0; round < 50; ++round) {
    std::array<vec3<float>, emulated_width> points;
    std::array<float, emulated_width> widths;
    vec3<EmulatedFloat> together;
    EmulatedFloat width;
    for (std::size_t i = 0; i < emulated_width; ++i) {
      const vec3<double> p = random.vector3(-6, 6);
      points[i] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      together.x.lane[i] = points[i].x;
      together.y.lane[i] = points[i].y;
      together.z.lane[i] = points[i].z;
      width.lane[i] = widths[i] = static_cast<float>(random.uniform(-0.1, 0.5));
    }
    const Noise<EmulatedFloat> packed = call(together, width);
    for (std::size_t i = 0; i < emulated_width; ++i) {
      const Noise<float> alone = call(points[i], widths[i]);
      const auto same = [&](const EmulatedFloat& got, float expected) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(got.lane[i]), std::bit_cast<std::uint32_t>(expected))
            << name << ", seed " << seed << ", round " << round << ", lane " << i;
      };
      same(packed.value, alone.value);
      same(packed.gradient.x, alone.gradient.x);
      same(packed.gradient.y, alone.gradient.y);
      same(packed.gradient.z, alone.gradient.z);
    }
  }
}

TEST(NoiseFunction, LanesEqualFloatBitForBit) {
  for (const double power : {1.0, 2.5})
    for (Case c : every_function()) {
      c.function.power = power;
      expect_equal_lanes(c.name, [&](auto p, auto width) { return evaluate(c.function, p, width); });
    }
}

// ------------------------------------------------------------------------ functions of a program

double rings(vec3<double> p) { return std::sin(5 * std::sqrt(p.x * p.x + p.z * p.z + 1) + p.y); }

Noise<double> rings_with_gradient(vec3<double> p) {
  const double r = std::sqrt(p.x * p.x + p.z * p.z + 1);
  const double slope = std::cos(5 * r + p.y);
  return {std::sin(5 * r + p.y), slope * vec3<double>{5 * p.x / r, 1, 5 * p.z / r}};
}

TEST(VolumeFunction, UsesItsOwnGradientOrDifferences) {
  const VolumeFunction exact(rings_with_gradient);
  constexpr double step = 1e-4;
  const VolumeFunction values(rings, step);
  Random random(seed);
  double difference = 0;
  for (int i = 0; i < 1000; ++i) {
    const vec3<double> p = random.vector3(-3, 3);
    const Noise<double> own = evaluate(exact, p);
    EXPECT_EQ(own.value, rings(p));
    EXPECT_EQ(own.gradient.x, rings_with_gradient(p).gradient.x);
    const Noise<double> approximate = evaluate(values, p);
    EXPECT_EQ(approximate.value, rings(p));
    difference = std::max(difference, max_abs(approximate.gradient - own.gradient));
  }
  std::cout << "central differences of step " << step << ": worst error " << difference << "\n";
  // step^2 / 6 times the third derivative, at most 5^3 and the bends of the radius; and not exact.
  EXPECT_LT(difference, step * step / 6 * 300);
  EXPECT_GT(difference, 0);
}

TEST(VolumeFunction, RunsOnFloatsAndLaneByLane) {
  const VolumeFunction function(rings_with_gradient);
  const Noise<float> narrow = evaluate(function, vec3<float>{0.5f, 0.25f, -2});
  const Noise<double> wide = function({0.5, 0.25, -2});
  EXPECT_EQ(narrow.value, static_cast<float>(wide.value));
  EXPECT_EQ(narrow.gradient.z, static_cast<float>(wide.gradient.z));
  expect_equal_lanes("rings", [&](auto p, auto) { return evaluate(function, p); });
}

TEST(VolumeFunction, HoldsState) {
  const double steepness = 3;
  const VolumeFunction function([steepness](vec3<double> p) { return steepness * p.y; }, 0.5);
  EXPECT_EQ(function({7, 1, 2}).value, 3);
  EXPECT_EQ(function({7, 1, 2}).gradient.y, 3);
  EXPECT_EQ(function({7, 1, 2}).gradient.x, 0);
}

} // namespace
} // namespace surfgrad::engine
