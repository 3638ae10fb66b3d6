// Schueler's cotangent frame (2013): one normal map without vertex tangents. The gradients of s and t over
// the surface, scaled by the longer of them.
#version 450
#include "surface.glsl"

void main() {
  vec3 n = normalize(normal);
  vec3 dp_dx = dFdx(position);
  vec3 dp_dy = dFdy(position);
  vec2 dst_dx = dFdx(st);
  vec2 dst_dy = dFdy(st);
  vec3 across_y = cross(dp_dy, n);
  vec3 across_x = cross(n, dp_dx);
  vec3 grad_s = across_y * dst_dx.x + across_x * dst_dy.x;
  vec3 grad_t = across_y * dst_dx.y + across_x * dst_dy.y;
  float scale = inversesqrt(max(dot(grad_s, grad_s), dot(grad_t, grad_t)));
  vec3 m = decoded(texture(map, st));
  result = vec4(normalize(m.x * scale * grad_s + m.y * scale * grad_t + m.z * n), 1.0);
}
