#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "gltf_output.hpp"
#include "io/extension.hpp"
#include "io/image_file.hpp"
#include "lost_detail_output.hpp"
#include "options.hpp"

#include <surfgrad/derivative.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::cli {
namespace {

struct BakeCommand {
  CommonOptions common;
  bake::Options job{};
  std::string padding = "16"; // mip levels down to a sixteenth stay within the island
  std::optional<double> range;
  std::optional<stack::NeutralCode> neutral;
  std::optional<bool> dither;
  bool verify = false;
  GltfOutput gltf;
  LostDetailOutput lost_detail;
};

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

/// What the options say together. Throws CLI::ValidationError for those that contradict each other.
bake::Options job_of(const BakeCommand& command, image::Depth depth) {
  bake::Options job = command.job;
  const Size size = parse_size(command.common.size);
  job.width = size.width;
  job.height = size.height;
  job.depth = depth;
  set_padding(command.padding, job);
  if (job.encoding != bake::Encoding::rgb && job.space != bake::Space::tangent)
    throw CLI::ValidationError("--encoding", "two channels hold normals of --space tangent alone");
  const bool derivative = job.encoding == bake::Encoding::derivative;
  if (command.range && !derivative) throw CLI::ValidationError("--range", "is for --encoding derivative");
  if (command.range && !(*command.range > 0 && *command.range <= max_slope))
    throw CLI::ValidationError("--range", fmt::format("must be a slope above 0, up to {}", max_slope));
  if (command.neutral && !(derivative && image::is_integer(depth)))
    throw CLI::ValidationError("--neutral", "is for --encoding derivative and the depths 8 and 16");
  if (command.dither && depth != image::Depth::unorm8)
    throw CLI::ValidationError("--dither", "is for --depth 8");
  job.range = command.range.value_or(job.range);
  job.neutral = command.neutral.value_or(job.neutral);
  job.dither = command.dither.value_or(depth == image::Depth::unorm8);
  // The two channels of a PNG are grey and opacity.
  job.full_blue = job.encoding != bake::Encoding::rgb && io::lower_extension(command.common.output) == ".png";
  return job;
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

constexpr std::string_view udim_mark = "<UDIM>";

bool has_udim(const std::filesystem::path& output) {
  return output.filename().string().find(udim_mark) != std::string::npos;
}

std::filesystem::path file_of_tile(const std::filesystem::path& output, const bake::UdimTile& tile) {
  std::string name = output.filename().string();
  name.replace(name.find(udim_mark), udim_mark.size(), std::to_string(tile.number()));
  return output.parent_path() / name;
}

/// Bakes, verifies and tells of one map. Returns its summary where machines are told.
nlohmann::json bake_map(BakeCommand& command, scene::Scene scene, const bake::Options& job,
                        const std::filesystem::path& output, const ChosenDevice& device) {
  Console console("baking", command.common.quiet);
  const int channels = job.encoding == bake::Encoding::rgb || job.full_blue ? 3 : 2;
  OutputFile file(output, {job.width, job.height, channels}, job.depth, command.common.compression);
  const auto write = [&](const image::Image& band) { file.write(band); };
  // Images leave a scene that is handed over; one that is verified or written is still needed.
  const bool is_kept = command.verify || command.gltf.is_wanted() || command.lost_detail.is_wanted();
  bake::Counts baked = bake::bake_bands(is_kept ? scene : std::move(scene), job, write, console.report());
  if (has_udim(command.common.output)) baked.outside = 0; // it is in another tile
  file.commit();
  command.lost_detail.write(scene, job, output, command.common.compression, command.common.quiet);
  command.gltf.write(scene, job, baked, {output, command.lost_detail.roughness()}, command.common.quiet);
  std::optional<bake::Verification> verified;
  if (command.verify) {
    Console verifying("verifying", command.common.quiet);
    verified = bake::verify(scene, job, io::read_image(output), verifying.report());
  }
  const ChosenDevice::Filtered filtered = device.filtered();
  if (command.common.json) {
    nlohmann::json summary = summary_of(baked, job);
    summary.update({{"output", output.string()},
                    {"device", device.name()},
                    {"filter", filtered.filter},
                    {"maps_sampled_by_hardware", filtered.sampled},
                    {"filter_bound_deg", filtered.bound_deg}});
    if (verified)
      summary.update({{"verified", summary_of(verified->texels, "texels", job.height)},
                      {"verified_on_screen", summary_of(verified->on_screen, "pixels", bake::screen_side)}});
    for (const std::filesystem::path& written : command.lost_detail.files())
      summary["lost_detail"].push_back(written.string());
    if (command.gltf.is_wanted()) summary["gltf"] = command.gltf.file().string();
    return summary;
  }
  warn_about(baked, job, console);
  console.say(fmt::format("wrote {} ({}x{}, {} texels covered)", output.string(), job.width, job.height,
                          baked.covered));
  for (const std::filesystem::path& written : command.lost_detail.files())
    console.say(fmt::format("wrote {}", written.string()));
  if (command.gltf.is_wanted()) console.say(fmt::format("wrote {}", command.gltf.file().string()));
  if (verified) say_verified(*verified, job, console);
  say_filtered(filtered, console);
  return {};
}

/// A map for each tile that the mesh lies in.
nlohmann::json bake_tiles(BakeCommand& command, const scene::Scene& scene, bake::Options job,
                          const std::filesystem::path& output, const ChosenDevice& device) {
  const std::vector<bake::UdimTile> tiles = bake::udim_tiles(scene, job.uv_set);
  for (const bake::UdimTile& tile : tiles) check_is_no_input(scene, file_of_tile(output, tile), "--output");
  nlohmann::json summaries = nlohmann::json::array();
  for (const bake::UdimTile& tile : tiles) {
    job.tile = tile;
    summaries.push_back(bake_map(command, scene, job, file_of_tile(output, tile), device));
    summaries.back()["udim"] = tile.number();
  }
  return {{"tiles", summaries}};
}

void run(BakeCommand& command) {
  const std::filesystem::path output = command.common.output;
  const image::Depth depth = depth_for(output, command.common.depth, image::Depth::unorm16);
  const bake::Options job = job_of(command, depth);
  check_output(output, depth);
  command.gltf.check(job, output);
  command.lost_detail.check(job, output);
  const bool tiled = has_udim(output);
  if (tiled && (command.gltf.is_wanted() || command.lost_detail.is_wanted()))
    throw CLI::ValidationError("--output",
                               "<UDIM> goes with the normal map alone: leave out --gltf, --roughness, "
                               "--anisotropy and --mips");
  if (command.verify || job.fill) check_memory({job.width, job.height}); // they hold the map
  const ChosenDevice device(command.common.device);
  on_threads(command.common.threads, [&] {
    Console console("baking", command.common.quiet);
    scene::Scene scene = open_scene(command.common, console.report());
    check_is_no_input(scene, output, "--output");
    command.gltf.check(scene);
    command.lost_detail.check(scene, job, output);
    bake::Options on_device = job;
    on_device.backend = device.backend();
    const nlohmann::json summary = tiled ? bake_tiles(command, scene, on_device, output, device)
                                         : bake_map(command, std::move(scene), on_device, output, device);
    if (command.common.json) console.say_json(summary);
  });
}

/// How a texel stands for a normal.
void add_encoding_options(CLI::App& verb, BakeCommand& command) {
  const std::map<std::string, bake::Encoding> encodings{
      {"rgb", bake::Encoding::rgb}, {"rg", bake::Encoding::rg}, {"derivative", bake::Encoding::derivative}};
  verb.add_option(
          "--encoding", command.job.encoding,
          "rgb (default); rg: two channels, z is reconstructed (BC5); derivative: slopes, as the layer\n"
          "derivative_map reads them")
      ->transform(one_of(encodings))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_option("--range", command.range, "slope of the largest code of --encoding derivative (default: 1)")
      ->type_name("SLOPE");
  const std::map<std::string, stack::NeutralCode> neutrals{{"between", stack::NeutralCode::between},
                                                           {"whole", stack::NeutralCode::whole}};
  verb.add_option(
          "--neutral", command.neutral,
          "code of --encoding derivative that means flat: between (default), 127.5 of 255, or whole, 128")
      ->transform(one_of(neutrals))
      ->type_name("NAME")
      ->option_text("NAME");
  const std::map<std::string, stack::Green> greens{{"up", stack::Green::up}, {"down", stack::Green::down}};
  verb.add_option("--green", command.job.green,
                  "up (default): green grows along the map's upward direction, as in glTF, Unity, Godot and\n"
                  "Blender; down: against it, as in Unreal")
      ->transform(one_of(greens))
      ->type_name("NAME")
      ->option_text("NAME");
  const std::map<std::string, bool> switches{{"on", true}, {"off", false}};
  verb.add_option("--dither", command.dither,
                  "on (default) or off: with --depth 8, noise in place of terraces; flat texels stay flat")
      ->transform(one_of(switches))
      ->type_name("NAME")
      ->option_text("NAME");
}

} // namespace

void add_bake_command(CLI::App& program) {
  auto command = std::make_shared<BakeCommand>();
  CLI::App& verb = *program.add_subcommand("bake", "Bake a stack into one ordinary normal map over a UV set");
  verb.footer("The map is a MikkTSpace tangent-space normal map, green up: what engines and glTF expect.\n\n"
              "Examples:\n"
              "  surfgrad bake -o demo_normal.png                     the built-in demo\n"
              "  surfgrad bake pirate.json -o pirate_n.png --size 2048\n"
              "  surfgrad bake pirate.json -o pirate_n.png --depth 8 --green down --verify\n"
              "  surfgrad bake pirate.json -o pirate_n.png --gltf pirate.glb\n"
              "  surfgrad bake pirate.json -o pirate_n.<UDIM>.png     a map for each UDIM tile of the mesh\n"
              "  surfgrad bake pirate.json -o pirate_n.png --samples 4 --roughness pirate_r.png\n"
              "  surfgrad bake pirate.json -o pirate_o.exr --space object");
  add_common_options(verb, command->common, "16");
  verb.add_option("--uv", command->job.uv_set, "UV set that the map is laid out in")
      ->capture_default_str()
      ->check(CLI::Range(0, 7))
      ->type_name("SET");
  const std::map<std::string, bake::Space> spaces{
      {"tangent", bake::Space::tangent}, {"object", bake::Space::object}, {"world", bake::Space::world}};
  verb.add_option("--space", command->job.space, "tangent (default), object or world")
      ->transform(one_of(spaces))
      ->type_name("NAME")
      ->option_text("NAME");
  add_encoding_options(verb, *command);
  verb.add_option(
          "--samples", command->job.samples,
          "samples along each side of a texel; their slopes are averaged, and a texel is covered where\n"
          "one of them is")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  verb.add_option("--padding", command->padding,
                  "texels around the islands that repeat their border, so that filters and mip levels\n"
                  "do not show what lies between; 0 for none, fill for all (the map is held in memory)")
      ->capture_default_str()
      ->type_name("N|fill");
  verb.add_flag(
      "--verify", command->verify,
      "decode the written map as an engine does and print how far its normals are from the stack's:\n"
      "at the baked points, and filtered in a picture from the scene's camera");
  command->lost_detail.add_options(verb);
  command->gltf.add_option(verb);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
