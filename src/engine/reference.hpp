#pragma once

#include "engine/compose.hpp"

namespace surfgrad::engine {

/// The reference engine: one fragment at a time, in double. The truth that faster engines are
/// tested against.
[[nodiscard]] Composition<double> compose_reference(const Program& program,
                                                    const raster::Fragment<double>& fragment,
                                                    BackFaces back_faces, const Placement& placement);

} // namespace surfgrad::engine
