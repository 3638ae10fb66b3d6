#include "shader_cost/shaders.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace surfgrad::bench {
namespace {

const std::filesystem::path project = SURFGRAD_SOURCE_DIR;
const std::filesystem::path own_folder = project / "bench/shader_cost";

/// The text of a file with the included ones in their places.
std::string with_includes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  constexpr std::string_view include = "#include \"";
  std::ostringstream text;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(include)) {
      text << line << '\n';
      continue;
    }
    const std::string name = line.substr(include.size(), line.rfind('"') - include.size());
    const std::filesystem::path own = own_folder / name;
    text << with_includes(std::filesystem::exists(own) ? own : project / "shaders" / name);
  }
  return text.str();
}

} // namespace

std::vector<std::string> cost_shader_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(own_folder))
    if (entry.path().extension() == ".frag") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

gpu::Spirv compiled_cost_shader(std::string_view file_name) {
  gpu::ShaderSource source;
  source.text = with_includes(own_folder / file_name);
  source.name = file_name;
  source.stage = file_name.ends_with(".vert") ? gpu::ShaderStage::vertex : gpu::ShaderStage::fragment;
  return gpu::compile(source);
}

} // namespace surfgrad::bench
