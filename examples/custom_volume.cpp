// A bump map that is a C++ function of space: the rings of a tree, carved into the built-in torus. Once
// with its own gradient, once as values alone; both pictures show the same normals.
//
//   custom_volume [PICTURE.png]

#include "io/image_file.hpp"
#include "render/render.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace surfgrad;

// Grooves every 0.1 units around an axis, in units of the object.
double rings(vec3<double> p) { return 0.005 * std::sin(60 * std::hypot(p.x + 0.4, p.y)); }

Noise<double> rings_with_gradient(vec3<double> p) {
  const double r = std::hypot(p.x + 0.4, p.y);
  const double slope = r > 0 ? 0.3 * std::cos(60 * r) / r : 0; // d rings / dr, over r
  return {rings(p), {slope * (p.x + 0.4), slope * p.y, 0}};
}

render::Picture picture_of(const stack::VolumeFunction& function, render::Aov aov) {
  stack::NoiseLayer layer;
  layer.custom = function;
  scene::Scene scene = scene::demo_scene();
  scene.materials[0].layers = {layer};
  render::Options options;
  options.width = options.height = 160;
  options.aov = aov;
  return render::render(scene, options);
}

int main(int argc, char** argv) {
  const stack::VolumeFunction own(rings_with_gradient);
  const stack::VolumeFunction values(rings, 1e-5); // step of the differences, in units of the object

  const image::Image a = picture_of(own, render::Aov::normal).image;
  const image::Image b = picture_of(values, render::Aov::normal).image;
  float difference = 0;
  for (std::size_t i = 0; i < a.texels.size(); ++i)
    difference = std::max(difference, std::abs(a.texels[i] - b.texels[i]));
  std::printf("largest difference of a normal: %g\n", difference);

  if (argc > 1) io::write_image(argv[1], picture_of(own, render::Aov::beauty).image, image::Depth::unorm8);
  // step^2 / 6 * 60^3 * 0.005 = 2e-8, and rounding to float.
  return difference < 1e-6f ? 0 : 1;
}
