/// Race: MikkTSpace tangents of a torus of a million corners.
///
/// Peer    the npm package `mikktspace`: its author's code as WebAssembly, in Node.js.
/// Method  The same corners on one thread, in memory on both sides. The package gets every corner on its own,
/// as
///         its interface asks; we get them so, which is our slow case, and as a mesh with shared vertices,
///         which is what we have. Its results equal ours bit for bit: a test sees to that.

#include "child_process.hpp"
#include "mesh/mikktspace.hpp"
#include "race.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

namespace surfgrad::bench {
namespace {

namespace fs = std::filesystem;

/// A torus with waves in its texture, in quads of two triangles.
mesh::TriangleMesh torus(int columns, int rows) {
  mesh::TriangleMesh mesh;
  mesh.uv_sets.resize(1);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double s = static_cast<double>(i) / columns;
      const double t = static_cast<double>(j) / rows;
      const double u = 2 * std::numbers::pi * s;
      const double v = 2 * std::numbers::pi * t;
      const auto to_float = [](double x) { return static_cast<float>(x); };
      const vec3<float> n{to_float(std::cos(v) * std::sin(u)), to_float(std::sin(v)),
                          to_float(std::cos(v) * std::cos(u))};
      mesh.positions.push_back(vec3<float>{to_float(std::sin(u)), 0, to_float(std::cos(u))} + 0.4f * n);
      mesh.normals.push_back(n);
      mesh.uv_sets[0].push_back(
          {to_float(s + 0.02 * std::sin(40 * t)), to_float(t + 0.03 * std::cos(31 * s))});
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const auto vertex = [&](int x, int y) { return static_cast<std::uint32_t>(y * (columns + 1) + x); };
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return mesh;
}

/// The same with every corner a vertex.
mesh::TriangleMesh without_sharing(const mesh::TriangleMesh& mesh) {
  mesh::TriangleMesh apart;
  apart.uv_sets.resize(1);
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(apart.positions.size());
    for (const std::uint32_t vertex : triangle) {
      apart.positions.push_back(mesh.positions[vertex]);
      apart.normals.push_back(mesh.normals[vertex]);
      apart.uv_sets[0].push_back(mesh.uv_sets[0][vertex]);
    }
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  return apart;
}

/// As mikktspace.mjs reads it.
void write_corners(const mesh::TriangleMesh& apart, const fs::path& name) {
  std::ofstream file(name, std::ios::binary);
  const auto write = [&](const void* what, std::size_t size) {
    file.write(static_cast<const char*>(what), static_cast<std::streamsize>(size));
  };
  const auto corners = static_cast<std::uint32_t>(apart.positions.size());
  write(&corners, sizeof corners);
  write(apart.positions.data(), corners * sizeof apart.positions[0]);
  write(apart.normals.data(), corners * sizeof apart.normals[0]);
  write(apart.uv_sets[0].data(), corners * sizeof apart.uv_sets[0][0]);
}

void race(const Request& request) {
  const mesh::TriangleMesh mesh = request.quick ? torus(64, 64) : torus(420, 400);
  const mesh::TriangleMesh apart = without_sharing(mesh);
  const double corners = 3.0 * static_cast<double>(mesh.triangles.size());
  const Heat heat{.race = "tangents",
                  .title = fmt::format("{:.0f} corners", corners),
                  .unit = "corner",
                  .items = corners,
                  .rounds = request.rounds};

  const fs::path file = fs::temp_directory_path() / fmt::format("surfgrad_bench_{}", std::random_device{}());
  write_corners(apart, file);
  ChildProcess package({"node", SURFGRAD_SOURCE_DIR "/tests/oracles/mikktspace.mjs", "race", file.string()},
                       "mikktspace: ");
  const bool is_there = package.answer().has_value();
  fs::remove(file);
  if (!is_there)
    report_absent("tangents", "npm mikktspace", "`node` does not run tests/oracles/mikktspace.mjs");

  std::vector<Contestant> contestants;
  for (const auto& [name, input] : {std::pair{"surfgrad, vertices shared", &mesh},
                                    std::pair{"surfgrad, every corner on its own", &apart}})
    contestants.push_back(
        {name, [input = input] { return timed([&] { (void)mesh::generate_tangents(*input, 0); }); }});
  if (is_there)
    contestants.push_back({"npm mikktspace, every corner on its own", [&] {
                             package.tell("go");
                             const std::string seconds = package.answer().value_or("nan nan");
                             std::size_t end = 0;
                             const double cpu = std::stod(seconds, &end);
                             return Time{cpu, std::stod(seconds.substr(end))};
                           }});
  const std::vector<Result> results = run(heat, contestants);
  if (!is_there) return;
  report_ratio(heat, "surfgrad over npm mikktspace, vertices shared", times_faster(results[2], results[0]),
               {2});
  report_ratio(heat, "surfgrad over npm mikktspace, every corner on its own",
               times_faster(results[2], results[1]), {2});
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) { surfgrad::bench::race(surfgrad::bench::parse_request(argc, argv)); }
