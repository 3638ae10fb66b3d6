#include "bake_summary.hpp"

#include <fmt/format.h>

namespace surfgrad::cli {
namespace {

/// Rows of pictures are counted from the top.
int row_from_top(const bake::Deviation& deviation, int height) { return height - 1 - deviation.y; }

nlohmann::json summary_of(const bake::Deviation& deviation, const char* pixels, int height) {
  return {{pixels, deviation.compared},     {"left_out", deviation.left_out},
          {"mean_deg", deviation.mean_deg}, {"high_deg", deviation.high_deg},
          {"most_deg", deviation.most_deg}, {"most_at", {deviation.x, row_from_top(deviation, height)}}};
}

std::string words_of(const bake::Deviation& deviation, int height) {
  return fmt::format("{:.4f} degrees in the mean, {:.4f} at 99.9 %, {:.4f} at most (column {}, row {} from "
                     "the top)",
                     deviation.mean_deg, deviation.high_deg, deviation.most_deg, deviation.x,
                     row_from_top(deviation, height));
}

} // namespace

void warn_about(const bake::Counts& baked, const bake::Options& job, Console& console) {
  const char* const what_they_are = job.samples == 1 ? "texels" : "samples";
  const auto warn = [&](std::int64_t count, const char* what) {
    if (count > 0)
      console.warn(fmt::format("{} of {} covered {} {}", count, baked.samples, what_they_are, what));
  };
  if (baked.outside > 0)
    console.warn(
        fmt::format("{} triangles reach beyond the unit square of UV set {}; what lies there is not baked",
                    baked.outside, job.uv_set));
  warn(baked.overlapping, "lie under more than one triangle; the first triangle is baked");
  warn(baked.singular, job.samples == 1
                           ? "have a tangent frame that cannot be inverted; they are flat in the map"
                           : "have a tangent frame that cannot be inverted; they are left out");
  warn(baked.clamped, "point below the surface; their steepest slope is baked");
  warn(baked.degenerate,
       "had no interpolated normal or no tangent frame; the triangle's normal stands in, layers without "
       "a frame add nothing");
  if (baked.beyond_range > 0)
    console.warn(
        fmt::format("{} of {} covered texels are steeper than the range of {:g}: they are flattened to "
                    "it; --range {:.4g} would hold all",
                    baked.beyond_range, baked.covered, job.range, 1.0001 * baked.steepest));
}

nlohmann::json summary_of(const bake::Counts& baked, const bake::Options& job) {
  nlohmann::json summary{{"width", job.width},
                         {"height", job.height},
                         {"uv", job.uv_set},
                         {"covered_texels", baked.covered},
                         {"padded_texels", baked.padded},
                         {"triangles_outside", baked.outside}};
  if (job.samples == 1) {
    summary.update({{"touched_texels", baked.touched},
                    {"overlapping_texels", baked.overlapping},
                    {"singular_texels", baked.singular},
                    {"clamped_texels", baked.clamped},
                    {"degenerate_texels", baked.degenerate}});
  } else {
    summary.update({{"covered_samples", baked.samples},
                    {"touched_samples", baked.touched},
                    {"overlapping_samples", baked.overlapping},
                    {"singular_samples", baked.singular},
                    {"clamped_samples", baked.clamped},
                    {"degenerate_samples", baked.degenerate}});
  }
  if (job.encoding == bake::Encoding::derivative)
    summary.update({{"range", job.range},
                    {"steepest_slope", baked.steepest},
                    {"texels_beyond_range", baked.beyond_range}});
  return summary;
}

void say_verified(const bake::Verification& verified, const bake::Options& job, Console& console) {
  const bake::Deviation& texels = verified.texels;
  console.say(fmt::format("decoded, {} texels are off by {}", texels.compared, words_of(texels, job.height)));
  if (texels.left_out > 0)
    console.say(fmt::format("{} texels that no tangent-space map can hold are left out", texels.left_out));
  const bake::Deviation& screen = verified.on_screen;
  console.say(fmt::format("filtered, {} pixels of a picture of {}x{} are off by {}", screen.compared,
                          bake::screen_side, bake::screen_side, words_of(screen, bake::screen_side)));
  if (screen.left_out > 0)
    console.say(fmt::format("{} pixels that show nothing of the map are left out", screen.left_out));
}

nlohmann::json summary_of(const bake::Verification& verified, const bake::Options& job) {
  return {{"verified", summary_of(verified.texels, "texels", job.height)},
          {"verified_on_screen", summary_of(verified.on_screen, "pixels", bake::screen_side)}};
}

} // namespace surfgrad::cli
