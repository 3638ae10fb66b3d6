// The vertex stage of every language moves and turns vertices as `surfgrad displace` does.

#include "displace/scene.hpp"
#include "exported/runner.hpp"
#include "gallery/figures.hpp"
#include "mesh/precision.hpp"
#include "stacks.hpp"
#include "support/angle.hpp"
#include "support/random.hpp"
#include "support/vulkan.hpp"

#include <cmath>

namespace surfgrad::shadergen::test {
namespace {

using mesh::narrow, mesh::widen;

/// Triangles apart from each other: what C++ averages where triangles meet is the triangle's own here, as a
/// vertex stage has it.
std::vector<mesh::TriangleMesh> some_triangles(const mesh::TriangleMesh& mesh) {
  constexpr std::size_t every = 7; // some hundred of the gallery's sheet, in all of its columns and rows
  std::vector<mesh::TriangleMesh> all;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += every) {
    mesh::TriangleMesh one;
    for (const std::uint32_t v : mesh.triangles[i]) {
      one.positions.push_back(mesh.positions[v]);
      one.normals.push_back(mesh.normals[v]);
    }
    for (const auto& set : mesh.uv_sets) {
      one.uv_sets.emplace_back();
      for (const std::uint32_t v : mesh.triangles[i]) one.uv_sets.back().push_back(set[v]);
    }
    one.triangles = {{0, 1, 2}};
    one.material_of_triangle = {0};
    all.push_back(std::move(one));
  }
  return all;
}

void append(std::vector<float>& to, vec3<float> v) { to.insert(to.end(), {v.x, v.y, v.z}); }

/// What a vertex stage is handed: position and normal, and where a map displaces, texture coordinate and the
/// derivatives of the position by it.
std::vector<float> inputs_of(const std::vector<mesh::TriangleMesh>& triangles, bool by_map) {
  std::vector<float> inputs;
  for (const mesh::TriangleMesh& t : triangles)
    for (std::size_t v = 0; v < 3; ++v) {
      append(inputs, t.positions[v]);
      append(inputs, t.normals[v]);
      if (!by_map) continue;
      const auto edge = [&](std::size_t k) { return widen(t.positions[k]) - widen(t.positions[0]); };
      const auto step = [&](std::size_t k) { return widen(t.uv_sets[0][k]) - widen(t.uv_sets[0][0]); };
      const double area = cross(step(1), step(2));
      inputs.insert(inputs.end(), {t.uv_sets[0][v].x, t.uv_sets[0][v].y});
      append(inputs, narrow((1 / area) * (step(2).y * edge(1) - step(1).y * edge(2))));
      append(inputs, narrow((1 / area) * (step(1).x * edge(2) - step(2).x * edge(1))));
    }
  return inputs;
}

class DisplacedVertices : public surfgrad::test::VulkanTest {
 protected:
  static void compare(const scene::Scene& whole) {
    scene::Scene scene = whole;
    scene.meshes = some_triangles(whole.meshes[0]);
    scene.displace->subdivide = 0;
    const scene::Scene moved = displace::displaced(scene)->scene;
    const bool by_map = scene.displace->map.has_value();
    const std::vector<float> inputs = inputs_of(scene.meshes, by_map);
    const FindImage find = [&](const std::filesystem::path& file) -> const image::Image& {
      return scene.image(file);
    };
    Runner runner(device());
    for (const Language language : every_language) {
      Options options;
      options.language = language;
      options.standalone = true;
      options.displace = &*scene.displace;
      options.origin = language == Language::glsl ? TextureOrigin::lower_left : TextureOrigin::upper_left;
      const Shader shader = generate({}, options);
      const Program program = vertex_program(shader, by_map);
      const auto pipeline = runner.pipeline(shader, spirv_of({&program})[0]);
      const std::vector<float> out = runner.run(*pipeline, shader, program, options.origin, find, inputs);
      double off = 0, turned = 0, way = 0;
      for (std::size_t i = 0; i < 3 * scene.meshes.size(); ++i) {
        const mesh::TriangleMesh& expected = moved.meshes[i / 3];
        const float* v = &out[6 * i];
        const vec3<double> position = widen(expected.positions[i % 3]);
        off = std::max(off, length(vec3<double>{v[0], v[1], v[2]} - position));
        way = std::max(way, length(widen(scene.meshes[i / 3].positions[i % 3]) - position));
        turned =
            std::max(turned, surfgrad::test::unit_angle({v[3], v[4], v[5]}, widen(expected.normals[i % 3])));
      }
      std::printf(
          "  language %d: of %zu vertices, moved by up to %.3g, positions are off by %.2g, normals turned by "
          "%.2g degrees\n",
          static_cast<int>(language), 3 * scene.meshes.size(), way, off, turned);
      EXPECT_GT(way, 0.1) << "nothing has moved";
      // Positions of about 1 are rounded to float on both sides; what is added to them is a tenth of that.
      EXPECT_LE(off, 8 * 0x1p-24);
      // A hundred operations in float on slopes of about 1: 100 * 2^-23 radians.
      EXPECT_LE(turned, 0.001);
    }
  }
};

TEST_F(DisplacedVertices, OfTheGallerysHeightMap) {
  int displaced = 0;
  for (const gallery::Figure& figure : gallery::built_in_figures())
    for (const gallery::Panel& panel : figure.panels)
      if (figure.id == "parallax" && panel.id == "displaced") {
        compare(panel.scene());
        ++displaced;
      }
  EXPECT_EQ(displaced, 1);
}

TEST_F(DisplacedVertices, OfNoise) {
  const NamedStack lumps = parsed("lumps", R"({ "surfgrad": 1, "layers": [],
    "displace": { "function": "fractal_sum", "octaves": 2, "frequency": 2, "offset": [0.3, 0.1, 0.7],
                  "height": 0.22, "level": 0.05 } })");
  scene::Scene scene;
  scene.displace = lumps.displace;
  mesh::TriangleMesh ball;
  surfgrad::test::Random random(77);
  for (std::uint32_t i = 0; i < 7 * 300; ++i) { // no two at one place
    for (int k = 0; k < 3; ++k) ball.positions.push_back(narrow(random.unit_vector()));
    ball.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  ball.normals = ball.positions;
  scene.meshes = {ball};
  compare(scene);
}

} // namespace
} // namespace surfgrad::shadergen::test
