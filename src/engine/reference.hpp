#pragma once

#include "engine/compose.hpp"
#include "engine/tiles.hpp"

namespace surfgrad::engine {

/// The reference engine: one fragment at a time, in double. The truth that faster engines are
/// tested against.
[[nodiscard]] Composition<double> compose_reference(const Program& program,
                                                    const raster::Fragment<double>& fragment,
                                                    BackFaces back_faces, const Placement& placement);

/// The same for the pixels of a tile; results are rounded to float.
void compose_tile_reference(const TileWork& work);

} // namespace surfgrad::engine
