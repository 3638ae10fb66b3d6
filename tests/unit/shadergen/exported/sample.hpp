#pragma once

/// Fragments as an engine of somebody else hands them to an exported shader.

#include "engine/placement.hpp"
#include "raster/surface.hpp"
#include "scene/scene.hpp"
#include "shadergen/shadergen.hpp"
#include "support/random.hpp"

#include <vector>

namespace surfgrad::shadergen::test {

/// A fragment and what is the same all over its object; numbers that a float holds, but for the engine's
/// own sums of them.
struct Sample {
  raster::Fragment<double> fragment{};
  engine::Placement placement{};
};

/// What a material's shader reads at its fragments.
struct Samples {
  std::vector<Sample> all{};
  std::vector<raster::UvSlot> slots{}; ///< whose coordinates Fragment::uvs has
};

/// Fragments as some surface may have them, with UV sets 0 and 1: nothing is collapsed, and no map of up to
/// 100 texels a side is minified.
[[nodiscard]] Samples random_samples(surfgrad::test::Random& random, int count);

/// The fragments of a scene's first material, as its camera sees them, at the middles of this many columns
/// and rows of a picture.
///
/// picture  how many pixels the picture is wide and high; 0: so many that no map is minified, here and there
/// more
[[nodiscard]] Samples samples_of(const scene::Scene& scene, int side, int picture);

/// The fragment as one of the same picture drawn with pixels so many times as fine: all that is said of it
/// per pixel shrinks, its place in the raster and in space stays.
[[nodiscard]] Sample with_finer_pixels(const Sample& sample, double times);

/// A member of the surface at a fragment; matrices column by column.
[[nodiscard]] std::vector<double> values_of(const SurfaceMember& member, const Sample& sample,
                                            const std::vector<raster::UvSlot>& slots);

/// All that a shader reads of the samples, one after the other (program.hpp).
[[nodiscard]] std::vector<float> inputs_of(const Shader& shader, const Samples& samples);

} // namespace surfgrad::shadergen::test
