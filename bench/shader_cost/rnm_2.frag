// The usual way with a detail map: blended in tangent space by reoriented normal mapping.
#version 450
#include "surface.glsl"
#include "rnm.glsl"

void main() {
  vec3 m = reoriented(decoded(texture(map, st)), decoded(texture(map_2, st)));
  vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
  result = vec4(normalize(m.x * tangent.xyz + m.y * bitangent + m.z * normal), 1.0);
}
