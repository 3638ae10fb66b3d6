#include "shadergen/layers/layers.hpp"

namespace surfgrad::shadergen {

void write(const stack::ResolveLayer&, Generator& generator) {
  const std::string normal = generator.resolved();
  generator.begin_pass(
      generator.value("frame", "SurfgradFrame",
                      fmt::format("surfgrad_rebase_frame({}, {})", generator.frame(), normal)),
      false);
}

} // namespace surfgrad::shadergen
