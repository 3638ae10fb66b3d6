#pragma once

/// What the engine, in double, makes of fragments that an exported shader was run on.

#include "engine/compose.hpp"
#include "exported/sample.hpp"
#include "stack/stack.hpp"

#include <string>
#include <vector>

namespace surfgrad::shadergen::test {

/// The engine's answer to a stack whose maps are filtered as hardware filters them: normals as they are
/// encoded, instead of slopes. Nothing else of the stack is changed.
class Truth {
 public:
  Truth(const std::vector<stack::Layer>& layers, stack::BackFaces back_faces,
        const std::vector<raster::UvSlot>& slots, engine::MapLibrary& maps);

  [[nodiscard]] engine::Composition<double> composed(const Sample& sample) const;

  /// How far the normal turns, in degrees, while what the shader rounds differs by some roundings: positions,
  /// texture coordinates and their changes per pixel.
  [[nodiscard]] double turn_by_rounding(const Sample& sample) const;

 private:
  engine::Program program_;
  BackFaces back_faces_ = BackFaces::same;
};

/// What a shader gave, beside the truth.
struct Comparison {
  int count = 0;
  double mean = 0, worst = 0; ///< angles between normals, in degrees
  int rounded = 0;            ///< angles above the bound that rounding explains
  int wrong = 0;              ///< and those that it does not
  int shadowed = 0;           ///< where the truth has shadow
  int lit_otherwise = 0;      ///< shares of sunlight that differ

  void add(const Comparison& other);
};

/// results  four floats a sample: the normal and the share of sunlight
/// bound    of an angle, in degrees, where roundings of coordinates do not count
[[nodiscard]] Comparison compared(const Truth& truth, const Samples& samples,
                                  const std::vector<float>& results, double bound);

/// The same where maps are minified: means over the samples, in degrees.
struct MinifiedComparison {
  double angle = 0; ///< between both
  double turn = 0;  ///< of the truth while mip levels are a little off, either way
};

/// levels  how far off
[[nodiscard]] MinifiedComparison compared_minified(const Truth& truth, const Samples& samples,
                                                   const std::vector<float>& results, double levels);

} // namespace surfgrad::shadergen::test
