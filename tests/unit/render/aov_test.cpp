// Raw pictures: normals of a known surface, gradients, texture coordinates, nothing where nothing is.

#include "render/render.hpp"

#include "render/camera.hpp"
#include "support/images.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <optional>

namespace surfgrad::render {
namespace {

vec3<double> value_at(const Picture& picture, int x, int y) {
  return {picture.image.at(x, y, 0), picture.image.at(x, y, 1), picture.image.at(x, y, 2)};
}

/// Towards the world through a pixel centre.
vec3<double> ray(const Pinhole& c, int width, int height, int x, int y) {
  return normalize_or_zero(c.forward + ((x + 0.5 - 0.5 * width) / c.focal_px) * c.right +
                           ((y + 0.5 - 0.5 * height) / c.focal_px) * c.up);
}

/// Nearest hit of the unit sphere around the origin.
std::optional<vec3<double>> on_sphere(vec3<double> eye, vec3<double> d) {
  const double b = dot(eye, d);
  const double disc = b * b - dot(eye, eye) + 1;
  if (disc < 0) return std::nullopt;
  return eye + (-b - std::sqrt(disc)) * d;
}

TEST(Aov, NormalsOfASphereAreItsPoints) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::sphere_band(200, 100));
  constexpr int width = 90;
  constexpr int height = 70;
  for (const double yaw : {0.0, 140.0}) {
    scene.camera.yaw_deg = yaw;
    scene.camera.pitch_deg = 20;
    const Pinhole camera = place_camera(scene, width, height);
    const Picture normal = render(scene, {width, height, 1, Aov::normal});
    const Picture base = render(scene, {width, height, 1, Aov::base_normal});
    double worst = 0;
    int compared = 0;
    int empty = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        // No layers; but the resolve makes the normal unit once more, in float.
        EXPECT_LE(max_abs(value_at(normal, x, y) - value_at(base, x, y)), 3 * epsilon_v<float>);
        const vec3<double> d = ray(camera, width, height, x, y);
        const auto p = on_sphere(camera.eye, d);
        if (!p) { // the mesh lies inside the sphere
          EXPECT_EQ(max_abs(value_at(normal, x, y)), 0);
          ++empty;
        } else if (std::abs(p->y) < 0.9 && dot(*p, d) < -0.3) { // neither the open poles nor the rim
          worst = std::max(worst, max_abs(value_at(normal, x, y) - *p));
          ++compared;
        }
      }
    std::printf("  yaw %g: largest difference %.3g over %d pixels, %d empty\n", yaw, worst, compared, empty);
    // Chords of 1.8 degrees lie 1.2e-4 inside the sphere: at grazing 0.3 the hit moves 4e-4.
    EXPECT_LT(worst, 8e-4);
    EXPECT_GT(compared, 1000);
    EXPECT_GT(empty, 500);
  }
}

/// The plane [-1, 1]^2 seen from straight in front, filling a part of the picture.
scene::Scene plane_in_front() {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(4));
  scene.camera.position = vec3<double>{0, 0, 4};
  scene.camera.target = vec3<double>{0, 0, 0};
  scene.camera.fov_deg = 2 * std::atan(0.5) * 180 / 3.14159265358979324; // a picture two units high at z = 2
  return scene;
}

TEST(Aov, TextureCoordinatesRunRightAndUp) {
  const Picture picture = render(plane_in_front(), {40, 40, 1, Aov::uv});
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const vec2<double> p{(x + 0.5) / 10 - 2, (y + 0.5) / 10 - 2};
      const bool inside = max_abs(p) < 1;
      const vec3<double> expected =
          inside ? vec3<double>{0.5 * p.x + 0.5, 0.5 * p.y + 0.5, 0} : vec3<double>{0, 0, 0};
      EXPECT_LT(max_abs(value_at(picture, x, y) - expected), 1e-6);
    }
  EXPECT_EQ(picture.covered, 400);
}

TEST(Aov, TheSurfaceGradientPointsUpTheSlope) {
  scene::Scene scene = plane_in_front();
  // Normal (-1, 0.5, 2) / |.|: the height rises by 1/2 along +x and falls by 1/4 along +y.
  surfgrad::test::add_image(scene, "tilt", surfgrad::test::constant_image(1, 1, {0.25, 0.625, 1}));
  scene.materials[0].layers = {surfgrad::test::normal_layer("tilt")};
  const Picture gradient = render(scene, {40, 40, 1, Aov::surfgrad});
  const Picture normal = render(scene, {40, 40, 1, Aov::normal});
  const Picture base = render(scene, {40, 40, 1, Aov::base_normal});
  EXPECT_LT(max_abs(value_at(gradient, 20, 20) - vec3<double>{0.5, -0.25, 0}), 1e-6);
  EXPECT_LT(max_abs(value_at(normal, 20, 20) - normalize_or_zero(vec3<double>{-0.5, 0.25, 1})), 1e-6);
  EXPECT_LT(max_abs(value_at(base, 20, 20) - vec3<double>{0, 0, 1}), 1e-6);
  EXPECT_EQ(max_abs(value_at(gradient, 0, 0)), 0);
}

TEST(Aov, BackFacesShowWhatTheirModeSays) {
  scene::Scene scene = plane_in_front();
  scene.camera.position->z = -4;
  surfgrad::test::add_image(scene, "tilt", surfgrad::test::constant_image(1, 1, {0.25, 0.625, 1}));
  scene.materials[0].layers = {surfgrad::test::normal_layer("tilt")};
  const auto shown = [&](stack::BackFaces mode) {
    scene.materials[0].back_faces = mode;
    return value_at(render(scene, {40, 40, 1, Aov::normal}), 20, 20);
  };
  const vec3<double> front = normalize_or_zero(vec3<double>{-0.5, 0.25, 1});
  EXPECT_LT(max_abs(shown(stack::BackFaces::same) - front), 1e-6);
  EXPECT_LT(max_abs(shown(stack::BackFaces::flip) + front), 1e-6);
  EXPECT_LT(max_abs(shown(stack::BackFaces::mirror) - vec3<double>{front.x, front.y, -front.z}), 1e-6);
  EXPECT_EQ(max_abs(shown(stack::BackFaces::cull)), 0);
}

TEST(Aov, IsEncodedForIntegerFilesWithinItsRange) {
  Picture picture;
  picture.image = image::make_image(2, 1, 3, image::Depth::float32);
  picture.image.texels = {-1, 0, 1, 2.25f, -0.25f, 0};
  EXPECT_EQ(encoded_for_display(picture.image, Aov::normal).texels[0], 0);
  EXPECT_EQ(encoded_for_display(picture.image, Aov::normal).texels[1], 0.5f);
  EXPECT_EQ(encoded_for_display(picture.image, Aov::normal).texels[2], 1);
  EXPECT_EQ(encoded_for_display(picture.image, Aov::uv).texels[3], 0.25f);
  EXPECT_EQ(encoded_for_display(picture.image, Aov::uv).texels[4], 0.75f);
  EXPECT_EQ(encoded_for_display(picture.image, Aov::beauty).texels, picture.image.texels);
}

} // namespace
} // namespace surfgrad::render
