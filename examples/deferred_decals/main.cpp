// Deferred decals: boxes write volume gradients into a buffer when only depth is known, the G-buffer pass
// brings normals later, and one projection a pixel lights them all. Writes deferred_decals.ppm.

#include <surfgrad/surfgrad.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace surfgrad;
using float3 = vec3<float>;

int main() {
  constexpr int size = 256, decal_count = 100;
  std::vector<DecalFrame<float>> decals;
  for (float i = 0.5f; i < decal_count; ++i) { // over half a sphere, evenly
    const float z = 1 - i / decal_count, angle = 240 * (1 - z), r = std::sqrt(1 - z * z);
    const float3 n{r * std::cos(angle), r * std::sin(angle), z};
    const float3 s = normalize_or_zero(cross(float3{0, 1, 0}, n));
    decals.push_back({n, s, cross(n, s), n});
  }
  const auto gradient_of = [](const DecalFrame<float>& frame, float3 p) {
    const auto box = box_decal(frame, p, float3{0.15f, 0.15f, 0.3f}, 0.5f);
    const vec2<float> st = box.texture_coordinate;
    const vec2<float> slope{std::sin(6.28f * st.x), std::sin(6.28f * st.y)}; // in place of a texture
    return box.falloff * decal_gradient(slope, box.axis_s, box.axis_t);
  };

  // Decal pass: positions from depth, no normals yet.
  std::vector<float3> buffer(size * size, float3{0, 0, 0});
  const auto across = [](int i) { return 2.2f * (static_cast<float>(i) + 0.5f) / size - 1.1f; };
  const auto position = [&](int k) {
    const float x = across(k % size), y = -across(k / size);
    return float3{x, y, std::sqrt(std::max(0.0f, 1 - x * x - y * y))};
  };
  for (const auto& decal : decals)
    for (int k = 0; k < size * size; ++k) buffer[k] = buffer[k] + gradient_of(decal, position(k));

  // G-buffer pass: the normal arrives, any normal; one projection for all decals.
  float worst = 0;
  std::FILE* file = std::fopen("deferred_decals.ppm", "wb");
  if (!file) return 2;
  std::fprintf(file, "P6 %d %d 255\n", size, size);
  for (int k = 0; k < size * size; ++k) {
    const float3 p = position(k), normal = normalize_or_zero(p + 0.1f * float3{p.y, p.z, p.x});
    const float3 once = from_volume_gradient(normal, buffer[k]);
    float3 one_by_one{0, 0, 0};
    for (const auto& d : decals) one_by_one = one_by_one + from_volume_gradient(normal, gradient_of(d, p));
    worst = std::max(worst, max_abs(once - one_by_one));
    const float light = dot(resolve_normal(make_frame(normal), once), float3{0.4f, 0.5f, 0.7f});
    for (int c = 0; c < 3; ++c)
      std::fputc(p.z > 0 ? static_cast<int>(std::clamp(light, 0.0f, 1.0f) * 255) : 0, file);
  }
  std::fclose(file);
  std::printf("largest difference to projecting each decal: %g\n", worst);
  return worst > 0 && worst < 1e-5f ? 0 : 1; // gradients of up to 2, some of them added: rounding
}
