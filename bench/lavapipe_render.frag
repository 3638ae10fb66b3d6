#version 450
// Three maps of slopes on three derived bases (Mikkelsen 2019, listings 6 and 16), then the sun part of
// the program's own shading: see src/render/shading.cpp for its numbers.
layout(location = 0) in vec3 position; // relative to the eye
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 st0;
layout(location = 3) in vec2 st1;
layout(location = 4) in vec2 st2;

layout(location = 0) out vec4 color;

layout(set = 0, binding = 0) uniform sampler2D map0;
layout(set = 0, binding = 1) uniform sampler2D map1;
layout(set = 0, binding = 2) uniform sampler2D map2;
layout(set = 0, binding = 3) uniform Light {
  vec4 sun;          // direction towards it, strength
  vec4 mirrored[65]; // share that the glaze mirrors, against the cosine of the view; and the step to the next
};

const float pi = 3.14159265;
const float alpha = 0.36 * 0.36;
const float f0 = 0.05;
const vec3 body = vec3(0.37, 0.32, 0.28);

vec3 n, sigma_x, sigma_y;
float flip_sign;

vec3 surface_gradient(sampler2D map, vec2 st) {
  vec2 dst_dx = dFdx(st);
  vec2 dst_dy = dFdy(st);
  float det = dot(dst_dx, vec2(dst_dy.y, -dst_dy.x));
  float sign_det = det < 0 ? -1.0 : 1.0;
  vec2 inverse_column = sign_det * vec2(dst_dy.y, -dst_dx.y);
  vec3 tangent = sigma_x * inverse_column.x + sigma_y * inverse_column.y;
  if (abs(det) > 0) tangent = normalize(tangent);
  vec3 bitangent = (sign_det * flip_sign) * cross(n, tangent);
  vec2 slope = texture(map, st).xy;
  return slope.x * tangent + slope.y * bitangent;
}

float lambda(float c) { return sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); }

float display_value(float x) {
  const float shoulder = 0.7;
  x = max(x, 0);
  float y = x <= shoulder ? x : 1 - (1 - shoulder) * (1 - shoulder) / (x + 1 - 2 * shoulder);
  return y <= 0.0031308 ? 12.92 * y : 1.055 * pow(y, 1 / 2.4) - 0.055;
}

void main() {
  n = normalize(normal);
  vec3 dp_dx = dFdx(position);
  vec3 dp_dy = dFdy(position);
  sigma_x = dp_dx - dot(dp_dx, n) * n;
  sigma_y = dp_dy - dot(dp_dy, n) * n;
  flip_sign = dot(dp_dy, cross(n, dp_dx)) < 0 ? -1.0 : 1.0;
  vec3 bumped = normalize(n - (surface_gradient(map0, st0) + surface_gradient(map1, st1) +
                               surface_gradient(map2, st2)));

  vec3 to_viewer = normalize(-position);
  float cos_view = clamp(dot(bumped, to_viewer), 0, 1);
  float x = cos_view * 64;
  int i = min(int(x), 63);
  float share = mirrored[i].x + (x - i) * mirrored[i].y;
  float cos_light = dot(bumped, sun.xyz);
  vec3 light = vec3(0);
  if (cos_light > 0) {
    vec3 half_vector = normalize(sun.xyz + to_viewer);
    float m = 1 - clamp(dot(half_vector, to_viewer), 0, 1);
    float fresnel = f0 + (1 - f0) * m * m * m * m * m;
    float cos_half = dot(bumped, half_vector);
    float d = cos_half * cos_half * (alpha * alpha - 1) + 1;
    float v = max(cos_view, 1e-4);
    float visibility = 0.5 / max(cos_light * lambda(v) + v * lambda(cos_light), 1e-9);
    float glaze = fresnel * alpha * alpha / (pi * d * d) * visibility;
    light = sun.w * cos_light * ((1 - share) / pi * body + glaze);
  }
  color = vec4(display_value(light.x), display_value(light.y), display_value(light.z), 1);
}
