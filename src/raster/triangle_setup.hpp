#pragma once

#include "raster/surface.hpp"

#include <array>
#include <type_traits>

namespace surfgrad::raster {

/// An attribute near a centre: its value there and its change per pixel to the right and upwards.
struct Plane {
  float at, dx, dy;
};

/// How a triangle's attributes vary around one of its pixels: what lanes interpolate, in float.
///
/// With d the change of the raster position and q = 1 + qx d.x + qy d.y, an attribute is
/// a = at + (dx d.x + dy d.y) / q, exactly perspective-correct, and its derivative (dx - (a - at) qx) / q.
/// Set up in double around a covered pixel of the tile that is drawn: what is rounded is small there.
struct TriangleSetup {
  float x, y;              ///< the centre, in pixels
  float qx, qy;            ///< relative change of 1 / w; zero in a texture
  float front_facing;      ///< 1 or 0
  vec3<float> flat_normal; ///< the triangle's own, unit; zero where vertex normals cannot cancel
  std::array<Plane, 3> position, object_position, normal;
  struct Coordinates {
    std::array<Plane, 2> st;
    std::array<Plane, 3> tangent;
    float sign;
  };
  std::array<Coordinates, max_uv_slots> slots; ///< only those of the surface are set
};
static_assert(std::is_standard_layout_v<TriangleSetup>); // lanes address its floats by offset

/// The setup of a triangle around a pixel centre (x, y) that it covers.
///
/// front_facing  is the winding in the raster, corrected for a mirroring transform
void set_up(const Surface& surface, std::uint32_t triangle, const TrianglePlanes& planes, double x, double y,
            TriangleSetup& setup);

} // namespace surfgrad::raster
