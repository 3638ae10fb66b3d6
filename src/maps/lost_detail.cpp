#include "maps/lost_detail.hpp"

#include "image/parallel.hpp"

#include <surfgrad/derivative.hpp>

#include <cmath>
#include <cstddef>

namespace surfgrad::maps {
namespace {

/// A picture made of another one of the same size: make(x, y, where the texel's channels go).
template <class Make>
image::Image made_of(const image::Image& picture, int channels, const Make& make) {
  image::Image result = image::make_image(picture.width, picture.height, channels, image::Depth::float32);
  image::in_parallel(static_cast<std::size_t>(picture.height), static_cast<std::size_t>(picture.width),
                     [&, to = result.texels.floats().data()](std::size_t row) {
                       const int y = static_cast<int>(row);
                       for (int x = 0; x < picture.width; ++x) make(x, y, to + result.index(x, y));
                     });
  return result;
}

} // namespace

image::Image unit_normals(const image::Image& slopes) {
  return made_of(slopes, 3, [&](int x, int y, float* texel) {
    const vec3<double> n = normal_from_derivative(vec2<double>{slopes.at(x, y, 0), slopes.at(x, y, 1)});
    texel[0] = static_cast<float>(n.x);
    texel[1] = static_cast<float>(n.y);
    texel[2] = static_cast<float>(n.z);
  });
}

image::Image roughness_of_means(const image::Image& means, const bake::BaseRoughness& base) {
  return made_of(means, 1, [&](int x, int y, float* texel) {
    const vec3<double> mean{means.at(x, y, 0), means.at(x, y, 1), means.at(x, y, 2)};
    *texel =
        static_cast<float>(std::sqrt(bake::widened_alpha(base.alpha(x, y, means.width, means.height), mean)));
  });
}

} // namespace surfgrad::maps
