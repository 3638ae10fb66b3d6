// A normal map on the vertex tangents and one on the second texture coordinate set, whose basis is derived.
#version 450
#include "surface.glsl"
#define SURFGRAD_FRAGMENT
#include "surfgrad.glsl"

void main() {
  SurfgradFrame frame = surfgrad_make_frame_at(position, normal);
  SurfgradTangentFrame vertex = surfgrad_mikktspace_basis(normal, tangent.xyz, tangent.w);
  SurfgradTangentFrame derived = surfgrad_tangent_basis_at(frame, st_2);
  vec2 slope = surfgrad_derivative_from_normal(decoded(texture(map, st)));
  vec2 slope_2 = surfgrad_derivative_from_normal(decoded(texture(map_2, st_2)));
  vec3 surfgrad = surfgrad_from_tbn(slope, vertex.tangent, vertex.bitangent) +
                  surfgrad_from_tbn(slope_2, derived.tangent, derived.bitangent);
  result = vec4(surfgrad_resolve_normal(frame, surfgrad), 1.0);
}
