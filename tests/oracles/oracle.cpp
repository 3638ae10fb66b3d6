#include "oracles/oracle.hpp"

#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
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

std::string validator_errors(const std::vector<std::filesystem::path>& files) {
  std::string arguments;
  for (const auto& file : files) arguments += fmt::format(" '{}'", file.string());
  const std::string words = run_node("validate.mjs", arguments);
  std::string errors;
  std::size_t judged = 0;
  std::istringstream lines(words);
  for (std::string line; std::getline(lines, line);)
    for (const auto& file : files) {
      const std::string name = file.string() + ": ";
      if (!line.starts_with(name)) continue;
      const std::string_view said = std::string_view(line).substr(name.size());
      if (said.starts_with("error ")) errors += line + "\n";
      if (said.find(" errors, ") == said.npos) continue;
      ++judged;
      // More than are listed, or a count without a list, must not pass.
      if (!said.starts_with("0 errors, ")) errors += line + "\n";
    }
  if (judged != files.size()) throw std::runtime_error("the validator judged too few files\n" + words);
  return errors;
}

} // namespace surfgrad::test
