#include "render/camera.hpp"

#include "mesh/bounds.hpp"

#include <surfgrad/trigonometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfgrad::render {
namespace {

/// Part of the half picture that the object may fill: leaves a margin.
constexpr double filled = 0.94;
/// Part of the object's size that lies at least between it and the eye: the least distance from which a
/// wide view holds every vertex may put one of them into the eye.
constexpr double clearance = 0.05;

SinCos<double> sin_cos_degrees(double degrees) { return sin_cos_turns(degrees / 360); }

template <class Visit>
void for_each_vertex(const scene::Scene& scene, const Visit& visit) {
  for (const scene::Object& object : scene.objects)
    for (const vec3<float>& p : scene.meshes[object.mesh].positions) {
      const vec4<double> w = object.world_from_object * vec4<double>{p.x, p.y, p.z, 1};
      visit(vec3<double>{w.x, w.y, w.z});
    }
}

/// A level horizon. Straight up or down has none: then +x is right in the picture, as on a map.
void look_along(Pinhole& camera, vec3<double> forward) {
  camera.forward = normalize_or_zero(forward);
  const bool vertical = std::abs(camera.forward.y) > 0.999999;
  const vec3<double> level{-camera.forward.z, 0, camera.forward.x};
  camera.right = vertical ? vec3<double>{1, 0, 0} : normalize_or_zero(level);
  camera.up = cross(camera.right, camera.forward);
}

/// Towards the origin from yaw and pitch. Yaw gives the horizon, so it also turns a view straight down.
void look_from(Pinhole& camera, double yaw_deg, double pitch_deg) {
  const SinCos<double> yaw = sin_cos_degrees(yaw_deg);
  const SinCos<double> pitch = sin_cos_degrees(pitch_deg);
  camera.forward = {-yaw.sin * pitch.cos, -pitch.sin, -yaw.cos * pitch.cos};
  camera.right = {yaw.cos, 0, -yaw.sin};
  camera.up = cross(camera.right, camera.forward);
}

} // namespace

mat4<double> Pinhole::screen_from_relative(int width, int height) const {
  const auto row = [&](vec3<double> axis, double centre) {
    const vec3<double> r = focal_px * axis + centre * forward;
    return vec4<double>{r.x, r.y, r.z, 0};
  };
  return {row(right, 0.5 * width), row(up, 0.5 * height), {0, 0, 0, 0}, {forward.x, forward.y, forward.z, 0}};
}

mat4<double> Pinhole::relative_from_screen(int width, int height) const {
  // At distance w along `forward` lies w * (forward + dx right + dy up): divided by w, the fourth
  // coordinate is 1 / w.
  const vec3<double> x = (1 / focal_px) * right;
  const vec3<double> y = (1 / focal_px) * up;
  const vec3<double> corner = forward - (0.5 * width) * x - (0.5 * height) * y;
  return {{x.x, y.x, 0, corner.x}, {x.y, y.y, 0, corner.y}, {x.z, y.z, 0, corner.z}, {0, 0, 1, 0}};
}

Pinhole place_camera(const scene::Scene& scene, int width, int height) {
  const stack::Camera& view = scene.camera;
  const SinCos<double> half_view = sin_cos_degrees(view.fov_deg / 2);
  const double tan_half = half_view.sin / half_view.cos;
  Pinhole camera{};
  camera.focal_px = 0.5 * height / tan_half * view.zoom;

  constexpr double infinity = std::numeric_limits<double>::infinity();
  mesh::Bounds bounds;
  for_each_vertex(scene, [&](vec3<double> p) { bounds = mesh::unite(bounds, {p, p}); });
  const vec3<double> centre = mesh::center(bounds);
  const double size = std::max(2 * mesh::radius(bounds), std::numeric_limits<double>::min());

  if (view.position && view.target) {
    camera.eye = *view.position;
    look_along(camera, *view.target - *view.position);
    camera.near = 1e-5 * size;
    return camera;
  }
  look_from(camera, view.yaw_deg, view.pitch_deg);
  // Along one axis with tangent t, a camera shifted by c sees q at distance d where
  // |axis q - c| <= t (d + forward q). The largest axis q - t forward q and -axis q - t forward q
  // over all vertices give the c that centres the object and the least d that frames it.
  const double tan_y = filled * tan_half;
  const double tan_x = tan_y * width / height;
  vec2<double> right_most{-infinity, -infinity}; // x: to the right, y: to the left
  vec2<double> up_most{-infinity, -infinity};    // x: upwards, y: downwards
  double nearest = infinity;                     // depth
  for_each_vertex(scene, [&](vec3<double> p) {
    const vec3<double> q = p - centre;
    const double depth = dot(camera.forward, q);
    const double x = dot(camera.right, q);
    const double y = dot(camera.up, q);
    right_most = {std::max(right_most.x, x - tan_x * depth), std::max(right_most.y, -x - tan_x * depth)};
    nearest = std::min(nearest, depth);
    up_most = {std::max(up_most.x, y - tan_y * depth), std::max(up_most.y, -y - tan_y * depth)};
  });
  const double distance = std::max({(right_most.x + right_most.y) / (2 * tan_x),
                                    (up_most.x + up_most.y) / (2 * tan_y), clearance * size - nearest});
  camera.eye = centre - distance * camera.forward + (0.5 * (right_most.x - right_most.y)) * camera.right +
               (0.5 * (up_most.x - up_most.y)) * camera.up;
  camera.near = 1e-5 * distance;
  return camera;
}

} // namespace surfgrad::render
