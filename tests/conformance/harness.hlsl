[[vk::binding(0)]] StructuredBuffer<float> inputs;
[[vk::binding(1)]] RWStructuredBuffer<float> results;
[[vk::binding(2)]] StructuredBuffer<uint> work;

static uint first_input;
static uint first_result;

float in1(uint k) { return inputs[first_input + k]; }
float2 in2(uint k) { return float2(in1(k), in1(k + 1u)); }
float3 in3(uint k) { return float3(in1(k), in1(k + 1u), in1(k + 2u)); }
float4 in4(uint k) { return float4(in2(k), in2(k + 2u)); }
float3x3 in_mat3(uint k) { return float3x3(in3(k), in3(k + 3u), in3(k + 6u)); }
float4x4 in_mat4(uint k) { return float4x4(in4(k), in4(k + 4u), in4(k + 8u), in4(k + 12u)); }
SurfgradFrame in_frame(uint k) {
  SurfgradFrame made = {in3(k), in3(k + 3u), in3(k + 6u), in3(k + 9u), in3(k + 12u), in1(k + 15u), in1(k + 16u)};
  return made;
}

float2 v2(float a, float b) { return float2(a, b); }
float3 v3(float a, float b, float c) { return float3(a, b, c); }
int whole(float a) { return int(clamp(floor(a), -5e8, 5e8)); }
SurfgradTriplanarConvention convention(int handedness, int origin, int planes) {
  SurfgradTriplanarConvention made = {handedness, origin, planes};
  return made;
}
SurfgradFractal fractal(int octaves, float lacunarity, float gain) {
  SurfgradFractal made = {octaves, lacunarity, gain};
  return made;
}
SurfgradNoise noise(float value, float3 gradient) {
  SurfgradNoise made = {value, gradient};
  return made;
}
SurfgradHexOrigin hex_origin(uint start, float2 shift) {
  SurfgradHexOrigin made = {start, shift};
  return made;
}
SurfgradSlopeMoments moments(float2 mean, float2 square) {
  SurfgradSlopeMoments made = {mean, square, 0.0};
  return made;
}
SurfgradDecalFrame decal_frame(float3 origin, float3x3 rotation) {
  SurfgradDecalFrame made = {origin, rotation[0], rotation[1], rotation[2]};
  return made;
}
SurfgradDecalDirection decal_direction(float3 direction, float3x3 rotation) {
  SurfgradDecalDirection made = {direction, direction, rotation[0], 1.0, true};
  return made;
}
SurfgradHexTiles some_tiles(float2 a, float2 b, float2 c, float3 weight, float2 r, float2 q) {
  SurfgradHexTiles made = {{a, b, c}, weight, {r, q, r}};
  return made;
}
float hills(float3 p) { return p.x * p.x + p.y * p.z - 0.5 * p.z * p.z; }
float3 hills_beside(float3 p, float step) {
  return float3(hills(p + float3(step, 0.0, 0.0)), hills(p + float3(0.0, step, 0.0)), hills(p + float3(0.0, 0.0, step)));
}

void put(uint k, float a) { results[first_result + k] = a; }
void put_at(uint k, float3 v) {
  put(k, v.x);
  put(k + 1u, v.y);
  put(k + 2u, v.z);
}
void put1(float a) { put(0u, a); }
void put2(float2 v) {
  put(0u, v.x);
  put(1u, v.y);
}
void put3(float3 v) { put_at(0u, v); }
void put_vectors(float3 v, float2 w) {
  put_at(0u, v);
  put(3u, w.x);
  put(4u, w.y);
}
// Halves of a word: exact in float.
void put_word(uint word) { put2(float2(float(word & 0xffffu), float(word >> 16u))); }
void put_sin_cos(SurfgradSinCos r) { put2(float2(r.sin, r.cos)); }
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
void put_columns(float3x3 m, int from, int to) {
  for (int i = from; i < to; ++i) put_at(uint(3 * (i - from)), transpose(m)[i]);
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
void put_hex_weights(SurfgradHexTiles t, float2 a, float2 b, float2 c) {
  float2 deriv[3] = {a, b, c};
  put3(surfgrad_hex_weights(t, deriv));
}
void put_hex_weights_of(SurfgradHexTiles t, float2 a, float2 b, float2 c, float exponent, float contrast) {
  float2 deriv[3] = {a, b, c};
  put3(surfgrad_hex_weights(t, deriv, exponent, contrast));
}
void put_hex_derivative(SurfgradHexTiles t, float3 weights, float2 a, float2 b, float2 c) {
  float2 deriv[3] = {a, b, c};
  put2(surfgrad_hex_derivative(t, weights, deriv));
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
void put_march(float2 st, float2 dst, int steps, float2 slope) {
  SurfgradParallaxMarch march = surfgrad_march_parallax_begin(st, dst, steps);
  while (surfgrad_march_parallax_asks(march)) {
    float height = 0.5 + dot(slope, surfgrad_march_parallax_at(march) - st);
    march = surfgrad_march_parallax_answer(march, height);
  }
  put_hit(surfgrad_march_parallax_end(march));
}
#define HEIGHT_OF_PLANE(at) (0.5 + dot(slope, (at) - st))
void put_march_in_one(float2 st, float2 dst, int steps, float2 slope) {
  SurfgradParallaxHit hit;
  SURFGRAD_MARCH_PARALLAX(hit, HEIGHT_OF_PLANE, st, dst, steps)
  put_hit(hit);
}
float3 gradient_of_hills(float3 p, float step) { return SURFGRAD_GRADIENT_BY_DIFFERENCES(hills, p, step); }
float3 forward_gradient_of_hills(float3 p, float step) {
  return SURFGRAD_GRADIENT_BY_FORWARD_DIFFERENCES(hills, p, hills(p), step);
}
