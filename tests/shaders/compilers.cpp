#include "shaders/compilers.hpp"

#include "support/temporary_folder.hpp"

#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace surfgrad::test {
namespace {

/// Runs a command; what it prints on either stream is the message.
Verdict run(const std::string& command) {
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  Verdict verdict;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;)
    verdict.messages.append(buffer, n);
  const int status = pclose(pipe);
  verdict.accepted = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  return verdict;
}

/// glslang prints the name of every file that it compiles.
Verdict run_glslang(const std::string& arguments, const std::string& file) {
  Verdict verdict = run("glslangValidator " + arguments + " " + file);
  if (verdict.accepted && verdict.messages == file + "\n") verdict.messages.clear();
  return verdict;
}

/// What is compiled may include files of shaders/.
Verdict compile_for_vulkan(const TemporaryFolder& folder, const std::string& arguments,
                           const std::string& file) {
  const std::string spirv = (folder.path() / "shader.spv").string();
  const Verdict verdict = run_glslang(
      "-V --target-env vulkan1.1 -I" SURFGRAD_SOURCE_DIR "/shaders " + arguments + " -o " + spirv, file);
  if (!verdict.accepted) return verdict;
  return run("spirv-val --target-env vulkan1.1 " + spirv);
}

} // namespace

std::string library(const std::string& name) {
  std::ifstream file(SURFGRAD_SOURCE_DIR "/shaders/" + name, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read shaders/" + name);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Verdict compile_glsl(const std::string& text, const std::string& stage) {
  const TemporaryFolder folder;
  const std::string file = folder.write("shader." + stage, text).string();
  const Verdict parsed = run_glslang("-S " + stage, file);
  const bool is_es = text.substr(0, text.find('\n')).ends_with(" es");
  return is_es || !parsed.accepted || !parsed.messages.empty()
             ? parsed
             : compile_for_vulkan(folder, "-S " + stage, file);
}

Verdict compile_glsl_file(const std::string& file, const std::string& stage) {
  return compile_for_vulkan(TemporaryFolder(), "-S " + stage, SURFGRAD_SOURCE_DIR "/" + file);
}

Verdict compile_glsl_with_includes(const std::string& text, const std::string& stage) {
  const TemporaryFolder folder;
  return compile_for_vulkan(folder, "-S " + stage, folder.write("shader." + stage, text).string());
}

Verdict compile_hlsl(const std::string& text, const std::string& stage) {
  const TemporaryFolder folder;
  return compile_for_vulkan(folder, "-D -e main -S " + stage, folder.write("shader.hlsl", text).string());
}

Verdict compile_wgsl(const std::string& text) {
  const TemporaryFolder folder;
  const std::string file = folder.write("shader.wgsl", text).string();
  return run("node " SURFGRAD_SOURCE_DIR "/tests/conformance/wgsl.mjs check " + file);
}

} // namespace surfgrad::test
