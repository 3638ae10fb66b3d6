#include "engine/reference.hpp"

namespace surfgrad::engine {

Composition<double> compose_reference(const Program& program, const raster::Fragment<double>& fragment,
                                      BackFaces back_faces, const Placement& placement) {
  return compose(program, fragment, back_faces, placement);
}

} // namespace surfgrad::engine
