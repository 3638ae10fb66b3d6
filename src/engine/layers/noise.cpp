#include "engine/layers/noise.hpp"

#include "engine/compiler.hpp"

namespace surfgrad::engine {

VolumeNoise compiled(const stack::NoiseLayer& layer, const Compiler& compiler) {
  VolumeNoise noise{compiler.influence(layer.common),
                    layer.noise,
                    layer.custom,
                    layer.common.scale,
                    layer.space == stack::Space::world,
                    layer.method == stack::NoiseMethod::perlin1985};
  noise.influence.scale = 1; // the kernel scales the gradient itself
  return noise;
}

} // namespace surfgrad::engine
