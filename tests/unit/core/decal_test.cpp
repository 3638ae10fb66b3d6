#include <surfgrad/decal.hpp>
#include <surfgrad/screen.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <limits>
#include <random>

namespace surfgrad {
namespace {

using vector3 = vec3<double>;
constexpr std::uint64_t seed = 20240614;
// Differences of smooth functions of order one: step^4 beside eps / step, some 1e-11.
constexpr double step = 1e-4;
constexpr double exactness = 1e-6; // the project's bound for exact gradients, relative to the largest

std::mt19937_64& engine() {
  static std::mt19937_64 e(seed);
  return e;
}
double uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine());
}
vector3 random_direction() {
  vector3 v{};
  do v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
  while (length(v) > 1 || length(v) < 0.1);
  return normalize_or_zero(v);
}
DecalFrame<double> random_frame() {
  const vector3 z = random_direction();
  const vector3 x = normalize_or_zero(cross(random_direction(), z));
  const double handedness = uniform(-1, 1) < 0 ? -1 : 1;
  return {{uniform(-2, 2), uniform(-2, 2), uniform(-2, 2)}, x, handedness * cross(z, x), z};
}
vector3 in_space(const DecalFrame<double>& frame, vector3 q) {
  return frame.origin + q.x * frame.axis_x + q.y * frame.axis_y + q.z * frame.axis_z;
}

/// Gradient of f at p from its values alone (Richardson-extrapolated central differences).
vector3 differences(const std::function<double(vector3)>& f, vector3 p) {
  const auto along = [&](vector3 unit) {
    const auto central = [&](double h) { return (f(p + h * unit) - f(p - h * unit)) / (2 * h); };
    return (4 * central(step / 2) - central(step)) / 3;
  };
  return {along({1, 0, 0}), along({0, 1, 0}), along({0, 0, 1})};
}

/// A bump of the image, and its derivative along s and t.
double image_height(vec2<double> st) { return std::sin(5 * st.x) * std::cos(3 * st.y) + st.x * st.y; }
vec2<double> image_derivative(vec2<double> st) {
  return {5 * std::cos(5 * st.x) * std::cos(3 * st.y) + st.y,
          -3 * std::sin(5 * st.x) * std::sin(3 * st.y) + st.x};
}

using Shape = std::function<DecalProjection<double>(const DecalFrame<double>&, vector3)>;

/// Compares grad_s, grad_t and the volume gradient of a height with differences over random frames and
/// points of the local box low..high. Points within a step of the surface, or where near_kink holds, are
/// left out.
void expect_exact_gradients(
    const char* name, const Shape& shape, vector3 low, vector3 high,
    const std::function<bool(vector3)>& near_kink = [](vector3) { return false; }) {
  double worst = 0, largest = 0;
  int used = 0, left_out = 0;
  while (used < 3000) {
    const DecalFrame<double> frame = random_frame();
    const vector3 q{uniform(low.x, high.x), uniform(low.y, high.y), uniform(low.z, high.z)};
    const vector3 p = in_space(frame, q);
    const DecalProjection<double> here = shape(frame, p);
    if (!here.inside) continue;
    bool at_surface = near_kink(q);
    for (const vector3 d : {vector3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
      at_surface |= !shape(frame, p + step * d).inside || !shape(frame, p - step * d).inside;
    }
    if (at_surface) {
      ++left_out;
      continue;
    }
    ++used;
    const auto compare = [&](vector3 claimed, const std::function<double(DecalProjection<double>)>& f) {
      const vector3 truth = differences([&](vector3 at) { return f(shape(frame, at)); }, p);
      worst = std::max(worst, max_abs(claimed - truth));
      largest = std::max(largest, max_abs(truth));
    };
    compare(here.grad_s, [](const auto& d) { return d.texture_coordinate.x; });
    compare(here.grad_t, [](const auto& d) { return d.texture_coordinate.y; });
    compare(decal_gradient(image_derivative(here.texture_coordinate), here.grad_s, here.grad_t),
            [](const auto& d) { return image_height(d.texture_coordinate); });
  }
  std::cout << name << ": worst gradient error " << worst << " of " << largest << ", " << left_out
            << " points left out (seed " << seed << ")\n";
  EXPECT_LT(worst, exactness * largest) << name;
  EXPECT_LT(left_out, 30) << name;
}

TEST(DecalGradient, IsListingFifteen) {
  const vector3 x{1, 0, 0}, y{0, 0.6, 0.8};
  const vector3 g = decal_gradient(vec2<double>{2, -5}, x, y);
  EXPECT_EQ(g.x, 2);
  EXPECT_EQ(g.y, -3);
  EXPECT_EQ(g.z, -4);
  const vector3 n{0, 0, 1};
  const vector3 s = from_decal(n, vec2<double>{2, -5}, x, y);
  EXPECT_EQ(s.x, 2);
  EXPECT_EQ(s.y, -3);
  EXPECT_EQ(s.z, 0);
}

TEST(DecalGradient, ManyDecalsMayBeSummedBeforeTheNormalIsKnown) {
  for (int i = 0; i < 200; ++i) {
    const vector3 n = random_direction();
    vector3 volume{}, surface{};
    for (int decal = 0; decal < 5; ++decal) {
      const DecalFrame<double> f = random_frame();
      const vec2<double> deriv{uniform(-2, 2), uniform(-2, 2)};
      const double falloff = uniform(0, 1);
      volume = volume + falloff * decal_gradient(deriv, f.axis_x, f.axis_y);
      surface = surface + falloff * from_decal(n, deriv, f.axis_x, f.axis_y);
    }
    // Linear: only the rounding of a few dozen operations on numbers below 20 remains.
    EXPECT_LT(max_abs(from_volume_gradient(n, volume) - surface), 1e-14);
  }
}

TEST(BoxDecal, GradientsAreExact) {
  expect_exact_gradients("box",
                         [](const auto& f, vector3 p) {
                           return box_decal(f, p, vector3{0.5, 1.5, 2}, 0.2);
                         },
                         {-0.5, -1.5, -2}, {0.5, 1.5, 2});
}

TEST(ConeDecal, GradientsIncludeThePerspectiveTerm) {
  for (const ConeGradient kind : {ConeGradient::exact, ConeGradient::scale_free}) {
    expect_exact_gradients("cone",
                           [kind](const auto& f, vector3 p) { return cone_decal(f, p, 0.7, 3.0, 0.2, kind); },
                           {-2, -2, 0.5}, {2, 2, 3});
  }
}

TEST(WedgeDecal, GradientsAreExactAwayFromTheSegmentsEnds) {
  expect_exact_gradients(
      "wedge", [](const auto& f, vector3 p) { return wedge_decal(f, p, 0.8, 0.7, 3.0, 0.2); },
      {-2.5, -2, 0.5}, {2.5, 2, 3}, [](vector3 q) { return std::abs(std::abs(q.x) - 0.8) < 2 * step; });
}

TEST(Decals, CoverTheirImageFromCornerToCorner) {
  const DecalFrame<double> f{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto box = box_decal(f, vector3{1 + 0.4999, 2 - 1.4999, 3.5}, vector3{0.5, 1.5, 2}, 0.0);
  EXPECT_NEAR(box.texture_coordinate.x, 1, 1e-3);
  EXPECT_NEAR(box.texture_coordinate.y, 0, 1e-3);
  const auto middle = cone_decal(f, vector3{1, 2, 5}, 0.5, 3.0, 0.0);
  EXPECT_EQ(middle.texture_coordinate.x, 0.5);
  EXPECT_EQ(middle.texture_coordinate.y, 0.5);
  const auto rim = cone_decal(f, vector3{1 - 0.9999, 2, 5}, 0.5, 3.0, 0.0); // the radius there is 1
  EXPECT_NEAR(rim.texture_coordinate.x, 0, 1e-3);
}

TEST(Decals, SlopeAxesAreTheGradientsTimesTheImagesSize) {
  for (int i = 0; i < 200; ++i) {
    const DecalFrame<double> f = random_frame();
    const vector3 q{uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(0.5, 1)};
    const auto box = box_decal(f, in_space(f, q), vector3{0.5, 1.5, 2}, 0.1);
    EXPECT_LT(max_abs(box.axis_s - 1.0 * box.grad_s), 1e-14);
    EXPECT_LT(max_abs(box.axis_t - 3.0 * box.grad_t), 1e-14);
    EXPECT_LT(max_abs(box.axis_s - f.axis_x), 1e-14);
    const auto cone = cone_decal(f, in_space(f, q), 0.7, 3.0, 0.1);
    EXPECT_LT(max_abs(cone.axis_s - (2 * 0.7 * q.z) * cone.grad_s), 1e-14);
    EXPECT_LT(max_abs(cone.axis_t - (2 * 0.7 * q.z) * cone.grad_t), 1e-14);
    const auto flat = cone_decal(f, in_space(f, q), 0.7, 3.0, 0.1, ConeGradient::scale_free);
    EXPECT_EQ(max_abs(flat.axis_s - f.axis_x), 0);
    EXPECT_EQ(max_abs(flat.axis_t - f.axis_y), 0);
    EXPECT_EQ(max_abs(flat.grad_s - cone.grad_s), 0); // mips keep the perspective term
  }
}

TEST(Decals, GradientsGiveTheFootprintOfTheProjectedCoordinate) {
  const DecalFrame<double> f = random_frame();
  const vector3 p = in_space(f, {0.2, -0.1, 1.3});
  const vector3 dp_dx{2e-5, 1e-5, -1e-5}, dp_dy{0, 3e-5, 1e-5};
  const auto st = [&](vector3 at) { return cone_decal(f, at, 0.7, 3.0, 0.1).texture_coordinate; };
  const auto here = cone_decal(f, p, 0.7, 3.0, 0.1);
  const TextureDerivatives<double> d = projected_derivatives(here.grad_s, here.grad_t, dp_dx, dp_dy);
  const vec2<double> x = 0.5 * (st(p + dp_dx) - st(p - dp_dx));
  const vec2<double> y = 0.5 * (st(p + dp_dy) - st(p - dp_dy));
  // Third order in a pixel of 3e-5: 1e-14; rounding of st leaves 1e-16 each.
  EXPECT_LT(max_abs(d.dst_dx - x), 1e-13);
  EXPECT_LT(max_abs(d.dst_dy - y), 1e-13);
}

TEST(WedgeDecal, IsAConeBeyondItsSegmentAndAPrismBetween) {
  for (int i = 0; i < 500; ++i) {
    const DecalFrame<double> f = random_frame();
    const vector3 q{uniform(-2, 2), uniform(-1, 1), uniform(0.5, 2.5)};
    const auto point_like = wedge_decal(f, in_space(f, q), 0.0, 0.7, 3.0, 0.2);
    const auto cone = cone_decal(f, in_space(f, q), 0.7, 3.0, 0.2);
    EXPECT_EQ(point_like.inside, cone.inside);
    EXPECT_EQ(point_like.texture_coordinate.x, cone.texture_coordinate.x);
    EXPECT_EQ(max_abs(point_like.grad_s - cone.grad_s), 0);

    const auto wedge = wedge_decal(f, in_space(f, q), 0.8, 0.7, 3.0, 0.2);
    const double slid = q.x - std::clamp(q.x, -0.8, 0.8);
    const auto moved = cone_decal(f, in_space(f, {slid, q.y, q.z}), 0.7, 3.0, 0.2);
    EXPECT_EQ(wedge.inside, moved.inside);
    EXPECT_NEAR(wedge.texture_coordinate.x, moved.texture_coordinate.x, 1e-14);
    EXPECT_NEAR(wedge.falloff, moved.falloff, 1e-13);
    if (std::abs(q.x) < 0.79) {
      EXPECT_EQ(max_abs(wedge.grad_s), 0);
      EXPECT_EQ(max_abs(wedge.axis_s), 0);
    }
  }
}

/// A height by direction in the decal's frame.
double direction_height(vector3 d) { return std::sin(3 * d.x + 1) + d.y * d.z + 0.5 * d.y; }

using DirectionShape = std::function<DecalDirection<double>(const DecalFrame<double>&, vector3)>;

/// A cube map of the normals of a sphere bumped by direction_height must give back the volume gradient
/// of that height, times the distance (slopes are scale-free).
void expect_exact_direction_gradients(const char* name, const DirectionShape& shape, double half_length) {
  double worst = 0, largest = 0;
  int used = 0;
  while (used < 3000) {
    const DecalFrame<double> frame = random_frame();
    const vector3 q{uniform(-2.5, 2.5), uniform(-1.2, 1.2), uniform(-1.2, 1.2)};
    const vector3 p = in_space(frame, q);
    const DecalDirection<double> here = shape(frame, p);
    const vector3 from_centre{q.x - std::clamp(q.x, -half_length, half_length), q.y, q.z};
    const double distance = length(from_centre);
    const bool at_a_kink = distance < 0.2 || std::abs(std::abs(q.x) - half_length) < 2 * step;
    if (!here.inside || distance > 1.19 || (half_length > 0 && at_a_kink) || distance < 0.2) continue;
    ++used;
    // The map's own normal at the looked-up direction: direction minus the surface gradient there.
    const vector3 d = here.lookup;
    const vector3 by_direction{3 * std::cos(3 * d.x + 1), d.z + 0.5, d.y};
    const vector3 mapped = d - from_volume_gradient(d, by_direction);
    const vector3 v = in_space(frame, mapped) - frame.origin;
    const vector3 claimed = decal_gradient_from_normal(here, 3.0 * v);
    const vector3 truth =
        distance * differences([&](vector3 at) { return direction_height(shape(frame, at).lookup); }, p);
    worst = std::max(worst, max_abs(claimed - truth));
    largest = std::max(largest, max_abs(truth));
    EXPECT_LT(max_abs(in_space(frame, here.lookup) - frame.origin - here.direction), 1e-14);
  }
  std::cout << name << ": worst gradient error " << worst << " of " << largest << " (seed " << seed << ")\n";
  EXPECT_LT(worst, exactness * largest) << name;
}

TEST(SphereDecal, SurfaceGradientOfTheSphereIsTheVolumeGradient) {
  expect_exact_direction_gradients(
      "sphere", [](const auto& f, vector3 p) { return sphere_decal(f, p, 1.2, 0.3); }, 0);
}

TEST(CapsuleDecal, GradientsAreExactInTheCylinderAndTheCaps) {
  expect_exact_direction_gradients(
      "capsule", [](const auto& f, vector3 p) { return capsule_decal(f, p, 1.0, 1.2, 0.3); }, 1.0);
}

TEST(CapsuleDecal, WithoutLengthIsTheSphere) {
  for (int i = 0; i < 500; ++i) {
    const DecalFrame<double> f = random_frame();
    const vector3 p = in_space(f, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)});
    const auto capsule = capsule_decal(f, p, 0.0, 0.9, 0.3);
    const auto sphere = sphere_decal(f, p, 0.9, 0.3);
    EXPECT_EQ(capsule.inside, sphere.inside);
    EXPECT_EQ(max_abs(capsule.direction - sphere.direction), 0);
    EXPECT_EQ(max_abs(capsule.unchanging), 0);
    EXPECT_EQ(capsule.falloff, sphere.falloff);
  }
}

TEST(Decals, FalloffIsWholeInTheCoreAndVanishesSmoothlyAtTheSurface) {
  const DecalFrame<double> f{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto box = [&](vector3 p) { return box_decal(f, p, vector3{1, 1, 1}, 0.25).falloff; };
  const auto cone = [&](vector3 p) { return cone_decal(f, p, 1.0, 4.0, 0.25).falloff; };
  const auto wedge = [&](vector3 p) { return wedge_decal(f, p, 1.0, 1.0, 4.0, 0.25).falloff; };
  const auto sphere = [&](vector3 p) { return sphere_decal(f, p, 1.0, 0.25).falloff; };
  const auto capsule = [&](vector3 p) { return capsule_decal(f, p, 1.0, 1.0, 0.25).falloff; };
  struct Walk {
    const char* name;
    std::function<double(vector3)> falloff;
    vector3 core, outside;
  };
  const vector3 in{0, 0, 0.5}, out{0.3, 2, 0.5};
  for (const Walk& walk : {Walk{"box", box, in, out},
                           {"cone", cone, {0, 0, 2}, {0.3, 4, 2}},
                           {"cone's far end", cone, {0.2, 0, 2}, {0, 0.4, 5}},
                           {"wedge", wedge, {0, 0, 2}, {4, 0.4, 2}},
                           {"sphere", sphere, in, out},
                           {"capsule", capsule, in, {4, 0.3, 0.5}}}) {
    constexpr int samples = 20000;
    EXPECT_EQ(walk.falloff(walk.core), 1) << walk.name;
    EXPECT_EQ(walk.falloff(walk.outside), 0) << walk.name;
    double previous = 1, previous_slope = 0, jump = 0, bend = 0;
    for (int i = 1; i <= samples; ++i) {
      const double t = double(i) / samples;
      const double now = walk.falloff((1 - t) * walk.core + t * walk.outside);
      ASSERT_TRUE(now >= 0 && now <= previous + 1e-15) << walk.name;
      jump = std::max(jump, previous - now);
      bend = std::max(bend, std::abs((now - previous) - previous_slope));
      previous_slope = now - previous;
      previous = now;
    }
    // A smoothstep over a quarter of a length of about 1 falls by at most 6 and bends by at most 96 per
    // unit of the walk, which is up to 4 long: continuous with a continuous slope.
    EXPECT_LT(jump, 6.0 * 4 / samples) << walk.name;
    EXPECT_LT(bend, 96.0 * 4 * 4 / samples / samples * 4) << walk.name;
  }
  EXPECT_EQ(box_decal(f, vector3{0.999, 0.999, -0.999}, vector3{1, 1, 1}, 0.0).falloff, 1);
  EXPECT_EQ(box_decal(f, vector3{1.001, 0.999, -0.999}, vector3{1, 1, 1}, 0.0).falloff, 0);
}

void expect_nothing(const DecalProjection<float>& d) {
  EXPECT_FALSE(d.inside);
  EXPECT_EQ(d.falloff, 0);
  EXPECT_EQ(max_abs(d.texture_coordinate), 0);
  for (const vec3<float> v : {d.grad_s, d.grad_t, d.axis_s, d.axis_t}) EXPECT_EQ(max_abs(v), 0);
}

TEST(Decals, AreZeroOutsideAndForDegenerateShapes) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  const DecalFrame<float> f{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const vec3<float> inside{0.1f, 0.2f, 0.5f};
  ASSERT_TRUE(box_decal(f, inside, vec3<float>{1, 1, 1}, 0.1f).inside);
  ASSERT_TRUE(cone_decal(f, inside, 1.f, 1.f, 0.1f).inside);
  for (const float bad : {nan, inf, -inf, 3e38f}) {
    for (const vec3<float> p : {vec3<float>{bad, 0, 0.5f}, {0, bad, 0.5f}, {0, 0, bad}}) {
      expect_nothing(box_decal(f, p, vec3<float>{1, 1, 1}, 0.1f));
      expect_nothing(cone_decal(f, p, 1.f, 1.f, 0.1f));
      expect_nothing(wedge_decal(f, p, 1.f, 1.f, 1.f, 0.1f));
      EXPECT_FALSE(sphere_decal(f, p, 1.f, 0.1f).inside);
      EXPECT_EQ(max_abs(sphere_decal(f, p, 1.f, 0.1f).direction), 0);
      EXPECT_FALSE(capsule_decal(f, p, 1.f, 1.f, 0.1f).inside);
    }
  }
  for (const float size : {0.f, -1.f, nan}) {
    expect_nothing(box_decal(f, inside, vec3<float>{1, size, 1}, 0.1f));
    expect_nothing(cone_decal(f, inside, size, 1.f, 0.1f));
    expect_nothing(cone_decal(f, inside, 1.f, size, 0.1f));
    EXPECT_FALSE(sphere_decal(f, inside, size, 0.1f).inside);
  }
  expect_nothing(cone_decal(f, vec3<float>{0, 0, 0}, 1.f, 1.f, 0.1f));      // the apex
  expect_nothing(cone_decal(f, vec3<float>{0, 0, -0.5f}, 1.f, 1.f, 0.1f));  // behind it
  expect_nothing(cone_decal(f, vec3<float>{0, 0, 1e-40f}, 1.f, 1.f, 0.1f)); // subnormal depth
  const auto tip = cone_decal(f, vec3<float>{0, 0, 2e-38f}, 1.f, 1.f, 0.1f);
  EXPECT_TRUE(std::isfinite(max_abs(tip.grad_s)) && std::isfinite(tip.texture_coordinate.x));

  const DecalDirection<float> centre = sphere_decal(f, vec3<float>{0, 0, 0}, 1.f, 0.1f);
  EXPECT_TRUE(centre.inside);
  EXPECT_EQ(max_abs(decal_gradient_from_normal(centre, vec3<float>{0, 0, 1})), 0);
}

TEST(Decals, FloatKeepsTheDocumentedError) {
  constexpr double eps = std::numeric_limits<float>::epsilon();
  double box_error = 0, cone_error = 0;
  for (int i = 0; i < 20000; ++i) {
    const DecalFrame<double> wide = random_frame();
    const auto narrowed = [](vector3 v) {
      return vec3<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    const auto widened = [](vec3<float> v) { return vector3{v.x, v.y, v.z}; };
    const vec3<float> p = narrowed(in_space(wide, {uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(0.6, 1)}));
    const DecalFrame<float> f{narrowed(wide.origin), narrowed(wide.axis_x), narrowed(wide.axis_y),
                              narrowed(wide.axis_z)};
    const DecalFrame<double> g{widened(f.origin), widened(f.axis_x), widened(f.axis_y), widened(f.axis_z)};
    const double distance = length(widened(p) - g.origin);
    const auto off = [&](const DecalProjection<float>& a, const DecalProjection<double>& b) {
      return std::max(std::abs(a.texture_coordinate.x - b.texture_coordinate.x),
                      std::abs(a.texture_coordinate.y - b.texture_coordinate.y)) /
             (eps * distance);
    };
    box_error = std::max(box_error, off(box_decal(f, p, vec3<float>{0.75f, 0.75f, 2}, 0.1f),
                                        box_decal(g, widened(p), vector3{0.75, 0.75, 2}, 0.1)) *
                                        0.75);
    const double depth = dot(widened(p) - g.origin, g.axis_z);
    cone_error = std::max(cone_error,
                          off(cone_decal(f, p, 1.5f, 3.f, 0.1f), cone_decal(g, widened(p), 1.5, 3.0, 0.1)) *
                              depth * 1.5);
  }
  std::cout << "float against double: box " << box_error << ", cone " << cone_error
            << " of the documented units (seed " << seed << ")\n";
  EXPECT_LT(box_error, 4);
  EXPECT_LT(cone_error, 8);
}

} // namespace
} // namespace surfgrad
