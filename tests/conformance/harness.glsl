layout(std430, binding = 0) readonly buffer Inputs { float inputs[]; };
layout(std430, binding = 1) writeonly buffer Results { float results[]; };
layout(std430, binding = 2) readonly buffer Work { uint work[]; };

uint first_input;
uint first_result;

float in1(uint k) { return inputs[first_input + k]; }
vec2 in2(uint k) { return vec2(in1(k), in1(k + 1u)); }
vec3 in3(uint k) { return vec3(in1(k), in1(k + 1u), in1(k + 2u)); }
vec4 in4(uint k) { return vec4(in2(k), in2(k + 2u)); }
mat3 in_mat3(uint k) { return transpose(mat3(in3(k), in3(k + 3u), in3(k + 6u))); }
mat4 in_mat4(uint k) { return transpose(mat4(in4(k), in4(k + 4u), in4(k + 8u), in4(k + 12u))); }
SurfgradFrame in_frame(uint k) {
  return SurfgradFrame(in3(k), in3(k + 3u), in3(k + 6u), in3(k + 9u), in3(k + 12u), in1(k + 15u), in1(k + 16u));
}

vec2 v2(float a, float b) { return vec2(a, b); }
vec3 v3(float a, float b, float c) { return vec3(a, b, c); }
int whole(float a) { return int(clamp(floor(a), -5e8, 5e8)); }
SurfgradTriplanarConvention convention(int handedness, int origin, int planes) {
  return SurfgradTriplanarConvention(handedness, origin, planes);
}
SurfgradFractal fractal(int octaves, float lacunarity, float gain) {
  return SurfgradFractal(octaves, lacunarity, gain);
}
SurfgradNoise noise(float value, vec3 gradient) { return SurfgradNoise(value, gradient); }
SurfgradHexOrigin hex_origin(uint start, vec2 shift) { return SurfgradHexOrigin(start, shift); }
SurfgradSlopeMoments moments(vec2 mean, vec2 square) { return SurfgradSlopeMoments(mean, square, 0.0); }
SurfgradDecalFrame decal_frame(vec3 origin, mat3 rotation) {
  mat3 rows = transpose(rotation);
  return SurfgradDecalFrame(origin, rows[0], rows[1], rows[2]);
}
SurfgradDecalDirection decal_direction(vec3 direction, mat3 rotation) {
  return SurfgradDecalDirection(direction, direction, transpose(rotation)[0], 1.0, true);
}
SurfgradHexTiles some_tiles(vec2 a, vec2 b, vec2 c, vec3 weight, vec2 r, vec2 q) {
  return SurfgradHexTiles(vec2[3](a, b, c), weight, vec2[3](r, q, r));
}
float hills(vec3 p) { return p.x * p.x + p.y * p.z - 0.5 * p.z * p.z; }
vec3 hills_beside(vec3 p, float step) {
  return vec3(hills(p + vec3(step, 0.0, 0.0)), hills(p + vec3(0.0, step, 0.0)), hills(p + vec3(0.0, 0.0, step)));
}

void put(uint k, float a) { results[first_result + k] = a; }
void put_at(uint k, vec3 v) {
  put(k, v.x);
  put(k + 1u, v.y);
  put(k + 2u, v.z);
}
void put1(float a) { put(0u, a); }
void put2(vec2 v) {
  put(0u, v.x);
  put(1u, v.y);
}
void put3(vec3 v) { put_at(0u, v); }
void put_vectors(vec3 v, vec2 w) {
  put_at(0u, v);
  put(3u, w.x);
  put(4u, w.y);
}
// Halves of a word: exact in float.
void put_word(uint word) { put2(vec2(float(word & 0xffffu), float(word >> 16u))); }
void put_sin_cos(SurfgradSinCos r) { put2(vec2(r.sin, r.cos)); }
void put_sigma(SurfgradFrame f) {
  put_at(0u, f.sigma_x);
  put_at(3u, f.sigma_y);
}
void put_signs(SurfgradFrame f) {
  put_at(0u, f.normal);
  put(3u, f.flip_sign);
  put(4u, f.resolve_sign);
}
void put_frame(SurfgradFrame f) {
  put_at(0u, f.normal);
  put_at(3u, f.sigma_x);
  put_at(6u, f.sigma_y);
  put(9u, f.flip_sign);
  put(10u, f.resolve_sign);
}
void put_basis(SurfgradTangentFrame f) {
  put_at(0u, f.tangent);
  put_at(3u, f.bitangent);
}
void put_columns(mat3 m, int from, int to) {
  for (int i = from; i < to; ++i) put_at(uint(3 * (i - from)), m[i]);
}
void put_coordinates(SurfgradTriplanarCoordinates c) {
  put2(c.x_plane);
  put(2u, c.y_plane.x);
  put(3u, c.y_plane.y);
  put(4u, c.z_plane.x);
  put(5u, c.z_plane.y);
}
void put_screen(SurfgradScreenDerivatives d) {
  put_at(0u, d.dp_dx);
  put_at(3u, d.dp_dy);
}
void put_texture(SurfgradTextureDerivatives d) {
  put2(d.dst_dx);
  put(2u, d.dst_dy.x);
  put(3u, d.dst_dy.y);
}
void put_noise(SurfgradNoise n) {
  put(0u, n.value);
  put_at(1u, n.gradient);
}
void put_projection(SurfgradDecalProjection p) {
  put2(p.texture_coordinate);
  put_at(2u, p.grad_s);
  put_at(5u, p.grad_t);
  put_at(8u, p.axis_s);
  put_at(11u, p.axis_t);
  put(14u, p.falloff);
  put(15u, p.inside ? 1.0 : 0.0);
}
void put_direction(SurfgradDecalDirection d) {
  put_at(0u, d.direction);
  put_at(3u, d.lookup);
  put_at(6u, d.unchanging);
  put(9u, d.falloff);
  put(10u, d.inside ? 1.0 : 0.0);
}
void put_tiles(SurfgradHexTiles t) {
  for (int i = 0; i < 3; ++i) {
    uint k = uint(i);
    put(2u * k, t.st[i].x);
    put(2u * k + 1u, t.st[i].y);
    put(6u + k, t.weight[i]);
    put(9u + 2u * k, t.rotation[i].x);
    put(10u + 2u * k, t.rotation[i].y);
  }
}
void put_hex_weights(SurfgradHexTiles t, vec2 a, vec2 b, vec2 c) {
  put3(surfgrad_hex_weights(t, vec2[3](a, b, c)));
}
void put_hex_weights_of(SurfgradHexTiles t, vec2 a, vec2 b, vec2 c, float exponent, float contrast) {
  put3(surfgrad_hex_weights(t, vec2[3](a, b, c), exponent, contrast));
}
void put_hex_derivative(SurfgradHexTiles t, vec3 weights, vec2 a, vec2 b, vec2 c) {
  put2(surfgrad_hex_derivative(t, weights, vec2[3](a, b, c)));
}
void put_moments(SurfgradSlopeMoments m) {
  put2(m.mean);
  put(2u, m.square.x);
  put(3u, m.square.y);
  put(4u, m.product);
}
void put_hit(SurfgradParallaxHit hit) {
  put2(hit.texture_coordinate);
  put(2u, hit.height);
  put(3u, hit.hit ? 1.0 : 0.0);
}
void put_march(vec2 st, vec2 dst, int steps, vec2 slope) {
  SurfgradParallaxMarch march = surfgrad_march_parallax_begin(st, dst, steps);
  while (surfgrad_march_parallax_asks(march)) {
    float height = 0.5 + dot(slope, surfgrad_march_parallax_at(march) - st);
    march = surfgrad_march_parallax_answer(march, height);
  }
  put_hit(surfgrad_march_parallax_end(march));
}
#define HEIGHT_OF_PLANE(at) (0.5 + dot(slope, (at) - st))
void put_march_in_one(vec2 st, vec2 dst, int steps, vec2 slope) {
  SurfgradParallaxHit hit;
  SURFGRAD_MARCH_PARALLAX(hit, HEIGHT_OF_PLANE, st, dst, steps)
  put_hit(hit);
}
vec3 gradient_of_hills(vec3 p, float step) { return SURFGRAD_GRADIENT_BY_DIFFERENCES(hills, p, step); }
vec3 forward_gradient_of_hills(vec3 p, float step) {
  return SURFGRAD_GRADIENT_BY_FORWARD_DIFFERENCES(hills, p, hills(p), step);
}
