#pragma once

#include "image/image.hpp"
#include "scene/map_functions.hpp"

#include <surfgrad/vec.hpp>

namespace surfgrad::gallery {

// The older ways to use two tangent-space normal maps at once: each makes one unit normal of two,
// texel by texel, so both maps must lie on the same texture coordinate at the same resolution.
// They are here to be compared with; layers add surface gradients instead.

/// The mean direction. A flat map halves the slopes of the other.
[[nodiscard]] inline vec3<double> blend_linear(vec3<double> base, vec3<double> detail) {
  return normalize_or_zero(base + detail);
}

/// The slopes' numerators are added over the base's z alone: a flat base flattens the detail's steep
/// parts.
[[nodiscard]] inline vec3<double> blend_udn(vec3<double> base, vec3<double> detail) {
  return normalize_or_zero(vec3<double>{base.x + detail.x, base.y + detail.y, base.z});
}

/// Over the product of both z: a flat map changes nothing, two steep ones become steeper than their
/// sum.
[[nodiscard]] inline vec3<double> blend_whiteout(vec3<double> base, vec3<double> detail) {
  return normalize_or_zero(vec3<double>{base.x + detail.x, base.y + detail.y, base.z * detail.z});
}

/// Reoriented normal mapping: the detail turned by the shortest rotation that takes +z to the base.
/// A flat map changes nothing; the order of the maps matters.
[[nodiscard]] inline vec3<double> blend_reoriented(vec3<double> base, vec3<double> detail) {
  const vec3<double> t{base.x, base.y, base.z + 1};
  const vec3<double> u{-detail.x, -detail.y, detail.z};
  return normalize_or_zero((dot(t, u) / t.z) * t - u);
}

/// One normal map of two of the same size, texel by texel, as 16-bit codes.
template <class Blend>
[[nodiscard]] image::Image blended_map(const image::Image& base, const image::Image& detail,
                                       const Blend& blend) {
  image::Image map = image::make_image(base.width, base.height, 3, image::Depth::unorm16);
  for (int y = 0; y < base.height; ++y)
    for (int x = 0; x < base.width; ++x) {
      const auto normal = [&](const image::Image& image) {
        const auto value = [&](int channel) { return 2.0 * image.at(x, y, channel) - 1; };
        return normalize_or_zero(vec3<double>{value(0), value(1), value(2)});
      };
      scene::set_normal(map, x, y, blend(normal(base), normal(detail)));
    }
  return map;
}

} // namespace surfgrad::gallery
