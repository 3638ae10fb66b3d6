// The bump layers of torus.json, written by surfgrad.
//
//   TorusSurface s; // what the layers read: fill it in
//   TorusResult r = torus_normal(s);
//
// In fragment shaders define SURFGRAD_FRAGMENT before this: torus_with_derivatives(s) then gives s its
// derivatives.

#include "surfgrad.hlsl"

struct TorusParameters {
  float layer0_scale; // layers[0] normal_map: scale of the bumps
  float layer0_opacity; // layers[0] normal_map: opacity, 0 to 1
  float2 layer0_tile; // layers[0] normal_map: repetitions of the map
  float layer1_scale; // layers[1] normal_map: scale of the bumps
  float layer1_opacity; // layers[1] normal_map: opacity, 0 to 1
  float layer3_scale; // layers[3] normal_map: scale of the bumps
  float layer3_opacity; // layers[3] normal_map: opacity, 0 to 1
  float2 layer3_tile; // layers[3] normal_map: repetitions of the map
  float2 layer3_rotation; // layers[3] normal_map: cosine and sine of the turn of the map
  float layer4_scale; // layers[4] noise: height of the function
  float layer4_opacity; // layers[4] noise: opacity, 0 to 1
  float layer4_frequency; // layers[4] noise: cells per unit of the space
  float layer4_lacunarity; // layers[4] noise: frequency of an octave by that of the one before
  float layer4_gain; // layers[4] noise: amplitude of an octave by that of the one before
  float layer4_power; // layers[4] noise: the function is raised to it
  float unused72;
  float unused76;
};
cbuffer TorusBlock : register(b0) { TorusParameters torus_parameters; };

Texture2D<float4> torus_layer0_map : register(t0);
Texture2D<float4> torus_layer1_mask : register(t1);
Texture2D<float4> torus_layer1_map : register(t2);
SamplerState torus_sampler0 : register(s0);

float2 torus_texture_size(Texture2D<float4> map) {
  uint width, height;
  map.GetDimensions(width, height);
  return float2(width, height);
}

// A volume gradient of object space in world space, in units of a height along the base normal.
float3 torus_object_gradient_in_world(float3x3 world_from_object, float3x3 object_from_world, float3 normal,
    float3 gradient) {
  float stretch = length(mul(transpose(world_from_object), normal));
  return stretch * (mul(transpose(object_from_world), gradient));
}

// What a volume gradient of object space adds to the sum: N - G becomes M^-T (N - G) as a whole (Golubev,
// equation 33).
float3 torus_from_object_gradient(float3x3 world_from_object, float3x3 object_from_world, float3 normal,
    float3 gradient) {
  float3 object_normal = surfgrad_normalize_or_zero(mul(transpose(world_from_object), normal));
  float3 g = torus_object_gradient_in_world(world_from_object, object_from_world, normal, gradient);
  return g - dot(object_normal, gradient) * normal;
}

float torus_square(float x) { return x * x; }

// How much of a filtered normal's shortening is minification's: none where the map is magnified and texels are
// blended, all from level 1 on.
float torus_minified(float2 dst_dx, float2 dst_dy, float2 size) {
  return min(max(surfgrad_texture_lod(dst_dx, dst_dy, size), 0.0), 1.0);
}

// Variance along an axis of the slopes that an average of unit normals hides (Toksvig 2005, "Mipmapping normal
// maps"). Where slopes s, t have variance v along each axis around a flat mean, the average is as long as its
// part along the axis, E[1 / sqrt(1 + s^2 + t^2)] = 1 - E[s^2 + t^2] / 2 + ... = 1 - v + O(v^2), whose v is
// (1 - |m|) / |m| to the same order. Of Gaussian slopes it gives v - 2 v^2 + O(v^3): never too rough.
float torus_hidden_variance(float3 m) {
  float size = length(m);
  return max(1.0 - size, 0.0) / max(size, 0.001);
}

// Roughness of slopes that scatter around those of the microfacets. Beckmann's slopes have variance alpha^2 / 2
// along each axis; those of independent slopes add up: alpha'^2 = alpha^2 + 2 v (Olano and Baker 2010, "LEAN
// Mapping"; GGX has no variance and is widened alike).
float torus_widened(float roughness, float variance) {
  SurfgradSlopeMoments hidden;
  hidden.mean = float2(0.0, 0.0);
  hidden.square = float2(variance, variance);
  hidden.product = 0.0;
  return sqrt(surfgrad_roughness_from_moments(roughness * roughness, hidden));
}

// What the stack reads of a surface.
struct TorusSurface {
  float3 position; // world space, where the surface lies
  float3 normal; // world space, interpolated, not normalised
  float3 dp_dx; // change of position per pixel along x
  float3 dp_dy; // and along y
  bool front_facing; // of an object whose transform mirrors: the opposite
  float3 object_position; // in the object's space, before any displacement
  float3x3 world_from_object; // linear part of the object's transform
  float3x3 object_from_world; // its inverse
  float roughness; // between the bumps, perceptual: the root of GGX's or Beckmann's alpha
  float2 st0; // texture coordinate
  float2 dst0_dx; // its change per pixel
  float2 dst0_dy; // its change per pixel
  float4 tangent0; // vertex tangent, interpolated, not normalised; w its sign
  float2 st1; // texture coordinate
  float2 dst1_dx; // its change per pixel
  float2 dst1_dy; // its change per pixel
};

struct TorusResult {
  float3 normal; // unit, world space
  float roughness; // with the slopes that minification hides
};

float3 torus_layer0_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  float2 at = torus_parameters.layer0_tile * st;
  float2 dx = torus_parameters.layer0_tile * dst_dx;
  float2 dy = torus_parameters.layer0_tile * dst_dy;
  float3 normal = 2.0 * torus_layer0_map.SampleGrad(torus_sampler0, at, dx, dy).xyz - 1.0;
  float2 slope = surfgrad_derivative_from_normal(normal);
  float variance = torus_minified(dx, dy, torus_texture_size(torus_layer0_map))
      * torus_hidden_variance(normal);
  float2 along = sign(torus_parameters.layer0_tile) * slope;
  return float3(along.x, along.y, variance);
}

float torus_layer1_mask_value(float2 st, float2 dst_dx, float2 dst_dy) {
  return torus_layer1_mask.SampleGrad(torus_sampler0, st, dst_dx, dst_dy).g;
}

float3 torus_layer1_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  float3 normal = 2.0 * torus_layer1_map.SampleGrad(torus_sampler0, st, dst_dx, dst_dy).xyz - 1.0;
  float2 slope = surfgrad_derivative_from_normal(normal);
  float variance = torus_minified(dst_dx, dst_dy, torus_texture_size(torus_layer1_map))
      * torus_hidden_variance(normal);
  return float3(slope.x, slope.y, variance);
}

float3 torus_layer3_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  float2 at = surfgrad_rotate(torus_parameters.layer3_tile * st, torus_parameters.layer3_rotation);
  float2 dx = surfgrad_rotate(torus_parameters.layer3_tile * dst_dx, torus_parameters.layer3_rotation);
  float2 dy = surfgrad_rotate(torus_parameters.layer3_tile * dst_dy, torus_parameters.layer3_rotation);
  float3 normal = 2.0 * torus_layer1_map.SampleGrad(torus_sampler0, at, dx, dy).xyz - 1.0;
  float2 slope = surfgrad_derivative_from_normal(normal);
  float variance = torus_minified(dx, dy, torus_texture_size(torus_layer1_map))
      * torus_hidden_variance(normal);
  float2 along = sign(torus_parameters.layer3_tile) * surfgrad_rotate_back(slope,
      torus_parameters.layer3_rotation);
  return float3(along.x, along.y, variance);
}

SurfgradNoise torus_layer4_noise(float3 position, float width) {
  float3 p = torus_parameters.layer4_frequency * position;
  SurfgradNoise noise;
  noise.value = 0.0;
  noise.gradient = float3(0.0, 0.0, 0.0);
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
  float3 bump = torus_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);
  float variance = torus_square(torus_parameters.layer0_opacity * torus_parameters.layer0_scale) * bump.z;
  float2 slope = (torus_parameters.layer0_opacity * torus_parameters.layer0_scale) * bump.xy;

  // layers[1]: normal_map weave_n.png, stripes.png
  float mask = torus_layer1_mask_value(s.st0, s.dst0_dx, s.dst0_dy);
  SurfgradTangentFrame derived1 = surfgrad_tangent_basis(frame, s.dst1_dx, s.dst1_dy);
  float3 bump_2 = torus_layer1_map_slope(s.st1, s.dst1_dx, s.dst1_dy);
  float3 sum = surfgrad_from_tbn(slope, basis0.tangent, basis0.bitangent);
  float variance_2 = torus_square(1.0 - (torus_parameters.layer1_opacity * mask)) * variance
      + torus_square((torus_parameters.layer1_opacity * mask) * torus_parameters.layer1_scale) * bump_2.z;
  float3 sum_2 = (1.0 - (torus_parameters.layer1_opacity * mask)) * sum
      + ((torus_parameters.layer1_opacity * mask) * torus_parameters.layer1_scale)
      * surfgrad_from_tbn(bump_2.xy, derived1.tangent, derived1.bitangent);

  // layers[2]: resolve
  SurfgradFrame frame_2 = surfgrad_rebase_frame(frame, surfgrad_resolve_normal(frame, sum_2));

  // layers[3]: normal_map weave_n.png
  SurfgradTangentFrame derived1_2 = surfgrad_tangent_basis(frame_2, s.dst1_dx, s.dst1_dy);
  float3 bump_3 = torus_layer3_map_slope(s.st1, s.dst1_dx, s.dst1_dy);
  float variance_3 = torus_square(torus_parameters.layer3_opacity * torus_parameters.layer3_scale) * bump_3.z;
  float2 slope_2 = (torus_parameters.layer3_opacity * torus_parameters.layer3_scale) * bump_3.xy;

  // layers[4]: noise
  float3 object_dp_dx = mul(s.object_from_world, s.dp_dx);
  float3 object_dp_dy = mul(s.object_from_world, s.dp_dy);
  float width = max(length(object_dp_dx), length(object_dp_dy));
  float3 gradient = torus_parameters.layer4_scale * torus_layer4_noise(s.object_position, width).gradient;
  float3 sum_3 = surfgrad_from_tbn(slope_2, derived1_2.tangent, derived1_2.bitangent);
  float3 sum_4 = sum_3 + torus_parameters.layer4_opacity
      * torus_from_object_gradient(s.world_from_object, s.object_from_world, frame_2.normal, gradient);

  TorusResult result;
  result.normal = surfgrad_resolve_normal(frame_2, sum_4);
  result.roughness = torus_widened(s.roughness, variance_2 + variance_3);
  return result;
}

#ifdef SURFGRAD_FRAGMENT
// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
TorusSurface torus_with_derivatives(TorusSurface s) {
  TorusSurface t = s;
  t.dp_dx = ddx_fine(s.position);
  t.dp_dy = ddy_fine(s.position);
  t.dst0_dx = ddx_fine(s.st0);
  t.dst0_dy = ddy_fine(s.st0);
  t.dst1_dx = ddx_fine(s.st1);
  t.dst1_dy = ddy_fine(s.st1);
  return t;
}
#endif
