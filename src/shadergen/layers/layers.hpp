#pragma once

#include "shadergen/generator.hpp"

namespace surfgrad::shadergen {

// One for each kind, named as its kernel in engine/layers: writes the layer's code.
void write(const stack::NormalMapLayer& layer, Generator& generator);
void write(const stack::DerivativeMapLayer& layer, Generator& generator);
void write(const stack::HeightMapLayer& layer, Generator& generator);
void write(const stack::ObjectNormalMapLayer& layer, Generator& generator);
void write(const stack::NoiseLayer& layer, Generator& generator);
void write(const stack::PlanarLayer& layer, Generator& generator);
void write(const stack::TriplanarLayer& layer, Generator& generator);
void write(const stack::DecalLayer& layer, Generator& generator);
void write(const stack::ParallaxLayer& layer, Generator& generator);
void write(const stack::ResolveLayer& layer, Generator& generator);

} // namespace surfgrad::shadergen
