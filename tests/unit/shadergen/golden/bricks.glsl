// The bump layers of bricks.json, written by surfgrad.
//
//   BricksSurface s; // what the layers read: fill it in
//   BricksResult r = bricks_normal(s);
//
// In fragment shaders define SURFGRAD_FRAGMENT before this: bricks_with_derivatives(s) then gives s its
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

layout(std140 SURFGRAD_BINDING(0)) uniform BricksParameters {
  float layer0_scale; // layers[0] normal_map: scale of the bumps
  float layer0_opacity; // layers[0] normal_map: opacity, 0 to 1
  float unused8;
  float unused12;
} bricks_parameters;

SURFGRAD_TEXTURE(1) sampler2D bricks_layer0_map;

// What the stack reads of a surface.
struct BricksSurface {
  vec3 normal; // world space, interpolated, not normalised
  bool front_facing; // of an object whose transform mirrors: the opposite
  vec2 st0; // texture coordinate
  vec2 dst0_dx; // its change per pixel
  vec2 dst0_dy; // its change per pixel
  vec4 tangent0; // vertex tangent, interpolated, not normalised; w its sign
};

struct BricksResult {
  vec3 normal; // unit, world space
};

vec2 bricks_layer0_map_slope(vec2 st, vec2 dst_dx, vec2 dst_dy) {
  return surfgrad_derivative_from_normal(2.0 * textureGrad(bricks_layer0_map, st, dst_dx, dst_dy).xyz - 1.0);
}

// The normal that the layers make of a surface's.
BricksResult bricks_normal(BricksSurface s) {
  // layers[0]: normal_map bricks_n.png
  vec2 slope = (bricks_parameters.layer0_opacity * bricks_parameters.layer0_scale)
      * bricks_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);

  BricksResult result;
  result.normal = (s.front_facing ? 1.0 : -1.0) * surfgrad_resolve_mikktspace(s.normal, s.tangent0.xyz,
      s.tangent0.w, slope);
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
BricksSurface bricks_with_derivatives(BricksSurface s) {
  BricksSurface t = s;
  t.dst0_dx = SURFGRAD_DDX(s.st0);
  t.dst0_dy = SURFGRAD_DDY(s.st0);
  return t;
}
#endif
