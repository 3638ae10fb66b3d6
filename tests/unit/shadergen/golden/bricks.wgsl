// The bump layers of bricks.json, written by surfgrad.
//
//   BricksSurface s; // what the layers read: fill it in
//   BricksResult r = bricks_normal(s);

// Needs surfgrad.wgsl: join it to this file.

struct BricksParameters {
  layer0_scale: f32, // layers[0] normal_map: scale of the bumps
  layer0_opacity: f32, // layers[0] normal_map: opacity, 0 to 1
  unused8: f32,
  unused12: f32,
}
@group(0) @binding(0) var<uniform> bricks_parameters: BricksParameters;

@group(0) @binding(1) var bricks_layer0_map: texture_2d<f32>;
@group(0) @binding(2) var bricks_sampler0: sampler;

// What the stack reads of a surface.
struct BricksSurface {
  normal: vec3f, // world space, interpolated, not normalised
  front_facing: bool, // of an object whose transform mirrors: the opposite
  st0: vec2f, // texture coordinate
  dst0_dx: vec2f, // its change per pixel
  dst0_dy: vec2f, // its change per pixel
  tangent0: vec4f, // vertex tangent, interpolated, not normalised; w its sign
}

struct BricksResult {
  normal: vec3f, // unit, world space
}

fn bricks_layer0_map_slope(st: vec2f, dst_dx: vec2f, dst_dy: vec2f) -> vec2f {
  return surfgrad_derivative_from_normal(2.0 * textureSampleGrad(bricks_layer0_map, bricks_sampler0, st,
      dst_dx, dst_dy).xyz - 1.0);
}

// The normal that the layers make of a surface's.
fn bricks_normal(s: BricksSurface) -> BricksResult {
  // layers[0]: normal_map bricks_n.png
  let slope: vec2f = (bricks_parameters.layer0_opacity * bricks_parameters.layer0_scale)
      * bricks_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);

  var result: BricksResult;
  result.normal = select(-1.0, 1.0, s.front_facing) * surfgrad_resolve_mikktspace(s.normal, s.tangent0.xyz,
      s.tangent0.w, slope);
  return result;
}

// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
fn bricks_with_derivatives(s: BricksSurface) -> BricksSurface {
  var t: BricksSurface = s;
  t.dst0_dx = dpdxFine(s.st0);
  t.dst0_dy = dpdyFine(s.st0);
  return t;
}
