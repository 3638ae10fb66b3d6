// The bump layers of torus.json, written by surfgrad.
//
//   TorusSurface s; // what the layers read: fill it in
//   TorusResult r = torus_normal(s);

// Needs surfgrad.wgsl: join it to this file.

struct TorusParameters {
  layer0_scale: f32, // layers[0] normal_map: scale of the bumps
  layer0_opacity: f32, // layers[0] normal_map: opacity, 0 to 1
  layer0_tile: vec2f, // layers[0] normal_map: repetitions of the map
  layer1_scale: f32, // layers[1] normal_map: scale of the bumps
  layer1_opacity: f32, // layers[1] normal_map: opacity, 0 to 1
  layer3_scale: f32, // layers[3] normal_map: scale of the bumps
  layer3_opacity: f32, // layers[3] normal_map: opacity, 0 to 1
  layer3_tile: vec2f, // layers[3] normal_map: repetitions of the map
  layer3_rotation: vec2f, // layers[3] normal_map: cosine and sine of the turn of the map
  layer4_scale: f32, // layers[4] noise: height of the function
  layer4_opacity: f32, // layers[4] noise: opacity, 0 to 1
  layer4_frequency: f32, // layers[4] noise: cells per unit of the space
  layer4_lacunarity: f32, // layers[4] noise: frequency of an octave by that of the one before
  layer4_gain: f32, // layers[4] noise: amplitude of an octave by that of the one before
  layer4_power: f32, // layers[4] noise: the function is raised to it
  unused72: f32,
  unused76: f32,
}
@group(0) @binding(0) var<uniform> torus_parameters: TorusParameters;

@group(0) @binding(1) var torus_layer0_map: texture_2d<f32>;
@group(0) @binding(2) var torus_layer1_mask: texture_2d<f32>;
@group(0) @binding(3) var torus_layer1_map: texture_2d<f32>;
@group(0) @binding(4) var torus_sampler0: sampler;

// A volume gradient of object space in world space, in units of a height along the base normal.
fn torus_object_gradient_in_world(world_from_object: mat3x3f, object_from_world: mat3x3f, normal: vec3f,
    gradient: vec3f) -> vec3f {
  let stretch: f32 = length(transpose(world_from_object) * normal);
  return stretch * (transpose(object_from_world) * gradient);
}

// What a volume gradient of object space adds to the sum: N - G becomes M^-T (N - G) as a whole (Golubev,
// equation 33).
fn torus_from_object_gradient(world_from_object: mat3x3f, object_from_world: mat3x3f, normal: vec3f,
    gradient: vec3f) -> vec3f {
  let object_normal: vec3f = surfgrad_normalize_or_zero(transpose(world_from_object) * normal);
  let g: vec3f = torus_object_gradient_in_world(world_from_object, object_from_world, normal, gradient);
  return g - dot(object_normal, gradient) * normal;
}

// What the stack reads of a surface.
struct TorusSurface {
  position: vec3f, // world space, where the surface lies
  normal: vec3f, // world space, interpolated, not normalised
  dp_dx: vec3f, // change of position per pixel along x
  dp_dy: vec3f, // and along y
  front_facing: bool, // of an object whose transform mirrors: the opposite
  object_position: vec3f, // in the object's space, before any displacement
  world_from_object: mat3x3f, // linear part of the object's transform
  object_from_world: mat3x3f, // its inverse
  st0: vec2f, // texture coordinate
  dst0_dx: vec2f, // its change per pixel
  dst0_dy: vec2f, // its change per pixel
  tangent0: vec4f, // vertex tangent, interpolated, not normalised; w its sign
  st1: vec2f, // texture coordinate
  dst1_dx: vec2f, // its change per pixel
  dst1_dy: vec2f, // its change per pixel
}

struct TorusResult {
  normal: vec3f, // unit, world space
}

fn torus_layer0_map_slope(st: vec2f, dst_dx: vec2f, dst_dy: vec2f) -> vec2f {
  let at: vec2f = torus_parameters.layer0_tile * st;
  let dx: vec2f = torus_parameters.layer0_tile * dst_dx;
  let dy: vec2f = torus_parameters.layer0_tile * dst_dy;
  let slope: vec2f = surfgrad_derivative_from_normal(2.0
      * textureSampleGrad(torus_layer0_map, torus_sampler0, at, dx, dy).xyz - 1.0);
  return sign(torus_parameters.layer0_tile) * slope;
}

fn torus_layer1_mask_value(st: vec2f, dst_dx: vec2f, dst_dy: vec2f) -> f32 {
  return textureSampleGrad(torus_layer1_mask, torus_sampler0, st, dst_dx, dst_dy).g;
}

fn torus_layer1_map_slope(st: vec2f, dst_dx: vec2f, dst_dy: vec2f) -> vec2f {
  return surfgrad_derivative_from_normal(2.0 * textureSampleGrad(torus_layer1_map, torus_sampler0, st,
      dst_dx, dst_dy).xyz - 1.0);
}

fn torus_layer3_map_slope(st: vec2f, dst_dx: vec2f, dst_dy: vec2f) -> vec2f {
  let at: vec2f = surfgrad_rotate(torus_parameters.layer3_tile * st, torus_parameters.layer3_rotation);
  let dx: vec2f = surfgrad_rotate(torus_parameters.layer3_tile * dst_dx, torus_parameters.layer3_rotation);
  let dy: vec2f = surfgrad_rotate(torus_parameters.layer3_tile * dst_dy, torus_parameters.layer3_rotation);
  let slope: vec2f = surfgrad_derivative_from_normal(2.0
      * textureSampleGrad(torus_layer1_map, torus_sampler0, at, dx, dy).xyz - 1.0);
  return sign(torus_parameters.layer3_tile) * surfgrad_rotate_back(slope, torus_parameters.layer3_rotation);
}

fn torus_layer4_noise(position: vec3f, width: f32) -> SurfgradNoise {
  let p: vec3f = torus_parameters.layer4_frequency * position;
  var noise: SurfgradNoise;
  noise.value = 0.0;
  noise.gradient = vec3f(0.0, 0.0, 0.0);
  var frequency: f32 = 1.0;
  var amplitude: f32 = 1.0;
  let cells: f32 = torus_parameters.layer4_frequency * width;
  for (var i: i32 = 0; i < 4; i++) {
    if (surfgrad_octave_visibility(frequency * cells) > 0.0 && frequency < f32(SURFGRAD_NOISE_EXTENT)) {
      let octave: SurfgradNoise = surfgrad_turbulence_octave(surfgrad_perlin(frequency * p));
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
fn torus_normal(s: TorusSurface) -> TorusResult {
  let frame: SurfgradFrame = surfgrad_make_frame_two_sided(s.normal, s.dp_dx, s.dp_dy, s.front_facing,
      SURFGRAD_BACK_FACES_FLIP);

  // layers[0]: normal_map plates_n.png
  let basis0: SurfgradTangentFrame = surfgrad_mikktspace_basis(s.normal, s.tangent0.xyz, s.tangent0.w);
  let slope: vec2f = (torus_parameters.layer0_opacity * torus_parameters.layer0_scale)
      * torus_layer0_map_slope(s.st0, s.dst0_dx, s.dst0_dy);

  // layers[1]: normal_map weave_n.png, stripes.png
  let mask: f32 = torus_layer1_mask_value(s.st0, s.dst0_dx, s.dst0_dy);
  let derived1: SurfgradTangentFrame = surfgrad_tangent_basis(frame, s.dst1_dx, s.dst1_dy);
  let slope_2: vec2f = torus_layer1_map_slope(s.st1, s.dst1_dx, s.dst1_dy);
  let sum: vec3f = surfgrad_from_tbn(slope, basis0.tangent, basis0.bitangent);
  let sum_2: vec3f = (1.0 - (torus_parameters.layer1_opacity * mask)) * sum
      + ((torus_parameters.layer1_opacity * mask) * torus_parameters.layer1_scale)
      * surfgrad_from_tbn(slope_2, derived1.tangent, derived1.bitangent);

  // layers[2]: resolve
  let frame_2: SurfgradFrame = surfgrad_rebase_frame(frame, surfgrad_resolve_normal(frame, sum_2));

  // layers[3]: normal_map weave_n.png
  let derived1_2: SurfgradTangentFrame = surfgrad_tangent_basis(frame_2, s.dst1_dx, s.dst1_dy);
  let slope_3: vec2f = (torus_parameters.layer3_opacity * torus_parameters.layer3_scale)
      * torus_layer3_map_slope(s.st1, s.dst1_dx, s.dst1_dy);

  // layers[4]: noise
  let object_dp_dx: vec3f = (s.object_from_world * s.dp_dx);
  let object_dp_dy: vec3f = (s.object_from_world * s.dp_dy);
  let width: f32 = max(length(object_dp_dx), length(object_dp_dy));
  let gradient: vec3f = torus_parameters.layer4_scale * torus_layer4_noise(s.object_position, width).gradient;
  let sum_3: vec3f = surfgrad_from_tbn(slope_3, derived1_2.tangent, derived1_2.bitangent);
  let sum_4: vec3f = sum_3 + torus_parameters.layer4_opacity
      * torus_from_object_gradient(s.world_from_object, s.object_from_world, frame_2.normal, gradient);

  var result: TorusResult;
  result.normal = surfgrad_resolve_normal(frame_2, sum_4);
  return result;
}

// A fragment's surface, its derivatives filled in. Call it in uniform control flow.
fn torus_with_derivatives(s: TorusSurface) -> TorusSurface {
  var t: TorusSurface = s;
  t.dp_dx = dpdxFine(s.position);
  t.dp_dy = dpdyFine(s.position);
  t.dst0_dx = dpdxFine(s.st0);
  t.dst0_dy = dpdyFine(s.st0);
  t.dst1_dx = dpdxFine(s.st1);
  t.dst1_dy = dpdyFine(s.st1);
  return t;
}
