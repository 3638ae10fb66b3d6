#include "raster/projection.hpp"

namespace surfgrad::raster {

Projection Projection::camera(const mat4<double>& screen_from_world, double near) {
  Projection projection;
  projection.screen_from_world_ = screen_from_world;
  projection.near_ = near;
  return projection;
}

Projection Projection::texture(std::size_t slot, int width, int height, vec2<double> corner) {
  Projection projection;
  projection.slot_ = slot;
  projection.corner_ = corner;
  projection.size_ = {static_cast<double>(width), static_cast<double>(height)};
  return projection;
}

std::array<vec3<double>, 3> Projection::corners(const Surface& surface, std::uint32_t triangle) const {
  std::array<vec3<double>, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t vertex = surface.mesh->triangles[triangle][i];
    if (has_depth()) {
      const vec3<double> p = surface.positions[vertex];
      const vec4<double> h{p.x, p.y, p.z, 1};
      const mat4<double>& m = screen_from_world_;
      corners[i] = {dot(m.x, h), dot(m.y, h), dot(m.w, h)};
    } else {
      const vec2<double> st = surface.slots[slot_].st[vertex] - corner_;
      corners[i] = {st.x * size_.x, st.y * size_.y, 1};
    }
  }
  return corners;
}

} // namespace surfgrad::raster
