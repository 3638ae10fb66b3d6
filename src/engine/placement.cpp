#include "engine/placement.hpp"

#include "raster/surface.hpp"

#include <cmath>
#include <limits>

namespace surfgrad::engine {

Placement place(const mat4<double>& world_from_object, vec3<double> origin) {
  Placement placement;
  placement.world_from_object = world_from_object;
  placement.origin = origin;
  placement.linear = raster::linear_part(world_from_object);
  // Rows in units of their own magnitude: the determinant of a tiny object must not underflow.
  const mat3<double>& m = placement.linear;
  const vec3<double> scale{reciprocal_or_zero(max_abs(m.x)), reciprocal_or_zero(max_abs(m.y)),
                           reciprocal_or_zero(max_abs(m.z))};
  const mat3<double> unit{scale.x * m.x, scale.y * m.y, scale.z * m.z};
  const double det = determinant(unit);
  const bool singular = !(std::abs(det) > std::numeric_limits<double>::epsilon());
  const double inverse_det = singular ? 0.0 : 1.0 / det;
  const mat3<double> adjugate = transpose(cofactor(unit));
  const auto row = [&](vec3<double> r) {
    return inverse_det * vec3<double>{r.x * scale.x, r.y * scale.y, r.z * scale.z};
  };
  placement.inverse_linear = {row(adjugate.x), row(adjugate.y), row(adjugate.z)};
  return placement;
}

} // namespace surfgrad::engine
