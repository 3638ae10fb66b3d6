// What a morphed mesh's tangents are worth: third motivation of Mikkelsen 2019.

#include "gallery/morphs.hpp"
#include "gallery/parts.hpp"
#include "render/render.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace surfgrad::gallery {
namespace {

/// Composed normals of the sheet under a studded normal map, one a pixel of a picture.
image::Image normals_of(int cells, MorphedTangents tangents, stack::Basis basis) {
  Maps maps;
  scene::Scene scene = scene_of(morphed_sheet(cells, tangents));
  look_from(scene, 0, 0);
  scene.materials[0].layers = {normal_map(scene, maps, "studs", {.tile = {2, 2}, .basis = basis})};
  return render::render(scene, {.width = 256, .height = 256, .aov = render::Aov::normal}).image;
}

struct Angles {
  double mean = 0, worst = 0; ///< degrees
};

Angles between(const image::Image& a, const image::Image& b) {
  Angles angles;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < a.texels.size(); i += 3) {
    const vec3<double> n = test::widen(vec3<float>{a.texels[i], a.texels[i + 1], a.texels[i + 2]});
    const vec3<double> m = test::widen(vec3<float>{b.texels[i], b.texels[i + 1], b.texels[i + 2]});
    if (length(n) < 0.5 || length(m) < 0.5) continue; // the background
    const double angle = std::atan2(length(cross(n, m)), dot(n, m)) * 180 / std::numbers::pi;
    angles.mean += angle;
    angles.worst = std::max(angles.worst, angle);
    ++count;
  }
  angles.mean /= static_cast<double>(count);
  return angles;
}

TEST(Morph, DerivedBasisStaysWithinHalfADegreeOfTangentsRecomputedOnTheMorphedMesh) {
  using stack::Basis;
  const auto against = [](int cells, MorphedTangents tangents, Basis basis, const char* name) {
    const Angles angles = between(normals_of(cells, tangents, basis),
                                  normals_of(cells, MorphedTangents::recomputed, Basis::mikktspace));
    std::printf("  %-8s %3d cells: mean %.3f, worst %.2f degrees\n", name, cells, angles.mean, angles.worst);
    return angles;
  };
  const Angles stale = against(128, MorphedTangents::stale, Basis::mikktspace, "stale");
  const Angles blended = against(128, MorphedTangents::blended, Basis::mikktspace, "blended");
  const Angles coarse = against(32, MorphedTangents::recomputed, Basis::derived, "derived");
  const Angles derived = against(128, MorphedTangents::recomputed, Basis::derived, "derived");
  EXPECT_LT(derived.mean, 0.5);
  // The derived frame is constant over a triangle, vertex tangents are interpolated: first order in its size.
  EXPECT_LT(derived.mean, 0.4 * coarse.mean);
  // In the middle stale tangents are a right angle off, towards the border they are right; the slopes of the
  // studs bring part of that to the normals.
  EXPECT_GT(stale.mean, 5);
  EXPECT_GT(stale.mean, blended.mean);
  // Differences of unit tangents forget how far each target stretches.
  EXPECT_GT(blended.mean, 5 * derived.mean);
}

TEST(Morph, TangentsDoNotChangeWhatElseTheMeshIs) {
  const mesh::TriangleMesh recomputed = morphed_sheet(12, MorphedTangents::recomputed);
  EXPECT_FALSE(mesh::has_tangents(recomputed, 0));
  for (const MorphedTangents tangents : {MorphedTangents::stale, MorphedTangents::blended}) {
    const mesh::TriangleMesh mesh = morphed_sheet(12, tangents);
    ASSERT_TRUE(mesh::has_tangents(mesh, 0));
    for (const vec4<float>& t : mesh.tangent_spaces[0].corners)
      ASSERT_NEAR(std::hypot(t.x, t.y, t.z), 1, 1e-6); // rounded to float
    ASSERT_EQ(mesh.positions.size(), recomputed.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      ASSERT_EQ(length(test::widen(mesh.positions[i]) - test::widen(recomputed.positions[i])), 0);
      ASSERT_EQ(length(test::widen(mesh.normals[i]) - test::widen(recomputed.normals[i])), 0);
    }
  }
}

} // namespace
} // namespace surfgrad::gallery
