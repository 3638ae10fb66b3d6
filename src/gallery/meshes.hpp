#pragma once

#include "mesh/triangle_mesh.hpp"

#include <surfgrad/vec.hpp>

#include <functional>

namespace surfgrad::gallery {

/// A vertex of a built-in mesh.
struct SurfacePoint {
  vec3<double> position;
  vec3<double> normal; ///< unit
};

/// Appends a grid over (s, t) in [0, 1]^2 to a mesh with one UV set. point(s, t) runs
/// counter-clockwise seen from outside; uv(s, t) is its texture coordinate.
void append_patch(mesh::TriangleMesh& mesh, int columns, int rows,
                  const std::function<SurfacePoint(double s, double t)>& point,
                  const std::function<vec2<double>(double s, double t)>& uv);

/// Angle of a part of a whole turn in [0, 1]: 0 and 1 give the same, so that what closes, closes.
[[nodiscard]] double turn(double part);

// Closed surfaces around the origin, given by their points in every direction, with two UV sets.
// Set 0 is an unwrap, right for baking: the six sides of a cube as charts in three columns and two
// rows, turned by quarters as a packer would turn them, the last one mirrored. Set 1 is made for
// tiling: longitude over one period and latitude over half of one, seamless but for a pinch at each
// pole (at +-y).

/// cells: quads along each side's edges, even, so that the set's seam runs along edges.
[[nodiscard]] mesh::TriangleMesh closed_surface(int cells,
                                                const std::function<SurfacePoint(vec3<double>)>& point);

/// Where the unwrap (set 0) shows the direction that a texture coordinate belongs to. Beyond the
/// border of a chart its side continues. unit length.
[[nodiscard]] vec3<double> unwrapped_direction(vec2<double> uv);

/// uv itself within a chart; else the nearest texture coordinate that lies inside the chart of its cell
/// by a part `inset` of half the chart.
[[nodiscard]] vec2<double> nearest_in_chart(vec2<double> uv, double inset);

/// The unit sphere.
[[nodiscard]] SurfacePoint ball_point(vec3<double> direction);

/// A cube from -1 to 1 with rounded edges.
[[nodiscard]] SurfacePoint rounded_cube_point(vec3<double> direction);

/// A pill along x: a cylinder of radius 0.55 and length 1.2 with half balls at its ends.
[[nodiscard]] SurfacePoint pill_point(vec3<double> direction);

/// A boulder of about unit radius: noise raises and dents it, more finely with more octaves.
[[nodiscard]] SurfacePoint rock_point(vec3<double> direction, int octaves);

/// Normal of the rock if ledges ran around it, level on top and steep below. unit length.
[[nodiscard]] vec3<double> ledged_rock_normal(vec3<double> direction);

/// Octaves that the rock's mesh has, and those of the rock that its normal map was baked from.
inline constexpr int rock_mesh_octaves = 3;
inline constexpr int rock_all_octaves = 8;

/// The rock as a game would have it: a coarse mesh whose finer shape is left to a normal map.
[[nodiscard]] mesh::TriangleMesh rock_mesh();

/// A coarse torus about the y axis whose two halves share their texture: the half at x < 0 is mirrored
/// in UV set 0.
[[nodiscard]] mesh::TriangleMesh half_mirrored_torus();

/// A part of a horizontal cylinder of radius 2.5 along x, like the back of a barrel: 5 wide, from 65 degrees
/// at the rear over the top, at the origin, to 45 at the front. One UV set, a period per unit of length.
[[nodiscard]] mesh::TriangleMesh barrel();

/// A level square, 8 units wide, with one UV set over [0, 1]^2.
[[nodiscard]] mesh::TriangleMesh ground();

/// A sheet that curls up to a scroll, so that both of its sides are seen from the front. Open,
/// facing outwards.
[[nodiscard]] mesh::TriangleMesh scroll();

/// A square of edge 2 around the origin, facing up; uv runs over [0, 1]^2, s along +x and t along -z. With
/// bend > 0 it is part of a cylinder about an axis along x that lies 1 / bend below.
[[nodiscard]] mesh::TriangleMesh sheet(int cells, double bend = 0);

} // namespace surfgrad::gallery
