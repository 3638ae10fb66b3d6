#pragma once

#include "bake/verify.hpp"

namespace surfgrad::bake {

/// Verification::on_screen.
///
/// scene  displaced
[[nodiscard]] Deviation compare_on_screen(const scene::Scene& scene, const Options& options,
                                          const image::Image& map, const Report& report);

} // namespace surfgrad::bake
