// What every shader of this folder gets from its mesh and its material, and what it gives: nothing here costs
// anything unless it is used.
layout(location = 0) in vec3 position; // relative to the eye, in world space, as all vectors
layout(location = 1) in vec3 normal;   // interpolated, not normalised
layout(location = 2) in vec4 tangent;  // interpolated, not normalised; w is the handedness
layout(location = 3) in vec2 st;
layout(location = 4) in vec2 st_2; // of the second texture coordinate set

layout(set = 0, binding = 0) uniform sampler2D map;
layout(set = 0, binding = 1) uniform sampler2D map_2;
layout(set = 0, binding = 2) uniform sampler2D map_3;

layout(location = 0) out vec4 result; // the perturbed normal, into a target of halves

// The tangent-space normal that three 8-bit channels stand for.
vec3 decoded(vec4 texel) { return 2.0 * texel.xyz - 1.0; }
