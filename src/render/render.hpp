#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"

#include <cstdint>

namespace surfgrad::render {

/// What a picture shows.
enum class Aov {
  beauty,      ///< shaded and ready for display
  normal,      ///< composed normal, world space
  base_normal, ///< normal before any layer
  surfgrad,    ///< surface gradient from base normal to normal
  uv,          ///< texture coordinate set 0
};

struct Options {
  int width = 1024;
  int height = 1024;
  int samples = 3; ///< samples along each side of a pixel, for beauty
  Aov aov = Aov::beauty;
};

struct Picture {
  /// rgb. beauty: display values. Others: raw values, zero where nothing is seen, one sample a pixel.
  image::Image image;
  std::int64_t covered = 0;    ///< samples that show a surface
  std::int64_t degenerate = 0; ///< of these, samples where a normal or a tangent frame did not exist
};

/// Samples a picture may take: visibility holds a triangle and a depth, 16 bytes, for each of them
/// at once, so this many are 4 GiB. They are one sample a pixel of a 16384x16384 picture.
inline constexpr std::int64_t most_samples = std::int64_t{1} << 28;

/// Throws InputError, which says what would do, where a picture takes more than most_samples.
/// render does so too: this is for before the scene is loaded.
void check_options(const Options& options);

/// Renders a scene with the reference engine, displaced first if it asks for that. Throws as check_options
/// does. Warns (through report) about normal maps with texels that point into the surface. Same bytes for any
/// number of threads.
[[nodiscard]] Picture render(const scene::Scene& scene, const Options& options, const Report& report = {});

/// Raw values of an auxiliary picture brought into [0, 1] for integer files: vectors as v / 2 + 1/2,
/// uv as its fraction.
[[nodiscard]] image::Image encoded_for_display(const Picture& picture, Aov aov);

} // namespace surfgrad::render
