#pragma once

#include "mesh/triangle_mesh.hpp"

namespace surfgrad::mesh {

/// Where subdivide puts the vertex in the middle of an edge.
enum class EdgeShape {
  straight, ///< halfway between the ends: the surface stays as it is
  curved, ///< on a cubic that leaves both ends perpendicular to their normals: a smooth mesh becomes smoother
};

/// The mesh with every triangle cut at the middles of its edges into four, `levels` times over. Vertices
/// keep their numbers and bits, new ones follow; triangle i becomes the triangles from i * 4^levels on.
///
/// levels   0 or more: 4^levels triangles for each
/// curved   the middle of a cubic PN triangle's edge, its normal that of the ends made perpendicular to the
///          cubic; straight edges take the mean of both
/// returns  normals unit, texture coordinates halfway, tangents of each corner halfway and unit, with
///          the w of their triangle
///
/// Edges stay closed: a middle depends on the positions and normals at the ends of its edge alone, to
/// the bit, whichever triangle asks and in whichever direction. So vertices doubled for their texture
/// coordinates split into doubled vertices at one place. Where the sides of an edge have different
/// normals (a crease) the cubics part; the middles then meet halfway between them.
///
/// degenerate  normals and tangents that are opposed give (0, 0, 0); zero normals leave an edge straight
/// fails       MachineError for more triangles or vertices than 32 bits can number
/// source      edges: Vlachos et al., "Curved PN Triangles", 2001, at the parameter 1/2
[[nodiscard]] TriangleMesh subdivide(const TriangleMesh& mesh, int levels,
                                     EdgeShape shape = EdgeShape::straight);

} // namespace surfgrad::mesh
