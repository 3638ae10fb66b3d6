// One derivative map, slopes within +-1, on the vertex tangents.
#version 450
#include "surface.glsl"
#define SURFGRAD_FRAGMENT
#include "surfgrad.glsl"

void main() {
  vec2 slope = 2.0 * texture(map, st).xy - 1.0;
  result = vec4(surfgrad_resolve_mikktspace(normal, tangent.xyz, tangent.w, slope), 1.0);
}
