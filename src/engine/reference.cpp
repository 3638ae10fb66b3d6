#include "engine/reference.hpp"

namespace surfgrad::engine {

Composition<double> compose_reference(const Program& program, const raster::Fragment<double>& fragment,
                                      BackFaces back_faces, const mat3<double>& world_from_object) {
  return compose(program, fragment, back_faces, world_from_object);
}

} // namespace surfgrad::engine
