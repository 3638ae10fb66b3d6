#pragma once

#include "bake/bake.hpp"
#include "image/normal_format.hpp"

namespace surfgrad::bake {

/// How the texels of a bake stand for normals. Throws std::invalid_argument where the encoding cannot hold
/// the space.
[[nodiscard]] image::NormalFormat format_of(const Options& options);

} // namespace surfgrad::bake
