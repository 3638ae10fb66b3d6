#include "oracles/oracle.hpp"

#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace surfgrad::test {
namespace {

/// What a script of this folder prints; throws where it does not end well.
std::string run_node(const std::string& script, const std::string& arguments) {
  const std::string command =
      SURFGRAD_NODE " " SURFGRAD_SOURCE_DIR "/tests/oracles/" + script + " " + arguments + " 2>&1";
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  std::string words;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;) words.append(buffer, n);
  const int status = pclose(pipe);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw std::runtime_error(command + "\n" + words + "(scripts/setup installs what it needs)");
  return words;
}

} // namespace

std::string corners_of(const mesh::TriangleMesh& mesh, std::size_t uv_set) {
  const auto corners = static_cast<std::uint32_t>(3 * mesh.triangles.size());
  std::string bytes;
  const auto append = [&](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto append_all = [&](const auto& attribute) {
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) append(attribute[vertex]);
  };
  append(corners);
  append_all(mesh.positions);
  append_all(mesh.normals);
  append_all(mesh.uv_sets[uv_set]);
  return bytes;
}

std::vector<std::vector<vec4<float>>> package_tangents(const std::vector<std::string>& meshes) {
  const TemporaryFolder folder;
  std::string all;
  for (const std::string& mesh : meshes) all += mesh;
  const std::filesystem::path in = folder.write("in", all);
  const std::filesystem::path out = folder.path() / "out";
  (void)run_node("mikktspace.mjs", "make " + in.string() + " " + out.string());

  std::ifstream file(out, std::ios::binary);
  std::vector<std::vector<vec4<float>>> results;
  for (const std::string& mesh : meshes) {
    std::uint32_t corners = 0;
    std::memcpy(&corners, mesh.data(), sizeof corners);
    std::vector<vec4<float>>& tangents = results.emplace_back(corners);
    file.read(reinterpret_cast<char*>(tangents.data()),
              static_cast<std::streamsize>(corners * sizeof tangents[0]));
    if (!file) throw std::runtime_error("mikktspace.mjs wrote too few tangents");
  }
  return results;
}

std::string validator_errors(const std::filesystem::path& file) {
  const std::string words = run_node("validate.mjs", fmt::format("'{}'", file.string()));
  std::string errors;
  bool is_counted = false;
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find('\n', begin), words.size() - 1);
    const std::string_view line = std::string_view(words).substr(begin, end + 1 - begin);
    if (line.starts_with(file.string() + ": error ")) errors += line;
    if (line.starts_with(file.string() + ": 0 errors")) is_counted = true;
    begin = end + 1;
  }
  return errors.empty() && !is_counted ? words : errors;
}

} // namespace surfgrad::test
