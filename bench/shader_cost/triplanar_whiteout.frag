// The usual way of projecting along the axes of the world: each plane's normal is added to the surface's
// (whiteout blending) and turned to where the plane looks, without a basis.
#version 450
#include "surface.glsl"

void main() {
  vec3 n = normalize(normal);
  vec3 weights = max(abs(n) - 0.2, 0.0);
  weights = weights * weights * weights;
  weights /= weights.x + weights.y + weights.z;
  vec3 x = decoded(texture(map, position.zy));
  vec3 y = decoded(texture(map, position.xz));
  vec3 z = decoded(texture(map, position.xy));
  x = vec3(x.xy + n.zy, abs(x.z) * n.x);
  y = vec3(y.xy + n.xz, abs(y.z) * n.y);
  z = vec3(z.xy + n.xy, abs(z.z) * n.z);
  result = vec4(normalize(weights.x * x.zyx + weights.y * y.xzy + weights.z * z), 1.0);
}
