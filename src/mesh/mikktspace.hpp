#pragma once

#include "mesh/triangle_mesh.hpp"

#include <cstddef>

namespace surfgrad::mesh {

/// MikkTSpace tangents of one UV set: the basis that baked normal maps are encoded in.
///
/// mesh     texture t up, triangles counter-clockwise, one normal a vertex (unit length expected).
///          How vertices are indexed does not matter: corners of equal position, normal and texture
///          coordinate are one vertex.
/// uv_set   index into mesh.uv_sets; out of range is a mistake of the caller (assert).
/// returns  one entry a triangle corner. xyz: unit tangent, perpendicular to the corner's normal.
///          w: +1 where the triangle's texture area is positive, else -1; bitangent = w * cross(n, t)
///          points along +t. With t pointing down (glTF's v = 1 - t) the tangent is the same and w
///          the opposite.
/// cost     linear in the number of corners but for sorting edges at a vertex, no recursion. The
///          result does not depend on how vertices are indexed.
/// fails    MachineError for more corners than 32 bits can number.
///
/// Degenerate cases, as in Mikkelsen's own code:
/// - a triangle without texture area (or with a non-finite one) takes the tangent of the neighbours
///   with which it shares a vertex and an edge, and gives nothing to it;
/// - a triangle with two corners at one position takes, corner by corner, the tangent of the first
///   sound triangle with the same vertex;
/// - where there is no such neighbour: (1, 0, 0, -1), whatever the normal;
/// - tangents that cancel, or that are parallel to the normal, give (0, 0, 0, w).
///
/// Other than in that code:
/// - a result that is not finite (NaN input or overflow) becomes (1, 0, 0, w);
/// - a vertex with more than 2048 triangles is averaged whole even if some tangents are opposed;
/// - every edge is paired; that code leaves the edges of the last vertex in its own order unsorted
///   and may miss neighbours there. An isolated triangle appended to its input takes that place.
/// Everything else is equal bit for bit where the arccosine, a double rounded to float, is: tests/oracles
/// compares every corner of the models at hand and of meshes that are made to be hard with his code's.
///
/// source   Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008, and the behaviour of his
///          implementation of 2011 at its default angle of 180 degrees.
[[nodiscard]] TangentSpace generate_tangents(const TriangleMesh& mesh, std::size_t uv_set);

} // namespace surfgrad::mesh
