#include "raster/surface.hpp"

#include "mesh/mikktspace.hpp"

#include <surfgrad/resolve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace surfgrad::raster {
namespace {

vec3<double> widened(vec3<float> v) { return {v.x, v.y, v.z}; }

std::vector<vec4<double>> placed_tangents(const mesh::TriangleMesh& mesh, int uv_set,
                                          const mat3<double>& linear, bool mirrored) {
  const auto set = static_cast<std::size_t>(uv_set);
  const mesh::TangentSpace space =
      mesh::has_tangents(mesh, set) ? mesh.tangent_spaces[set] : mesh::generate_tangents(mesh, set);
  std::vector<vec4<double>> result;
  result.reserve(space.corners.size());
  for (const vec4<float>& c : space.corners) {
    const vec3<double> t = normalize_or_zero(linear * vec3<double>{c.x, c.y, c.z});
    result.push_back({t.x, t.y, t.z, mirrored ? -static_cast<double>(c.w) : static_cast<double>(c.w)});
  }
  return result;
}

} // namespace

mat3<double> linear_part(const mat4<double>& m) {
  return {{m.x.x, m.x.y, m.x.z}, {m.y.x, m.y.y, m.y.z}, {m.z.x, m.z.y, m.z.z}};
}

Surface place_mesh(const mesh::TriangleMesh& mesh, const mat4<double>& world_from_object, vec3<double> origin,
                   const std::vector<UvSlot>& slots) {
  const mat3<double> linear = linear_part(world_from_object);
  Surface surface;
  surface.mesh = &mesh;
  surface.mirrored = determinant(linear) < 0;
  surface.positions.reserve(mesh.positions.size());
  for (const vec3<float>& p : mesh.positions) {
    const vec4<double> w = world_from_object * vec4<double>{p.x, p.y, p.z, 1};
    surface.positions.push_back(vec3<double>{w.x, w.y, w.z} - origin);
  }
  surface.normals.reserve(mesh.normals.size());
  for (const vec3<float>& n : mesh.normals)
    surface.normals.push_back(normalize_or_zero(transform_normal(linear, widened(n))));
  for (const UvSlot& slot : slots) {
    Surface::Coordinates coordinates;
    if (static_cast<std::size_t>(slot.uv_set) < mesh.uv_sets.size()) {
      coordinates.present = true;
      for (const vec2<float>& st : mesh.uv_sets[static_cast<std::size_t>(slot.uv_set)])
        coordinates.st.push_back({st.x, st.y});
      if (slot.tangents) coordinates.tangents = placed_tangents(mesh, slot.uv_set, linear, surface.mirrored);
    }
    surface.slots.push_back(std::move(coordinates));
  }
  return surface;
}

TrianglePlanes::TrianglePlanes(const std::array<vec3<double>, 3>& corners) : corners_(corners) {
  const double det = dot(corners[0], cross(corners[1], corners[2]));
  counter_clockwise_ = det > 0;
  degenerate_ = det == 0 || !std::isfinite(det);
  if (degenerate_) return;
  // Not divided by det: the scale cancels in every use but inverse_w.
  for (std::size_t i = 0; i < 3; ++i) {
    const vec3<double> e = cross(corners[(i + 1) % 3], corners[(i + 2) % 3]);
    edges_[i] = det > 0 ? e : -e;
  }
  sum_ = edges_[0] + edges_[1] + edges_[2];
  scale_ = 1 / (det > 0 ? det : -det);
}

bool TrianglePlanes::covers(double x, double y) const {
  if (degenerate_) return false;
  // The edge functions again, from corners relative to the point: exactly opposite for an edge's two
  // triangles, and exactly zero for every edge of a corner on the point, so that rounding cannot give
  // such a point to two triangles of a fan or to none.
  std::array<vec2<double>, 3> corner;
  for (std::size_t i = 0; i < 3; ++i)
    corner[i] = {corners_[i].x - x * corners_[i].z, corners_[i].y - y * corners_[i].z};
  for (std::size_t i = 0; i < 3; ++i) {
    const double area = cross(corner[(i + 1) % 3], corner[(i + 2) % 3]);
    const double value = counter_clockwise_ ? area : -area;
    // On the edge itself the side is decided by the edge's direction: opposite for the neighbour.
    const vec3<double>& e = edges_[i];
    const bool owns_edge = e.x > 0 || (e.x == 0 && e.y > 0);
    if (!(value > 0 || (value == 0 && owns_edge))) return false;
  }
  return true;
}

std::array<double, 3> TrianglePlanes::margins(double x_most, double y_most) const {
  std::array<double, 3> margins;
  for (std::size_t i = 0; i < 3; ++i) {
    const vec3<double>& a = corners_[(i + 1) % 3];
    const vec3<double>& b = corners_[(i + 2) % 3];
    const auto most = [](double c, double point, double w) { return std::abs(c) + point * std::abs(w); };
    const double parts =
        most(a.x, x_most, a.z) * most(b.y, y_most, b.z) + most(a.y, y_most, a.z) * most(b.x, x_most, b.z);
    // Fewer than 16 roundings on either way to the value, none larger than half an epsilon of its parts.
    margins[i] = 16 * epsilon_v<double> * parts;
  }
  return margins;
}

TrianglePlanes::Box TrianglePlanes::box() const {
  constexpr double everywhere = std::numeric_limits<double>::infinity();
  Box box{everywhere, everywhere, -everywhere, -everywhere};
  for (const vec3<double>& c : corners_) {
    if (!(c.z > 0)) return {-everywhere, -everywhere, everywhere, everywhere};
    box.x_low = std::min(box.x_low, c.x / c.z);
    box.y_low = std::min(box.y_low, c.y / c.z);
    box.x_high = std::max(box.x_high, c.x / c.z);
    box.y_high = std::max(box.y_high, c.y / c.z);
  }
  return box;
}

TrianglePlanes::Barycentrics TrianglePlanes::barycentrics(double x, double y) const {
  const vec3<double> sum = sum_;
  const double total = sum.x * x + sum.y * y + sum.z;
  Barycentrics b{};
  for (std::size_t i = 0; i < 3; ++i) {
    const vec3<double>& e = edges_[i];
    b.value[i] = (e.x * x + e.y * y + e.z) / total;
    b.dx[i] = (e.x - b.value[i] * sum.x) / total;
    b.dy[i] = (e.y - b.value[i] * sum.y) / total;
  }
  return b;
}

vec2<double> TrianglePlanes::relative_change(double x, double y) const {
  const vec3<double> sum = sum_;
  const double total = sum.x * x + sum.y * y + sum.z;
  return {sum.x / total, sum.y / total};
}

namespace {

template <class V, class Corner>
V weighted(const std::array<double, 3>& w, const Corner& corner) {
  return w[0] * corner(0) + w[1] * corner(1) + w[2] * corner(2);
}

} // namespace

vec3<double> triangle_normal(const Surface& surface, std::uint32_t triangle) {
  const std::array<std::uint32_t, 3>& vertices = surface.mesh->triangles[triangle];
  const vec3<double> a = surface.positions[vertices[0]];
  const vec3<double> n =
      normalize_or_zero(cross(surface.positions[vertices[1]] - a, surface.positions[vertices[2]] - a));
  return surface.mirrored ? -n : n;
}

Fragment<double> make_fragment(const Surface& surface, std::uint32_t triangle, const TrianglePlanes& planes,
                               double x, double y) {
  const std::array<std::uint32_t, 3>& vertices = surface.mesh->triangles[triangle];
  const TrianglePlanes::Barycentrics b = planes.barycentrics(x, y);
  const auto position = [&](std::size_t i) { return surface.positions[vertices[i]]; };
  const auto normal = [&](std::size_t i) { return surface.normals[vertices[i]]; };
  Fragment<double> f{};
  const auto object_position = [&](std::size_t i) {
    const mesh::TriangleMesh& mesh = *surface.mesh;
    const vec3<float> p = (mesh.rest_positions.empty() ? mesh.positions : mesh.rest_positions)[vertices[i]];
    return vec3<double>{p.x, p.y, p.z};
  };
  f.raster = {x, y};
  f.position = weighted<vec3<double>>(b.value, position);
  f.object_position = weighted<vec3<double>>(b.value, object_position);
  f.dp_dx = weighted<vec3<double>>(b.dx, position);
  f.dp_dy = weighted<vec3<double>>(b.dy, position);
  f.normal = weighted<vec3<double>>(b.value, normal);
  f.dn_dx = weighted<vec3<double>>(b.dx, normal);
  f.dn_dy = weighted<vec3<double>>(b.dy, normal);
  // Vertex normals are unit or zero: what is shorter than this is the rounding of normals that cancel.
  f.normal_is_absent = !(max_abs(f.normal) > 1e-12);
  if (f.normal_is_absent) f.normal = triangle_normal(surface, triangle);
  f.front_facing = planes.counter_clockwise() != surface.mirrored;
  for (std::size_t s = 0; s < surface.slots.size(); ++s) {
    const Surface::Coordinates& slot = surface.slots[s];
    if (!slot.present) continue;
    const auto st = [&](std::size_t i) { return slot.st[vertices[i]]; };
    UvFragment<double>& uv = f.uvs[s];
    uv.st = weighted<vec2<double>>(b.value, st);
    uv.dst_dx = weighted<vec2<double>>(b.dx, st);
    uv.dst_dy = weighted<vec2<double>>(b.dy, st);
    uv.footprint_dx = uv.dst_dx;
    uv.footprint_dy = uv.dst_dy;
    if (slot.tangents.empty()) continue;
    const auto tangent = [&](std::size_t i) {
      const vec4<double>& t = slot.tangents[3 * static_cast<std::size_t>(triangle) + i];
      return vec3<double>{t.x, t.y, t.z};
    };
    uv.tangent = weighted<vec3<double>>(b.value, tangent);
    // Corner signs differ only in degenerate groups; one sign a triangle keeps the frame invertible.
    uv.sign = slot.tangents[3 * static_cast<std::size_t>(triangle)].w;
  }
  return f;
}

} // namespace surfgrad::raster
