/// Race: what a normal costs a fragment shader on AMD's GPUs, counted by their compiler.
///
/// Prints the cost of each shader of shader_cost/ on each family as JSON, one object a line.
///
///   shader_cost [NAME ...]    only these shaders; RADV_DEBUG=shaders in the environment shows their code

#include "diagnostic/error.hpp"
#include "shader_cost/amd_compiler.hpp"
#include "shader_cost/shaders.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>

namespace {

constexpr const char* families[] = {"navi21", "gfx1100"};

void print_costs(const std::vector<std::string>& names) {
  for (const char* family : families) {
    const surfgrad::bench::AmdCompiler compiler(family);
    for (const std::string& name : names) {
      const auto fragment = surfgrad::bench::compiled_cost_shader(name + ".frag");
      std::cout << nlohmann::json{{"family", family},
                                  {"driver", compiler.version()},
                                  {"shader", name},
                                  {"statistics", compiler.statistics(fragment)}}
                << '\n';
    }
  }
}

} // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> asked(argv + 1, argv + argc);
    print_costs(asked.empty() ? surfgrad::bench::cost_shader_names() : asked);
    return 0;
  } catch (const surfgrad::MachineError& error) {
    std::fprintf(stderr, "shader-cost: %s\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shader-cost: %s\n", error.what());
    return 1;
  }
}
