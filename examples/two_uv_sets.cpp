// A base normal map on the unwrapped UV set and a detail map on a second, tiled one: the case that
// one tangent space per vertex cannot express. A shader does the same per pixel.

#include <surfgrad/surfgrad.hpp>

#include <cmath>
#include <cstdio>

using namespace surfgrad;

int main() {
  // What a rasteriser knows about one pixel.
  const vec3<float> normal{0.1f, 0.2f, 0.95f}; // interpolated, not unit
  const vec3<float> dp_dx{0.01f, 0, -0.001f};  // change of position per pixel
  const vec3<float> dp_dy{0, 0.01f, -0.002f};
  const vec3<float> tangent{0.98f, 0, -0.1f}; // interpolated MikkTSpace tangent of UV set 0
  const float sign = 1;
  const vec2<float> dst1_dx{0.08f, 0.02f}, dst1_dy{-0.03f, 0.07f}; // UV set 1: turned and tiled
  // What it fetched.
  const vec3<float> base_texel{0.2f, -0.1f, 0.97f};
  const vec3<float> detail_texel{-0.3f, 0.1f, 0.95f};
  const float detail_mask = 0.5f;

  const Frame<float> frame = make_frame(normal, dp_dx, dp_dy);

  const TangentFrame<float> vertex = mikktspace_basis(normal, tangent, sign);
  const vec3<float> base =
      from_tbn(derivative_from_normal(base_texel), vertex.tangent, vertex.bitangent);

  const TangentFrame<float> derived = tangent_basis(frame, dst1_dx, dst1_dy);
  const vec3<float> detail =
      from_tbn(derivative_from_normal(detail_texel), derived.tangent, derived.bitangent);

  // Gradients scale, mask and add; one resolve makes the normal.
  const vec3<float> n = resolve_normal(frame, base + scale_bump(detail_mask, detail));

  std::printf("normal %.4f %.4f %.4f\n", n.x, n.y, n.z);
  return std::abs(length(n) - 1) < 1e-6f ? 0 : 1;
}
