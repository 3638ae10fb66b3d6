// rnm_3 by a reader of disassembly: the blend grouped so that it costs least.
#version 450
#include "surface.glsl"
#include "rnm.glsl"

void main() {
  vec3 m = reoriented_regrouped(decoded(texture(map, st)), decoded(texture(map_2, st)));
  m = reoriented_regrouped(m, decoded(texture(map_3, st)));
  vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
  result = vec4(normalize(m.x * tangent.xyz + m.y * bitangent + m.z * normal), 1.0);
}
