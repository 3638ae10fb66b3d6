// The usual way: the map's normal times the matrix of interpolated tangent, bitangent and normal, which
// MikkTSpace wants neither normalised nor made orthogonal.
#version 450
#include "surface.glsl"

void main() {
  vec3 m = decoded(texture(map, st));
  vec3 bitangent = tangent.w * cross(normal, tangent.xyz);
  result = vec4(normalize(m.x * tangent.xyz + m.y * bitangent + m.z * normal), 1.0);
}
