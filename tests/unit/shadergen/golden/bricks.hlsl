// The bump layers of bricks.json, written by surfgrad.
//
//   BricksSurface s; // what the layers read: fill it in
//   BricksResult r = bricks_normal(s);
//
// In fragment shaders define SURFGRAD_FRAGMENT before this: bricks_with_derivatives(s) then gives s its
// derivatives.

#include "surfgrad.hlsl"

struct BricksParameters {
  float layer0_scale; // layers[0] normal_map: scale of the bumps
  float layer0_opacity; // layers[0] normal_map: opacity, 0 to 1
  float unused8;
  float unused12;
};
cbuffer BricksBlock : register(b0) { BricksParameters bricks_parameters; };

Texture2D<float4> bricks_layer0_map : register(t0);
SamplerState bricks_sampler0 : register(s0);

// What the stack reads of a surface.
struct BricksSurface {
  float3 normal; // world space, interpolated, not normalised
  bool front_facing; // of an object whose transform mirrors: the opposite
  float2 st0; // texture coordinate
  float2 dst0_dx; // its change per pixel
  float2 dst0_dy; // its change per pixel
  float4 tangent0; // vertex tangent, interpolated, not normalised; w its sign
};

struct BricksResult {
  float3 normal; // unit, world space
};

float2 bricks_layer0_map_slope(float2 st, float2 dst_dx, float2 dst_dy) {
  return surfgrad_derivative_from_normal(2.0 * bricks_layer0_map.SampleGrad(bricks_sampler0, st, dst_dx,
      dst_dy).xyz - 1.0);
}

// The normal that the layers make of a surface's.
BricksResult bricks_normal(BricksSurface s) {
  // layers[0]: normal_map bricks_n.png
  float2 slope = (bricks_parameters.layer0_opacity * bricks_parameters.layer0_scale)
      * bricks_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);

  BricksResult result;
  result.normal = (s.front_facing ? 1.0 : -1.0) * surfgrad_resolve_mikktspace(s.normal, s.tangent0.xyz,
      s.tangent0.w, slope);
  return result;
}

#ifdef SURFGRAD_FRAGMENT
// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
BricksSurface bricks_with_derivatives(BricksSurface s) {
  BricksSurface t = s;
  t.dst0_dx = ddx_fine(s.st0);
  t.dst0_dy = ddy_fine(s.st0);
  return t;
}
#endif
