#pragma once

#include "exported/sample.hpp"

namespace surfgrad::shadergen::test {

/// How fine pixels must be for the maps of a stack not to be minified: mip levels are the hardware's own.
class Fineness {
 public:
  Fineness(const std::vector<stack::Layer>& layers, const scene::Scene& scene);

  /// Makes the fragment one of the same picture drawn with finer pixels, by a power of two: all that is said
  /// of it per pixel shrinks, its place in the raster and in space stays.
  void apply(Sample& sample) const;

 private:
  double texels_by_st_ = 0;       ///< most texels of any map on a texture coordinate's unit
  double texels_by_position_ = 0; ///< and of any projected one on a unit of its space
};

} // namespace surfgrad::shadergen::test
