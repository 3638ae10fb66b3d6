#pragma once

#include "exported/sample.hpp"

namespace surfgrad::shadergen::test {

/// How many times as fine pixels must be for the maps of a stack not to be minified.
class Fineness {
 public:
  Fineness(const std::vector<stack::Layer>& layers, const scene::Scene& scene);

  /// A power of two.
  [[nodiscard]] double times(const Sample& sample) const;

 private:
  double texels_by_st_ = 0;       ///< most texels of any map on a texture coordinate's unit
  double texels_by_position_ = 0; ///< and of any projected one on a unit of its space
};

} // namespace surfgrad::shadergen::test
