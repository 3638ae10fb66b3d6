// tbn where the interpolated vectors are normalised first, as engines that do not follow MikkTSpace do.
#version 450
#include "surface.glsl"

void main() {
  vec3 m = decoded(texture(map, st));
  vec3 n = normalize(normal);
  vec3 t = normalize(tangent.xyz);
  vec3 bitangent = tangent.w * cross(n, t);
  result = vec4(normalize(m.x * t + m.y * bitangent + m.z * n), 1.0);
}
