#include "maps/mend.hpp"

#include "diagnostic/error.hpp"
#include "maps/convert.hpp"

#include <fmt/format.h>

namespace surfgrad::maps {
namespace {

// Beyond what rounding to 8 bits does: lengths by up to 0.004 a component, mean slopes by less than a code's
// step.
constexpr double most_length_deviation = 0.008;
constexpr double most_tilt = 0.008;

} // namespace

Mended mend(const image::Image& map, const Inspection& found, image::Depth depth,
            const std::filesystem::path& file) {
  if (found.look != Look::tangent_normals)
    throw InputError({.file = file,
                      .problem = "does not look like a map of tangent-space normals",
                      .remedy = "convert it with --from if it is known what it is"});
  Mended mended;
  Conversion conversion{.depth = depth, .dither = depth == image::Depth::unorm8 && map.depth != depth};
  if (found.green.confidence == Confidence::certain && found.green.green == stack::Green::down) {
    conversion.from.green = stack::Green::down;
    mended.done.emplace_back("turned green up");
  }
  const bool repeats = found.along_s.repeats && found.along_s.confidence == Confidence::certain &&
                       found.along_t.repeats && found.along_t.confidence == Confidence::certain;
  if (repeats && max_abs(found.tilt) > most_tilt) {
    conversion.retile = true;
    mended.done.push_back(
        fmt::format("took out the mean slope ({:.4f}, {:.4f})", found.tilt.x, found.tilt.y));
  }
  const bool has_wrong_lengths = found.length_deviation > most_length_deviation;
  if (has_wrong_lengths) mended.done.emplace_back("made vectors as long as 1");
  if (found.inward > 0) mended.done.push_back(fmt::format("turned {} inward vectors outward", found.inward));
  if (conversion.retile || has_wrong_lengths || found.inward > 0) {
    // Through slopes, which have no length.
    conversion.width = map.width;
    conversion.height = map.height;
  }
  mended.map = convert(map, conversion, file).map;
  return mended;
}

} // namespace surfgrad::maps
