// Where the camera stands and what its picture holds.

#include "render/camera.hpp"

#include "mesh/bounds.hpp"
#include "support/random.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace surfgrad::render {
namespace {

using surfgrad::test::Random;

/// Picture coordinates of a world point, in halves of the picture from its centre, and its distance.
vec3<double> seen(const Pinhole& camera, int width, int height, vec3<double> p) {
  const vec3<double> q = p - camera.eye;
  const mat4<double> m = camera.screen_from_relative(width, height);
  const vec4<double> h{q.x, q.y, q.z, 1};
  const double w = dot(m.w, h);
  return {dot(m.x, h) / w / width * 2 - 1, dot(m.y, h) / w / height * 2 - 1, w};
}

double along(const Pinhole& camera, vec3<double> direction) { return dot(camera.forward, direction); }

TEST(Camera, FramesEveryVertexFromAnySideAtAnyAspect) {
  Random random(241);
  const scene::Scene base = surfgrad::test::scene_of(
      surfgrad::test::torus(24, 12), random.rotation() * surfgrad::test::scaling({5, 1, 0.3}), {100, -20, 3});
  for (const auto& [width, height] : {std::pair{640, 480}, {200, 900}, {1000, 100}})
    for (const double pitch : {-90.0, -40.0, 0.0, 15.0, 89.0, 90.0})
      for (const double yaw : {0.0, 30.0, 135.0, -100.0, 400.0})
        for (const double fov : {5.0, 35.0, 120.0}) {
          scene::Scene scene = base;
          scene.camera.yaw_deg = yaw;
          scene.camera.pitch_deg = pitch;
          scene.camera.fov_deg = fov;
          const Pinhole camera = place_camera(scene, width, height);
          double widest = 0;
          double nearest = HUGE_VAL;
          mesh::Bounds bounds;
          for (const vec3<float>& v : scene.meshes[0].positions) {
            const mat4<double>& m = scene.objects[0].world_from_object;
            const vec4<double> p{v.x, v.y, v.z, 1};
            const vec3<double> world{dot(m.x, p), dot(m.y, p), dot(m.z, p)};
            bounds = mesh::unite(bounds, {world, world});
            const vec3<double> s = seen(camera, width, height, world);
            nearest = std::min(nearest, s.z);
            widest = std::max({widest, std::abs(s.x), std::abs(s.y)});
          }
          EXPECT_LE(widest, 0.94 + 1e-9);
          // As near as its margin allows, or as it may come to the object.
          const double clearance = 0.05 * 2 * mesh::radius(bounds);
          EXPECT_GE(nearest, clearance * (1 - 1e-9));
          EXPECT_TRUE(widest > 0.94 - 1e-9 || nearest < clearance * (1 + 1e-9))
              << width << "x" << height << " yaw " << yaw << " pitch " << pitch << " fov " << fov;
        }
}

TEST(Camera, IsARightHandedOrthonormalFrame) {
  for (const double pitch : {-90.0, -89.99999, -10.0, 0.0, 60.0, 90.0})
    for (const double yaw : {0.0, 77.0, 180.0, 271.0}) {
      scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(1));
      scene.camera.yaw_deg = yaw;
      scene.camera.pitch_deg = pitch;
      const Pinhole c = place_camera(scene, 100, 100);
      EXPECT_NEAR(length(c.right), 1, 1e-14);
      EXPECT_NEAR(length(c.up), 1, 1e-14);
      EXPECT_NEAR(dot(c.right, c.forward), 0, 1e-14);
      EXPECT_LT(max_abs(cross(c.right, c.up) + c.forward), 1e-14);
      EXPECT_GE(c.up.y, -1e-14);
    }
}

TEST(Camera, YawZeroLooksAtTheFrontAndNinetyAtTheRightSide) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(1));
  scene.camera.pitch_deg = 0;
  scene.camera.yaw_deg = 0;
  EXPECT_NEAR(along(place_camera(scene, 100, 100), {0, 0, -1}), 1, 1e-14);
  scene.camera.yaw_deg = 90;
  EXPECT_NEAR(along(place_camera(scene, 100, 100), {-1, 0, 0}), 1, 1e-14);
  scene.camera.pitch_deg = 90;
  EXPECT_NEAR(along(place_camera(scene, 100, 100), {0, -1, 0}), 1, 1e-14);
}

TEST(Camera, StraightDownIsTheLimitOfSteepViewsForEveryYaw) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(12, 8));
  for (const double yaw : {0.0, 30.0, 90.0, 200.0})
    for (const double side : {1.0, -1.0}) {
      scene.camera.yaw_deg = yaw;
      scene.camera.pitch_deg = side * 89.9999;
      const Pinhole steep = place_camera(scene, 100, 100);
      scene.camera.pitch_deg = side * 90;
      const Pinhole vertical = place_camera(scene, 100, 100);
      EXPECT_LT(max_abs(steep.up - vertical.up), 1e-5);
      EXPECT_LT(max_abs(steep.eye - vertical.eye), 1e-4);
    }
}

TEST(Camera, WithAPositionStandsThereAndLooksAtItsTarget) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(1));
  scene.camera.position = vec3<double>{3, 4, 5};
  scene.camera.target = vec3<double>{-1, 0, 2};
  const Pinhole c = place_camera(scene, 320, 200);
  EXPECT_EQ(max_abs(c.eye - *scene.camera.position), 0);
  const vec3<double> centre = seen(c, 320, 200, *scene.camera.target);
  EXPECT_NEAR(centre.x, 0, 1e-12);
  EXPECT_NEAR(centre.y, 0, 1e-12);
  EXPECT_EQ(c.right.y, 0); // a level horizon
  scene.camera.target = vec3<double>{3, -4, 5};
  const Pinhole down = place_camera(scene, 320, 200); // as on a map: +x right, -z up
  EXPECT_LT(max_abs(down.right - vec3<double>{1, 0, 0}), 1e-14);
  EXPECT_LT(max_abs(down.up - vec3<double>{0, 0, -1}), 1e-14);
}

TEST(Camera, ZoomEnlargesAboutTheCentreFromTheSamePoint) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::torus(12, 8));
  const Pinhole plain = place_camera(scene, 300, 200);
  scene.camera.zoom = 2.5;
  const Pinhole zoomed = place_camera(scene, 300, 200);
  EXPECT_EQ(max_abs(plain.eye - zoomed.eye), 0);
  for (const vec3<double>& p : {vec3<double>{0.3, 0.1, 0.2}, {0, 0.4, -0.1}}) {
    const vec3<double> a = seen(plain, 300, 200, p);
    const vec3<double> b = seen(zoomed, 300, 200, p);
    EXPECT_NEAR(b.x, 2.5 * a.x, 1e-12);
    EXPECT_NEAR(b.y, 2.5 * a.y, 1e-12);
  }
}

TEST(Camera, FieldOfViewIsVertical) {
  scene::Scene scene = surfgrad::test::scene_of(surfgrad::test::plane(1));
  scene.camera.fov_deg = 60;
  const Pinhole c = place_camera(scene, 1000, 200);
  const double half = std::atan(100 / c.focal_px);
  EXPECT_NEAR(2 * half * 180 / 3.14159265358979324, 60, 1e-9);
}

} // namespace
} // namespace surfgrad::render
