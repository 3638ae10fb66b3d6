// The bump layers of torus.json, written by surfgrad.
//
//   TorusSurface s; // what the layers read: fill it in
//   TorusResult r = torus_normal(s);
//
// In fragment shaders define SURFGRAD_FRAGMENT before this: torus_with_derivatives(s) then gives s its
// derivatives.

#include "surfgrad.glsl"

// OpenGL ES gives its bindings in the program; other numbers: define these before.
#ifndef SURFGRAD_BINDING
#ifdef GL_ES
#define SURFGRAD_BINDING(n)
#define SURFGRAD_TEXTURE(n) uniform highp
#else
#define SURFGRAD_BINDING(n) , binding = n
#define SURFGRAD_TEXTURE(n) layout(binding = n) uniform
#endif
#endif

layout(std140 SURFGRAD_BINDING(0)) uniform TorusParameters {
  float layer0_scale; // layers[0] normal_map: scale of the bumps
  float layer0_opacity; // layers[0] normal_map: opacity, 0 to 1
  vec2 layer0_tile; // layers[0] normal_map: repetitions of the map
  float layer1_scale; // layers[1] normal_map: scale of the bumps
  float layer1_opacity; // layers[1] normal_map: opacity, 0 to 1
  float layer3_scale; // layers[3] normal_map: scale of the bumps
  float layer3_opacity; // layers[3] normal_map: opacity, 0 to 1
  vec2 layer3_tile; // layers[3] normal_map: repetitions of the map
  vec2 layer3_rotation; // layers[3] normal_map: cosine and sine of the turn of the map
  float layer4_scale; // layers[4] noise: height of the function
  float layer4_opacity; // layers[4] noise: opacity, 0 to 1
  float layer4_frequency; // layers[4] noise: cells per unit of the space
  float layer4_lacunarity; // layers[4] noise: frequency of an octave by that of the one before
  float layer4_gain; // layers[4] noise: amplitude of an octave by that of the one before
  float layer4_power; // layers[4] noise: the function is raised to it
  float unused72;
  float unused76;
} torus_parameters;

SURFGRAD_TEXTURE(1) sampler2D torus_layer0_map;
SURFGRAD_TEXTURE(2) sampler2D torus_layer1_mask;
SURFGRAD_TEXTURE(3) sampler2D torus_layer1_map;

// A volume gradient of object space in world space, in units of a height along the base normal.
vec3 torus_object_gradient_in_world(mat3 world_from_object, mat3 object_from_world, vec3 normal,
    vec3 gradient) {
  float stretch = length(transpose(world_from_object) * normal);
  return stretch * (transpose(object_from_world) * gradient);
}

// What a volume gradient of object space adds to the sum: N - G becomes M^-T (N - G) as a whole (Golubev,
// equation 33).
vec3 torus_from_object_gradient(mat3 world_from_object, mat3 object_from_world, vec3 normal, vec3 gradient) {
  vec3 object_normal = surfgrad_normalize_or_zero(transpose(world_from_object) * normal);
  vec3 g = torus_object_gradient_in_world(world_from_object, object_from_world, normal, gradient);
  return g - dot(object_normal, gradient) * normal;
}

// What the stack reads of a surface.
struct TorusSurface {
  vec3 position; // world space, where the surface lies
  vec3 normal; // world space, interpolated, not normalised
  vec3 dp_dx; // change of position per pixel along x
  vec3 dp_dy; // and along y
  bool front_facing; // of an object whose transform mirrors: the opposite
  vec3 object_position; // in the object's space, before any displacement
  mat3 world_from_object; // linear part of the object's transform
  mat3 object_from_world; // its inverse
  vec2 st0; // texture coordinate
  vec2 dst0_dx; // its change per pixel
  vec2 dst0_dy; // its change per pixel
  vec4 tangent0; // vertex tangent, interpolated, not normalised; w its sign
  vec2 st1; // texture coordinate
  vec2 dst1_dx; // its change per pixel
  vec2 dst1_dy; // its change per pixel
};

struct TorusResult {
  vec3 normal; // unit, world space
};

vec2 torus_layer0_map_slope(vec2 st, vec2 dst_dx, vec2 dst_dy) {
  vec2 at = torus_parameters.layer0_tile * st;
  vec2 dx = torus_parameters.layer0_tile * dst_dx;
  vec2 dy = torus_parameters.layer0_tile * dst_dy;
  vec2 slope = surfgrad_derivative_from_normal(2.0 * textureGrad(torus_layer0_map, at, dx, dy).xyz - 1.0);
  return sign(torus_parameters.layer0_tile) * slope;
}

float torus_layer1_mask_value(vec2 st, vec2 dst_dx, vec2 dst_dy) {
  return textureGrad(torus_layer1_mask, st, dst_dx, dst_dy).g;
}

vec2 torus_layer1_map_slope(vec2 st, vec2 dst_dx, vec2 dst_dy) {
  return surfgrad_derivative_from_normal(2.0 * textureGrad(torus_layer1_map, st, dst_dx, dst_dy).xyz - 1.0);
}

vec2 torus_layer3_map_slope(vec2 st, vec2 dst_dx, vec2 dst_dy) {
  vec2 at = surfgrad_rotate(torus_parameters.layer3_tile * st, torus_parameters.layer3_rotation);
  vec2 dx = surfgrad_rotate(torus_parameters.layer3_tile * dst_dx, torus_parameters.layer3_rotation);
  vec2 dy = surfgrad_rotate(torus_parameters.layer3_tile * dst_dy, torus_parameters.layer3_rotation);
  vec2 slope = surfgrad_derivative_from_normal(2.0 * textureGrad(torus_layer1_map, at, dx, dy).xyz - 1.0);
  return sign(torus_parameters.layer3_tile) * surfgrad_rotate_back(slope, torus_parameters.layer3_rotation);
}

SurfgradNoise torus_layer4_noise(vec3 position, float width) {
  vec3 p = torus_parameters.layer4_frequency * position;
  SurfgradNoise noise;
  noise.value = 0.0;
  noise.gradient = vec3(0.0, 0.0, 0.0);
  float frequency = 1.0;
  float amplitude = 1.0;
  float cells = torus_parameters.layer4_frequency * width;
  for (int i = 0; i < 4; ++i) {
    if (surfgrad_octave_visibility(frequency * cells) > 0.0 && frequency < float(SURFGRAD_NOISE_EXTENT)) {
      SurfgradNoise octave = surfgrad_turbulence_octave(surfgrad_perlin(frequency * p));
      noise = surfgrad_add_octave(noise, octave, frequency, amplitude, cells);
    }
    frequency = frequency * torus_parameters.layer4_lacunarity;
    amplitude = amplitude * torus_parameters.layer4_gain;
  }
  noise = surfgrad_power(noise, torus_parameters.layer4_power);
  noise.gradient = torus_parameters.layer4_frequency * noise.gradient;
  return noise;
}

// The normal that the layers make of a surface's.
TorusResult torus_normal(TorusSurface s) {
  SurfgradFrame frame = surfgrad_make_frame(s.normal, s.dp_dx, s.dp_dy, s.front_facing,
      SURFGRAD_BACK_FACES_FLIP);

  // layers[0]: normal_map plates_n.png
  SurfgradTangentFrame basis0 = surfgrad_mikktspace_basis(s.normal, s.tangent0.xyz, s.tangent0.w);
  vec2 slope = (torus_parameters.layer0_opacity * torus_parameters.layer0_scale)
      * torus_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);

  // layers[1]: normal_map weave_n.png, stripes.png
  float mask = torus_layer1_mask_value(s.st0, s.dst0_dx, s.dst0_dy);
  SurfgradTangentFrame derived1 = surfgrad_tangent_basis(frame, s.dst1_dx, s.dst1_dy);
  vec2 slope_2 = torus_layer1_map_slope(s.st1, s.dst1_dx, s.dst1_dy);
  vec3 sum = surfgrad_from_tbn(slope, basis0.tangent, basis0.bitangent);
  vec3 sum_2 = (1.0 - (torus_parameters.layer1_opacity * mask)) * sum
      + ((torus_parameters.layer1_opacity * mask) * torus_parameters.layer1_scale)
      * surfgrad_from_tbn(slope_2, derived1.tangent, derived1.bitangent);

  // layers[2]: resolve
  SurfgradFrame frame_2 = surfgrad_rebase_frame(frame, surfgrad_resolve_normal(frame, sum_2));

  // layers[3]: normal_map weave_n.png
  SurfgradTangentFrame derived1_2 = surfgrad_tangent_basis(frame_2, s.dst1_dx, s.dst1_dy);
  vec2 slope_3 = (torus_parameters.layer3_opacity * torus_parameters.layer3_scale)
      * torus_layer3_map_slope(s.st1, s.dst1_dx, s.dst1_dy);

  // layers[4]: noise
  vec3 object_dp_dx = s.object_from_world * s.dp_dx;
  vec3 object_dp_dy = s.object_from_world * s.dp_dy;
  float width = max(length(object_dp_dx), length(object_dp_dy));
  vec3 gradient = torus_parameters.layer4_scale * torus_layer4_noise(s.object_position, width).gradient;
  vec3 sum_3 = surfgrad_from_tbn(slope_3, derived1_2.tangent, derived1_2.bitangent);
  vec3 sum_4 = sum_3 + torus_parameters.layer4_opacity * torus_from_object_gradient(s.world_from_object,
      s.object_from_world, frame_2.normal, gradient);

  TorusResult result;
  result.normal = surfgrad_resolve_normal(frame_2, sum_4);
  return result;
}

#ifdef SURFGRAD_FRAGMENT
#ifndef SURFGRAD_DDX
#ifdef GL_ES
#define SURFGRAD_DDX dFdx
#define SURFGRAD_DDY dFdy
#else
#define SURFGRAD_DDX dFdxFine
#define SURFGRAD_DDY dFdyFine
#endif
#endif
// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
TorusSurface torus_with_derivatives(TorusSurface s) {
  TorusSurface t = s;
  t.dp_dx = SURFGRAD_DDX(s.position);
  t.dp_dy = SURFGRAD_DDY(s.position);
  t.dst0_dx = SURFGRAD_DDX(s.st0);
  t.dst0_dy = SURFGRAD_DDY(s.st0);
  t.dst1_dx = SURFGRAD_DDX(s.st1);
  t.dst1_dy = SURFGRAD_DDY(s.st1);
  return t;
}
#endif
