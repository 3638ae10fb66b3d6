// Compiled once for each instruction set.

#include "image/slope_row.hpp"

#include <surfgrad/derivative.hpp>

#include <cmath>
#include <cstdint>

namespace surfgrad::image::SURFGRAD_ISA_NAMESPACE {
namespace {

/// Texels that are converted together: component by component in arrays that the compiler vectorises over
/// (see CMakeLists.txt).
constexpr int together = 64;

struct Normals {
  double x[together];
  double y[together];
  double z[together];
};

template <int channels>
void decode(const float* texels, Normals& m) {
  for (int i = 0; i < together; ++i) {
    const float* t = texels + i * channels;
    m.x[i] = 2.0 * t[0] - 1;
    m.y[i] = 2.0 * t[1] - 1;
    m.z[i] = channels > 2 ? 2.0 * t[2] - 1 : 1.0;
  }
}

void flatten_what_is_not_finite(Normals& m) {
  for (int i = 0; i < together; ++i) {
    const bool finite = std::isfinite(m.x[i]) && std::isfinite(m.y[i]) && std::isfinite(m.z[i]);
    if (!finite) m.x[i] = m.y[i] = m.z[i] = 0;
  }
}

/// Of the first `count` of texels that start at `texels`; as many as `together` can be read there.
int convert(const SlopeRow& row, const float* texels, int count, float* slopes) {
  Normals m;
  if (row.channels == 2)
    decode<2>(texels, m);
  else if (row.channels == 3)
    decode<3>(texels, m);
  else
    decode<4>(texels, m);
  if (row.may_be_infinite) flatten_what_is_not_finite(m);
  double slope_s[together];
  double slope_t[together];
  const double sign = row.code.green_up ? 1 : -1;
  if (row.code.two_channels)
    for (int i = 0; i < together; ++i) {
      const vec2<double> d = derivative_from_normal(vec2<double>{m.x[i], m.y[i]});
      slope_s[i] = d.x;
      slope_t[i] = sign * d.y;
    }
  else
    for (int i = 0; i < together; ++i) {
      const vec2<double> d = derivative_from_normal(vec3<double>{m.x[i], m.y[i], m.z[i]});
      slope_s[i] = d.x;
      slope_t[i] = sign * d.y;
    }
  for (int i = 0; i < count; ++i) {
    slopes[2 * i] = static_cast<float>(slope_s[i]);
    slopes[2 * i + 1] = static_cast<float>(slope_t[i]);
  }
  if (row.code.two_channels) return 0;
  std::int64_t inward = 0; // as wide as the components, or the loop stays scalar
  for (int i = 0; i < count; ++i) inward += m.z[i] > 0 ? 0 : 1;
  return static_cast<int>(inward);
}

} // namespace

int slope_row(const SlopeRow& row) {
  int inward = 0;
  int x = 0;
  for (; x + together <= row.width; x += together)
    inward += convert(row, row.texels + x * row.channels, together, row.slopes + 2 * x);
  if (x == row.width) return inward;
  float rest[4 * together] = {};
  for (int i = x * row.channels; i < row.width * row.channels; ++i)
    rest[i - x * row.channels] = row.texels[i];
  return inward + convert(row, rest, row.width - x, row.slopes + 2 * x);
}

} // namespace surfgrad::image::SURFGRAD_ISA_NAMESPACE
