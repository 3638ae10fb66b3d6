// Two normal maps on the vertex tangents: their slopes add.
#version 450
#include "surface.glsl"
#define SURFGRAD_FRAGMENT
#include "surfgrad.glsl"

void main() {
  vec2 slope = surfgrad_derivative_from_normal(decoded(texture(map, st)));
  slope += surfgrad_derivative_from_normal(decoded(texture(map_2, st)));
  result = vec4(surfgrad_resolve_mikktspace(normal, tangent.xyz, tangent.w, slope), 1.0);
}
