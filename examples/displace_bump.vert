#version 450
#extension GL_GOOGLE_include_directive : require

// Gustavson's pair (2021), vertex stage: noise displaces the surface along its normal. The gradient of the same
// noise gives the displaced surface's normal. No texture coordinates, no tangents.
// Compile: glslangValidator -V -Ishaders examples/displace_bump.vert

#include "surfgrad.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(binding = 0) uniform Transforms {
  mat4 clip_from_object;
  mat3 world_from_object;
};
layout(location = 0) out vec3 undisplaced;
layout(location = 1) out vec3 displaced_normal;

const float height = 0.1; // units of the object that a value of 1 moves the surface
const float frequency = 2.0;

void main() {
  SurfgradNoise noise = surfgrad_perlin(frequency * position);
  SurfgradFrame frame = surfgrad_make_frame(normal);
  // Sampling at frequency * position multiplies the gradient by the frequency.
  vec3 g = surfgrad_from_volume_gradient(frame.normal, (height * frequency) * noise.gradient);

  undisplaced = position;
  displaced_normal = surfgrad_resolve_normal(frame, g);
  gl_Position = clip_from_object * vec4(position + (height * noise.value) * frame.normal, 1.0);
}
