#version 450
#extension GL_GOOGLE_include_directive : require

// Gustavson's pair (2021), fragment stage: a finer noise bumps the displaced surface. It too is sampled where the
// surface was before it was displaced, so that the pattern does not swim.
// Compile: glslangValidator -V -Ishaders examples/displace_bump.frag

#include "surfgrad.glsl"

layout(location = 0) in vec3 undisplaced;
layout(location = 1) in vec3 displaced_normal;
layout(binding = 0) uniform Transforms {
  mat4 clip_from_object;
  mat3 world_from_object;
};
layout(location = 0) out vec4 colour;

const float height = 0.01; // 1/5 of the noise, which counts by 0.05
const float frequency = 10.0;

void main() {
  SurfgradNoise noise = surfgrad_perlin(frequency * undisplaced);
  SurfgradFrame frame = surfgrad_make_frame(displaced_normal);
  vec3 g = surfgrad_from_volume_gradient(frame.normal, (height * frequency) * noise.gradient);

  vec3 bumped = surfgrad_resolve_normal(frame, g); // in the object's space
  vec3 n = surfgrad_normalize_or_zero(surfgrad_transform_normal(world_from_object, bumped));
  colour = vec4(0.5 * n + 0.5, 1.0);
}
