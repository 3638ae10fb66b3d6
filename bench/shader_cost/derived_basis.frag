// One normal map on a derived basis: no vertex tangents.
#version 450
#include "surface.glsl"
#define SURFGRAD_FRAGMENT
#include "surfgrad.glsl"

void main() {
  SurfgradFrame frame = surfgrad_make_frame_at(position, normal);
  SurfgradTangentFrame derived = surfgrad_tangent_basis_at(frame, st);
  vec2 slope = surfgrad_derivative_from_normal(decoded(texture(map, st)));
  vec3 surfgrad = surfgrad_from_tbn(slope, derived.tangent, derived.bitangent);
  result = vec4(surfgrad_resolve_normal(frame, surfgrad), 1.0);
}
