#include "bake/format.hpp"

#include <stdexcept>

namespace surfgrad::bake {

image::NormalFormat format_of(const Options& options) {
  if (options.encoding != Encoding::rgb && options.space != Space::tangent)
    throw std::invalid_argument("two channels hold normals of a tangent space alone");
  return image::NormalFormat({.encoding = options.encoding,
                              .green_up = options.green == stack::Green::up,
                              .full_blue = options.full_blue,
                              .depth = options.depth,
                              .range = options.range,
                              .neutral = options.neutral == stack::NeutralCode::whole
                                             ? image::NeutralCode::whole
                                             : image::NeutralCode::between});
}

} // namespace surfgrad::bake
