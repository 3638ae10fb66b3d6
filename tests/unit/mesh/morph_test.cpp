#include "mesh/morph.hpp"
#include "support/meshes.hpp"
#include "support/random.hpp"
#include "support/worst.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

namespace surfgrad::mesh {
namespace {

// One rounding to float of a component of a unit vector.
constexpr double rounding = 0.5 * std::numeric_limits<float>::epsilon();

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TriangleMesh torus_with_tangents() {
  TriangleMesh mesh = test::torus(12, 9);
  mesh.tangent_spaces.resize(1);
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) {
      const vec3<float> n = mesh.normals[vertex];
      const vec3<float> t = normalize_or_zero(cross(vec3<float>{0, 1, 0.5f}, n));
      mesh.tangent_spaces[0].corners.push_back({t.x, t.y, t.z, vertex % 2 == 0 ? 1.0f : -1.0f});
    }
  return mesh;
}

MorphTarget random_target(test::Random& random, std::size_t vertices) {
  MorphTarget target;
  for (std::size_t i = 0; i < vertices; ++i) {
    target.positions.push_back(test::narrow(random.vector3(-2, 2)));
    target.normals.push_back(test::narrow(random.vector3()));
    target.tangents.push_back(test::narrow(random.vector3()));
  }
  return target;
}

TEST(Morph, AddsWeightedDifferencesAndMakesDirectionsUnit) {
  const std::uint64_t seed = 20260201;
  test::Random random(seed);
  const TriangleMesh base = torus_with_tangents();
  const std::size_t count = base.positions.size();
  std::vector<MorphTarget> targets;
  for (int i = 0; i < 4; ++i) targets.push_back(random_target(random, count));
  targets[1].normals.clear();
  targets[2].tangents.clear();
  targets[3].positions.clear();
  const std::vector<double> weights{0.75, -0.5, 1.25, 0.3};
  const TriangleMesh result = morph(base, targets, weights);

  test::Worst positions("morphed positions, seed " + std::to_string(seed));
  test::Worst normals("morphed normals");
  test::Worst tangents("morphed tangents");
  const auto sum = [&](vec3<float> v, std::initializer_list<std::size_t> moving,
                       std::vector<vec3<float>> MorphTarget::*kind, std::size_t vertex) {
    vec3<double> s = test::widen(v);
    for (const std::size_t i : moving) s = s + weights[i] * test::widen((targets[i].*kind)[vertex]);
    return s;
  };
  for (std::size_t v = 0; v < count; ++v) {
    const auto p = sum(base.positions[v], {0, 1, 2}, &MorphTarget::positions, v);
    positions.add(test::widen(result.positions[v]), p, rounding * max_abs(p), static_cast<long>(v));
    const auto n = normalize_or_zero(sum(base.normals[v], {0, 2, 3}, &MorphTarget::normals, v));
    normals.add(test::widen(result.normals[v]), n, rounding, static_cast<long>(v));
  }
  for (std::size_t c = 0; c < base.tangent_spaces[0].corners.size(); ++c) {
    const vec4<float> b = base.tangent_spaces[0].corners[c];
    const vec4<float> r = result.tangent_spaces[0].corners[c];
    const auto t = normalize_or_zero(
        sum({b.x, b.y, b.z}, {0, 1, 3}, &MorphTarget::tangents, base.triangles[c / 3][c % 3]));
    tangents.add(vec3<double>{r.x, r.y, r.z}, t, rounding, static_cast<long>(c));
    EXPECT_EQ(r.w, b.w);
  }
  EXPECT_EQ(result.triangles, base.triangles);
  EXPECT_TRUE(same_bits(result.uv_sets[0], base.uv_sets[0]));
}

TEST(Morph, KeepsTheBitsOfWhatNoTargetMoves) {
  test::Random random(20260202);
  TriangleMesh base = torus_with_tangents();
  base.normals[3] = {0, 0, 2}; // not unit: must not be mended on the way
  std::vector<MorphTarget> targets{random_target(random, base.positions.size())};
  const auto same = [&](const TriangleMesh& a) {
    return same_bits(a.normals, base.normals) &&
           same_bits(a.tangent_spaces[0].corners, base.tangent_spaces[0].corners);
  };
  const TriangleMesh at_zero = morph(base, targets, std::vector{0.0});
  EXPECT_TRUE(same_bits(at_zero.positions, base.positions));
  EXPECT_TRUE(same(at_zero));
  EXPECT_FALSE(same(morph(base, targets, std::vector{1.0})));
  targets[0].normals.clear();
  targets[0].tangents.clear();
  const TriangleMesh stale = morph(base, targets, std::vector{1.0});
  EXPECT_FALSE(same_bits(stale.positions, base.positions));
  EXPECT_TRUE(same(stale));
}

TEST(Morph, DirectionsThatCancelBecomeZero) {
  TriangleMesh base = test::plane(1);
  base.tangent_spaces = {{std::vector<vec4<float>>(6, {1, 0, 0, -1})}};
  MorphTarget target;
  target.normals.assign(4, {0, 0, -1});
  target.tangents.assign(4, {-1, 0, 0});
  const TriangleMesh result = morph(base, {&target, 1}, std::vector{1.0});
  EXPECT_EQ(max_abs(result.normals[0]), 0.0f);
  EXPECT_EQ(result.tangent_spaces[0].corners[0].x, 0.0f);
  EXPECT_EQ(result.tangent_spaces[0].corners[0].w, -1.0f);
}

TEST(Morph, MovesAMeshThatHasNoNormalsYet) {
  TriangleMesh base = test::plane(1);
  base.normals.clear();
  MorphTarget target;
  target.positions.assign(4, {0, 0, 3});
  const TriangleMesh result = morph(base, {&target, 1}, std::vector{0.5});
  EXPECT_EQ(result.positions[3].z, 1.5f);
  EXPECT_TRUE(result.normals.empty());
}

} // namespace
} // namespace surfgrad::mesh
