#include "bake_job.hpp"

#include "io/extension.hpp"

#include <surfgrad/derivative.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

namespace surfgrad::cli {
namespace {

// Triangles are sorted into tiles of some tens of samples: as many tiles as fit into some tens of megabytes.
constexpr int most_samples_a_side = 65536;

constexpr int most_padding = 256; // a window of that many rows is kept

void set_padding(const std::string& text, bake::Options& job) {
  job.fill = text == "fill";
  if (job.fill) return;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), job.padding);
  if (error != std::errc() || end != text.data() + text.size() || job.padding < 0 ||
      job.padding > most_padding)
    throw CLI::ValidationError(
        "--padding", fmt::format("\"{}\" is not a whole number from 0 to {}, or fill", text, most_padding));
}

} // namespace

void BakeJob::add_options(CLI::App& verb) {
  verb.add_option("--uv", job_.uv_set, "UV set that the map is laid out in")
      ->capture_default_str()
      ->check(CLI::Range(0, 7))
      ->type_name("SET");
  const std::map<std::string, bake::Space> spaces{
      {"tangent", bake::Space::tangent}, {"object", bake::Space::object}, {"world", bake::Space::world}};
  verb.add_option("--space", job_.space, "tangent (default), object or world")
      ->transform(one_of(spaces))
      ->type_name("NAME")
      ->option_text("NAME");
  add_encoding_options(verb);
  verb.add_option(
          "--samples", job_.samples,
          "samples along each side of a texel; their slopes are averaged, and a texel is covered where\n"
          "one of them is")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  verb.add_option("--padding", padding_,
                  "texels around the islands that repeat their border, so that filters and mip levels\n"
                  "do not show what lies between; 0 for none, fill for all (the map is held in memory)")
      ->capture_default_str()
      ->type_name("N|fill");
}

/// How a texel stands for a normal.
void BakeJob::add_encoding_options(CLI::App& verb) {
  const std::map<std::string, bake::Encoding> encodings{
      {"rgb", bake::Encoding::rgb}, {"rg", bake::Encoding::rg}, {"derivative", bake::Encoding::derivative}};
  verb.add_option(
          "--encoding", job_.encoding,
          "rgb (default); rg: two channels, z is reconstructed (BC5); derivative: slopes, as the layer\n"
          "derivative_map reads them")
      ->transform(one_of(encodings))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_option("--range", range_, "slope of the largest code of --encoding derivative (default: 1)")
      ->type_name("SLOPE");
  const std::map<std::string, stack::NeutralCode> neutrals{{"between", stack::NeutralCode::between},
                                                           {"whole", stack::NeutralCode::whole}};
  verb.add_option(
          "--neutral", neutral_,
          "code of --encoding derivative that means flat: between (default), 127.5 of 255, or whole, 128")
      ->transform(one_of(neutrals))
      ->type_name("NAME")
      ->option_text("NAME");
  const std::map<std::string, stack::Green> greens{{"up", stack::Green::up}, {"down", stack::Green::down}};
  verb.add_option("--green", job_.green,
                  "up (default): green grows along the map's upward direction, as in glTF, Unity, Godot and\n"
                  "Blender; down: against it, as in Unreal")
      ->transform(one_of(greens))
      ->type_name("NAME")
      ->option_text("NAME");
  const std::map<std::string, bool> switches{{"on", true}, {"off", false}};
  verb.add_option("--dither", dither_,
                  "on (default) or off: with --depth 8, noise in place of terraces; flat texels stay flat")
      ->transform(one_of(switches))
      ->type_name("NAME")
      ->option_text("NAME");
}

bake::Options BakeJob::options(Size size, image::Depth depth, const std::filesystem::path& output) const {
  bake::Options job = job_;
  job.width = size.width;
  job.height = size.height;
  job.depth = depth;
  set_padding(padding_, job);
  if (job.encoding != bake::Encoding::rgb && job.space != bake::Space::tangent)
    throw CLI::ValidationError("--encoding", "two channels hold normals of --space tangent alone");
  const bool derivative = job.encoding == bake::Encoding::derivative;
  if (range_ && !derivative) throw CLI::ValidationError("--range", "is for --encoding derivative");
  if (range_ && !(*range_ > 0 && *range_ <= max_slope))
    throw CLI::ValidationError("--range", fmt::format("must be a slope above 0, up to {}", max_slope));
  if (neutral_ && !(derivative && image::is_integer(depth)))
    throw CLI::ValidationError("--neutral", "is for --encoding derivative and the depths 8 and 16");
  if (dither_ && depth != image::Depth::unorm8) throw CLI::ValidationError("--dither", "is for --depth 8");
  if (job.samples * std::max(job.width, job.height) > most_samples_a_side)
    throw CLI::ValidationError("--samples",
                               fmt::format("{} along each side of a texel of this --size are more than "
                                           "{} along a side of the map",
                                           job.samples, most_samples_a_side));
  job.range = range_.value_or(job.range);
  job.neutral = neutral_.value_or(job.neutral);
  job.dither = dither_.value_or(depth == image::Depth::unorm8);
  // The two channels of a PNG are grey and opacity.
  job.full_blue = job.encoding != bake::Encoding::rgb && io::lower_extension(output) == ".png";
  return job;
}

} // namespace surfgrad::cli
