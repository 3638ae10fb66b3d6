#include "stack/view.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

/// Position and target stand for the whole placement: together, and without yaw, pitch or zoom.
void check_placement(const Camera& camera, const Value& value) {
  if (!camera.position && !camera.target) return;
  const auto fail = [&](std::string problem) {
    value.fail(std::move(problem), R"(give "position" and "target", or "yaw", "pitch" and "zoom")");
  };
  if (!camera.position) fail(R"(has a "target" but no "position")");
  if (!camera.target) fail(R"(has a "position" but no "target")");
  for (const std::string_view key : {"yaw", "pitch", "zoom"})
    if (value.find(key) != nullptr) fail("has a \"position\" and " + quote(key));
  if (max_abs(*camera.target - *camera.position) == 0)
    value.fail(R"("position" and "target" are the same point)", "expected two points");
}

} // namespace

const Fields<Camera>& Camera::fields() {
  static const auto table =
      Fields<Camera>()
          .number("yaw", &Camera::yaw_deg)
          .number("pitch", &Camera::pitch_deg, {.least = -90, .most = 90})
          .number("zoom", &Camera::zoom, {.least = 0, .excludes_least = true})
          .number("fov", &Camera::fov_deg,
                  {.least = 0, .most = 180, .excludes_least = true, .excludes_most = true})
          .vector("position", &Camera::position)
          .vector("target", &Camera::target)
          .finally(check_placement);
  return table;
}

const Fields<Sun>& Sun::fields() {
  static const auto table = Fields<Sun>()
                                .vector("direction", &Sun::direction)
                                .number("strength", &Sun::strength, {.least = 0})
                                .finally([](Sun& sun, const Value& value) {
                                  // The default is no zero vector, so a zero one is the document's.
                                  if (max_abs(sun.direction) == 0)
                                    value.member(*value.find("direction"))
                                        .fail("is the zero vector", "expected the direction of the sun");
                                });
  return table;
}

const Fields<Lights>& Lights::fields() {
  static const auto table = Fields<Lights>()
                                .object("sun", &Lights::sun)
                                .number("sky", &Lights::sky, {.least = 0})
                                .file("environment", &Lights::environment);
  return table;
}

} // namespace surfgrad::stack
