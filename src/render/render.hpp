#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "scene/scene.hpp"
#include "stage/backend.hpp"
#include "stage/bands.hpp"

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
  const stage::Backend* backend = nullptr; ///< composes in the engine's stead
};

/// What a picture's samples met.
struct Counts {
  std::int64_t covered = 0;    ///< samples that show a surface
  std::int64_t degenerate = 0; ///< of these, samples where a normal or a tangent frame did not exist
};

struct Picture : Counts {
  /// rgb. beauty: display values. Others: raw values, zero where nothing is seen, one sample a pixel.
  image::Image image;
};

/// Renders a scene, displaced first if it asks for that. Warns (through report) about normal maps with texels
/// that point into the surface. Same bytes for any number of threads.
[[nodiscard]] Picture render(const scene::Scene& scene, const Options& options, const Report& report = {});

/// The same band by band, as they are done: memory does not grow with the picture.
Counts render_bands(scene::Scene scene, const Options& options, const stage::BandSink& take,
                    const Report& report = {});

/// Raw values of an auxiliary picture brought into [0, 1] for integer files: vectors as v / 2 + 1/2,
/// uv as its fraction.
[[nodiscard]] image::Image encoded_for_display(const image::Image& picture, Aov aov);

} // namespace surfgrad::render
