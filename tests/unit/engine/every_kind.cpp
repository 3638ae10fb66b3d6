#include "every_kind.hpp"

#include "raster/surface.hpp"
#include "stack/uses.hpp"

namespace surfgrad::engine::test {
namespace {

vec3<float> narrow(vec3<double> v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// The axes of a side: two along it, then outwards; right-handed.
mat3<double> axes_of(int side) {
  const double sign = side % 2 == 0 ? 1 : -1;
  switch (side / 2) {
  case 0:
    return {{0, sign, 0}, {0, 0, 1}, {sign, 0, 0}};
  case 1:
    return {{0, 0, sign}, {1, 0, 0}, {0, sign, 0}};
  default:
    return {{sign, 0, 0}, {0, 1, 0}, {0, 0, sign}};
  }
}

/// Texture coordinates of the drawn body become those of the other unwraps. Exact in float.
vec2<float> unwrapped_as(UnwrappedAs how, vec2<float> st) {
  if (how == UnwrappedAs::mirrored || how == UnwrappedAs::both) st = {1 - st.x, st.y};
  if (how == UnwrappedAs::turned || how == UnwrappedAs::both) st = {-st.y, st.x};
  return st;
}

/// The same image on the surface for coordinates with s mirrored: s = 1 - s'.
void mirror(stack::Texture& texture) {
  const double turn = texture.rotate_deg * std::numbers::pi / 180;
  texture.offset.x += std::cos(turn) * texture.tile.x;
  texture.offset.y += std::sin(turn) * texture.tile.x;
  texture.tile.x = -texture.tile.x;
}

/// The same image for coordinates turned by a quarter: (s, t) = (t', -s').
void turn(stack::Texture& texture) {
  std::swap(texture.tile.x, texture.tile.y);
  texture.rotate_deg -= 90;
}

void adapt(stack::Layer& layer, UnwrappedAs how) {
  for (const stack::TextureUse& use : stack::textures_of(layer)) {
    // The layer is this function's own copy; textures_of looks at layers and does not change them.
    auto& texture = const_cast<stack::Texture&>(*use.texture);
    if (how == UnwrappedAs::mirrored || how == UnwrappedAs::both) mirror(texture);
    if (how == UnwrappedAs::turned || how == UnwrappedAs::both) turn(texture);
  }
}

/// A pinhole over a side, a little off its middle; takes positions relative to the eye to
/// (x w, y w, w) in pixels.
struct Camera {
  vec3<double> eye;
  mat3<double> axes; // rows: right, up, forward
  static constexpr double focal_px = 60;

  explicit Camera(int side) {
    const mat3<double> a = axes_of(side);
    eye = 5.0 * a.z + 0.7 * a.x - 0.4 * a.y;
    axes = {a.x, a.y, -a.z};
  }
  [[nodiscard]] mat3<double> screen_from_relative(bool rows_run_down) const {
    const double up = rows_run_down ? -focal_px : focal_px;
    return {focal_px * axes.x + 100.0 * axes.z, up * axes.y + 100.0 * axes.z, axes.z};
  }
};

mat3<double> inverse(const mat3<double>& m) {
  const mat3<double> c = transpose(cofactor(m));
  const double f = 1 / determinant(m);
  return {f * c.x, f * c.y, f * c.z};
}

mat4<double> as_projection(const mat3<double>& m) {
  return {{m.x.x, m.x.y, m.x.z, 0}, {m.y.x, m.y.y, m.y.z, 0}, {0, 0, 0, 0}, {m.z.x, m.z.y, m.z.z, 0}};
}

/// Takes (x, y, 1 / w, 1) to homogeneous positions: the position is w * inverse * (x, y, 1).
mat4<double> back_from(const mat3<double>& screen_from_relative) {
  const mat3<double> m = inverse(screen_from_relative);
  return {{m.x.x, m.x.y, 0, m.x.z}, {m.y.x, m.y.y, 0, m.y.z}, {m.z.x, m.z.y, 0, m.z.z}, {0, 0, 1, 0}};
}

} // namespace

Body::Body(double bend) {
  Random random(4001);
  lab_.add("normals", surfgrad::test::random_normal_map(random, 8, 8, 0.5));
  lab_.add("directions", surfgrad::test::random_image(random, 8, 8, 3));
  lab_.add("heights", surfgrad::test::random_image(random, 8, 8, 1));
  lab_.add("slopes", surfgrad::test::random_image(random, 8, 8, 2));
  lab_.add("cube", surfgrad::test::random_image(random, 24, 4, 3));
  lab_.add("mask", surfgrad::test::random_image(random, 4, 4, 4));
  mesh_.uv_sets.resize(1);
  for (int side = 0; side < 6; ++side) {
    const mat3<double> a = axes_of(side);
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (int corner = 0; corner < 4; ++corner) {
      const double x = corner % 2 == 0 ? -1 : 1;
      const double y = corner < 2 ? -1 : 1;
      const vec3<double> p = x * a.x + y * a.y + a.z;
      mesh_.positions.push_back(narrow(p));
      mesh_.normals.push_back(narrow(normalize_or_zero(a.z + bend * p)));
      // In eighths: exact under every unwrap. Not sheared: see Body.
      mesh_.uv_sets[0].push_back(
          {static_cast<float>(0.25 * x - 0.125 * y + 0.5 * side), static_cast<float>(0.25 * y + 0.125 * x)});
    }
    mesh_.triangles.push_back({first, first + 1, first + 3});
    mesh_.triangles.push_back({first, first + 3, first + 2});
  }
  mesh_.material_of_triangle.assign(mesh_.triangles.size(), 0);
}

std::vector<Seen> Body::seen(const KindCase& kind, const View& view, double scale,
                             UnwrappedAs unwrapped) const {
  mesh::TriangleMesh mesh = mesh_;
  for (vec2<float>& st : mesh.uv_sets[0]) st = unwrapped_as(unwrapped, st);
  std::vector<stack::Layer> layers = kind.layers(scale);
  for (stack::Layer& layer : layers) adapt(layer, unwrapped);
  const Program program = lab_.compile(layers);

  const mat3<double>& m = view.linear;
  const mat3<double> camera_moves = view.projects_through.value_or(m);
  const vec3<double> shift{0.3, -2, 1};
  const mat4<double> world_from_object{{m.x.x, m.x.y, m.x.z, shift.x},
                                       {m.y.x, m.y.y, m.y.z, shift.y},
                                       {m.z.x, m.z.y, m.z.z, shift.z},
                                       {0, 0, 0, 1}};
  std::vector<Seen> points;
  for (int side = 0; side < 6; ++side) {
    const Camera camera(side);
    const vec3<double> eye = camera_moves * camera.eye + shift;
    const mat3<double> projection = camera.screen_from_relative(view.rows_run_down) * inverse(camera_moves);
    const raster::Surface surface =
        raster::place_mesh(mesh, world_from_object, eye, {{0, kind.vertex_tangents}});
    Placement placement = place(world_from_object, eye);
    placement.relative_from_screen = back_from(projection);
    for (std::uint32_t triangle = static_cast<std::uint32_t>(2 * side); triangle < 2u * side + 2;
         ++triangle) {
      const raster::TrianglePlanes planes =
          raster::Projection::camera(as_projection(projection), 1e-3).planes(surface, triangle);
      if (planes.degenerate()) continue;
      for (int k = 0; k < 4; ++k) {
        const std::array<double, 3> weights{0.2 + 0.1 * k, 0.6 - 0.15 * k, 0.2 + 0.05 * k};
        vec3<double> p{0, 0, 0};
        for (std::size_t i = 0; i < 3; ++i)
          p = p + weights[i] * surface.positions[mesh.triangles[triangle][i]];
        const vec3<double> q = projection * p;
        raster::Fragment<double> f = raster::make_fragment(surface, triangle, planes, q.x / q.z, q.y / q.z);
        f.front_facing = !view.from_behind;
        f.to_viewer = normalize_or_zero(-f.position);
        const Composition<double> c = compose(program, f, view.mode, placement);
        points.push_back({side, c.base_normal, c.normal, c.surfgrad, c.degenerate});
      }
    }
  }
  return points;
}

} // namespace surfgrad::engine::test
