@group(0) @binding(0) var<storage, read> inputs: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<f32>;
@group(0) @binding(2) var<storage, read> work: array<u32>;

var<private> first_input: u32;
var<private> first_result: u32;

fn in1(k: u32) -> f32 { return inputs[first_input + k]; }
fn in2(k: u32) -> vec2f { return vec2f(in1(k), in1(k + 1u)); }
fn in3(k: u32) -> vec3f { return vec3f(in1(k), in1(k + 1u), in1(k + 2u)); }
fn in4(k: u32) -> vec4f { return vec4f(in2(k), in2(k + 2u)); }
fn in_mat3(k: u32) -> mat3x3f { return transpose(mat3x3f(in3(k), in3(k + 3u), in3(k + 6u))); }
fn in_mat4(k: u32) -> mat4x4f { return transpose(mat4x4f(in4(k), in4(k + 4u), in4(k + 8u), in4(k + 12u))); }
fn in_frame(k: u32) -> SurfgradFrame {
  return SurfgradFrame(in3(k), in3(k + 3u), in3(k + 6u), in3(k + 9u), in3(k + 12u), in1(k + 15u), in1(k + 16u));
}

fn v2(a: f32, b: f32) -> vec2f { return vec2f(a, b); }
fn v3(a: f32, b: f32, c: f32) -> vec3f { return vec3f(a, b, c); }
fn whole(a: f32) -> i32 { return i32(clamp(floor(a), -5e8, 5e8)); }
fn convention(handedness: i32, origin: i32, planes: i32) -> SurfgradTriplanarConvention {
  return SurfgradTriplanarConvention(handedness, origin, planes);
}
fn fractal(octaves: i32, lacunarity: f32, gain: f32) -> SurfgradFractal {
  return SurfgradFractal(octaves, lacunarity, gain);
}
fn noise(value: f32, gradient: vec3f) -> SurfgradNoise { return SurfgradNoise(value, gradient); }
fn hex_origin(start: u32, shift: vec2f) -> SurfgradHexOrigin { return SurfgradHexOrigin(start, shift); }
fn moments(mean: vec2f, square: vec2f) -> SurfgradSlopeMoments { return SurfgradSlopeMoments(mean, square, 0.0); }
fn decal_frame(origin: vec3f, rotation: mat3x3f) -> SurfgradDecalFrame {
  let rows = transpose(rotation);
  return SurfgradDecalFrame(origin, rows[0], rows[1], rows[2]);
}
fn decal_direction(direction: vec3f, rotation: mat3x3f) -> SurfgradDecalDirection {
  return SurfgradDecalDirection(direction, direction, transpose(rotation)[0], 1.0, true);
}
fn some_tiles(a: vec2f, b: vec2f, c: vec2f, weight: vec3f, r: vec2f, q: vec2f) -> SurfgradHexTiles {
  return SurfgradHexTiles(array<vec2f, 3>(a, b, c), weight, array<vec2f, 3>(r, q, r));
}
fn hills(p: vec3f) -> f32 { return p.x * p.x + p.y * p.z - 0.5 * p.z * p.z; }
fn hills_beside(p: vec3f, step: f32) -> vec3f {
  return vec3f(hills(p + vec3f(step, 0.0, 0.0)), hills(p + vec3f(0.0, step, 0.0)), hills(p + vec3f(0.0, 0.0, step)));
}

fn put(k: u32, a: f32) { results[first_result + k] = a; }
fn put_at(k: u32, v: vec3f) {
  put(k, v.x);
  put(k + 1u, v.y);
  put(k + 2u, v.z);
}
fn put1(a: f32) { put(0u, a); }
fn put2(v: vec2f) {
  put(0u, v.x);
  put(1u, v.y);
}
fn put3(v: vec3f) { put_at(0u, v); }
fn put_vectors(v: vec3f, w: vec2f) {
  put_at(0u, v);
  put(3u, w.x);
  put(4u, w.y);
}
// Halves of a word: exact in float.
fn put_word(word: u32) { put2(vec2f(f32(word & 0xffffu), f32(word >> 16u))); }
fn put_sin_cos(r: SurfgradSinCos) { put2(vec2f(r.sin, r.cos)); }
fn put_sigma(f: SurfgradFrame) {
  put_at(0u, f.sigma_x);
  put_at(3u, f.sigma_y);
}
fn put_signs(f: SurfgradFrame) {
  put_at(0u, f.normal);
  put(3u, f.flip_sign);
  put(4u, f.resolve_sign);
}
fn put_frame(f: SurfgradFrame) {
  put_at(0u, f.normal);
  put_at(3u, f.sigma_x);
  put_at(6u, f.sigma_y);
  put(9u, f.flip_sign);
  put(10u, f.resolve_sign);
}
fn put_basis(f: SurfgradTangentFrame) {
  put_at(0u, f.tangent);
  put_at(3u, f.bitangent);
}
fn put_columns(columns: mat3x3f, first: i32, last: i32) {
  var m = columns;
  for (var i = first; i < last; i++) { put_at(u32(3 * (i - first)), m[i]); }
}
fn put_coordinates(c: SurfgradTriplanarCoordinates) {
  put2(c.x_plane);
  put(2u, c.y_plane.x);
  put(3u, c.y_plane.y);
  put(4u, c.z_plane.x);
  put(5u, c.z_plane.y);
}
fn put_screen(d: SurfgradScreenDerivatives) {
  put_at(0u, d.dp_dx);
  put_at(3u, d.dp_dy);
}
fn put_texture(d: SurfgradTextureDerivatives) {
  put2(d.dst_dx);
  put(2u, d.dst_dy.x);
  put(3u, d.dst_dy.y);
}
fn put_noise(n: SurfgradNoise) {
  put(0u, n.value);
  put_at(1u, n.gradient);
}
fn put_projection(p: SurfgradDecalProjection) {
  put2(p.texture_coordinate);
  put_at(2u, p.grad_s);
  put_at(5u, p.grad_t);
  put_at(8u, p.axis_s);
  put_at(11u, p.axis_t);
  put(14u, p.falloff);
  put(15u, select(0.0, 1.0, p.inside));
}
fn put_direction(d: SurfgradDecalDirection) {
  put_at(0u, d.direction);
  put_at(3u, d.lookup);
  put_at(6u, d.unchanging);
  put(9u, d.falloff);
  put(10u, select(0.0, 1.0, d.inside));
}
fn put_tiles(tiles: SurfgradHexTiles) {
  var t = tiles;
  for (var k = 0u; k < 3u; k++) {
    put(2u * k, t.st[k].x);
    put(2u * k + 1u, t.st[k].y);
    put(6u + k, t.weight[k]);
    put(9u + 2u * k, t.rotation[k].x);
    put(10u + 2u * k, t.rotation[k].y);
  }
}
fn put_hex_weights_of(t: SurfgradHexTiles, a: vec2f, b: vec2f, c: vec2f, exponent: f32, contrast: f32) {
  put3(surfgrad_hex_weights(t, array<vec2f, 3>(a, b, c), exponent, contrast));
}
fn put_hex_weights(t: SurfgradHexTiles, a: vec2f, b: vec2f, c: vec2f) { put_hex_weights_of(t, a, b, c, 7.0, 1.5); }
fn put_hex_derivative(t: SurfgradHexTiles, weights: vec3f, a: vec2f, b: vec2f, c: vec2f) {
  put2(surfgrad_hex_derivative(t, weights, array<vec2f, 3>(a, b, c)));
}
fn put_moments(m: SurfgradSlopeMoments) {
  put2(m.mean);
  put(2u, m.square.x);
  put(3u, m.square.y);
  put(4u, m.product);
}
fn put_march(st: vec2f, dst: vec2f, steps: i32, slope: vec2f) {
  var march = surfgrad_march_parallax_begin(st, dst, steps);
  while (surfgrad_march_parallax_asks(march)) {
    let height = 0.5 + dot(slope, surfgrad_march_parallax_at(march) - st);
    march = surfgrad_march_parallax_answer(march, height);
  }
  let hit = surfgrad_march_parallax_end(march);
  put2(hit.texture_coordinate);
  put(2u, hit.height);
  put(3u, select(0.0, 1.0, hit.hit));
}
// WGSL has no macros: what those of the other languages stand for.
fn put_march_in_one(st: vec2f, dst: vec2f, steps: i32, slope: vec2f) { put_march(st, dst, steps, slope); }
fn gradient_of_hills(p: vec3f, step: f32) -> vec3f {
  return surfgrad_gradient_by_differences(p, step, hills_beside(p, step), hills_beside(p, -step));
}
fn forward_gradient_of_hills(p: vec3f, step: f32) -> vec3f {
  return surfgrad_gradient_by_forward_differences(p, step, hills_beside(p, step), hills(p));
}
