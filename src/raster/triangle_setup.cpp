#include "raster/triangle_setup.hpp"

namespace surfgrad::raster {
namespace {

float narrowed(double v) { return static_cast<float>(v); }

/// The attribute whose values at the corners are c.
Plane plane(const TrianglePlanes::Barycentrics& b, double c0, double c1, double c2) {
  const auto weighted = [&](const std::array<double, 3>& w) {
    return narrowed(w[0] * c0 + w[1] * c1 + w[2] * c2);
  };
  return {weighted(b.value), weighted(b.dx), weighted(b.dy)};
}

template <class Corner>
std::array<Plane, 3> planes_of(const TrianglePlanes::Barycentrics& b, const Corner& corner) {
  const auto c0 = corner(0), c1 = corner(1), c2 = corner(2);
  return {plane(b, c0.x, c1.x, c2.x), plane(b, c0.y, c1.y, c2.y), plane(b, c0.z, c1.z, c2.z)};
}

} // namespace

void set_up(const Surface& surface, std::uint32_t triangle, const TrianglePlanes& planes, double x, double y,
            TriangleSetup& setup) {
  const std::array<std::uint32_t, 3>& vertices = surface.mesh->triangles[triangle];
  const TrianglePlanes::Barycentrics b = planes.barycentrics(x, y);
  const vec2<double> q = planes.relative_change(x, y);
  setup.x = narrowed(x);
  setup.y = narrowed(y);
  setup.qx = narrowed(q.x);
  setup.qy = narrowed(q.y);
  setup.front_facing = planes.counter_clockwise() != surface.mirrored ? 1.0f : 0.0f;
  const std::array<vec3<double>, 3> normals{surface.normals[vertices[0]], surface.normals[vertices[1]],
                                            surface.normals[vertices[2]]};
  // Normals within a right angle of each other never cancel: nobody asks for the triangle's own.
  const bool may_cancel = !(dot(normals[0], normals[1]) > 0 && dot(normals[1], normals[2]) > 0 &&
                            dot(normals[2], normals[0]) > 0);
  const vec3<double> flat = may_cancel ? triangle_normal(surface, triangle) : vec3<double>{0, 0, 0};
  setup.flat_normal = {narrowed(flat.x), narrowed(flat.y), narrowed(flat.z)};
  setup.position = planes_of(b, [&](std::size_t i) { return surface.positions[vertices[i]]; });
  const mesh::TriangleMesh& mesh = *surface.mesh;
  const auto& rest = mesh.rest_positions.empty() ? mesh.positions : mesh.rest_positions;
  setup.object_position = planes_of(b, [&](std::size_t i) { return rest[vertices[i]]; });
  setup.normal = planes_of(b, [&](std::size_t i) { return normals[i]; });
  for (std::size_t s = 0; s < surface.slots.size(); ++s) {
    const Surface::Coordinates& slot = surface.slots[s];
    TriangleSetup::Coordinates& out = setup.slots[s];
    if (!slot.present) continue;
    const vec2<double> st[3] = {slot.st[vertices[0]], slot.st[vertices[1]], slot.st[vertices[2]]};
    out.st = {plane(b, st[0].x, st[1].x, st[2].x), plane(b, st[0].y, st[1].y, st[2].y)};
    if (slot.tangents.empty()) continue;
    const vec4<double>* corner = &slot.tangents[3 * static_cast<std::size_t>(triangle)];
    out.tangent = planes_of(b, [&](std::size_t i) { return corner[i]; });
    // Corner signs differ only in degenerate groups; one sign a triangle keeps the frame invertible.
    out.sign = narrowed(corner[0].w);
  }
}

} // namespace surfgrad::raster
