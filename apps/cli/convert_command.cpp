#include "batch.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "diagnostic/error.hpp"
#include "input_files.hpp"
#include "interrupt.hpp"
#include "io/extension.hpp"
#include "io/image_file.hpp"
#include "map_options.hpp"
#include "maps/convert.hpp"
#include "maps/over_mesh.hpp"
#include "maps/recode.hpp"
#include "options.hpp"
#include "output_names.hpp"
#include "output_set.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

/// What `--from` and `--to` name.
enum class Content { height, depth, normal, derivative, object };

struct ConvertCommand {
  std::vector<std::string> maps;
  std::string output;
  OutputNames names;
  Content from = Content::normal;
  Content to = Content::normal;
  maps::Conversion conversion{};
  std::optional<double> height;
  std::optional<double> size;
  std::string resize;
  std::string mesh;
  int uv_set = 0;
  std::string roughness;
  std::string base_roughness = "0.5";
  std::string depth;
  std::optional<bool> dither;
  io::Compression compression = io::Compression::fast;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

maps::Form form_of(Content content, maps::Form form) {
  form.kind = content == Content::height || content == Content::depth ? maps::Kind::height
              : content == Content::derivative                        ? maps::Kind::derivative
                                                                      : maps::Kind::normal;
  form.is_depth = content == Content::depth;
  return form;
}

/// What does not depend on the map. Throws CLI::ValidationError for options that contradict each other.
void check(const ConvertCommand& command) {
  const bool has_heights =
      command.conversion.from.kind == maps::Kind::height || command.conversion.to.kind == maps::Kind::height;
  const bool changes_space = (command.from == Content::object) != (command.to == Content::object);
  if ((command.height || command.size) && command.conversion.slope_scale)
    throw CLI::ValidationError("--slope-scale", "and --height with --size say the same; give one of them");
  if (command.size && !command.height)
    throw CLI::ValidationError("--size", "goes with --height, the relief of it");
  if ((command.height || command.conversion.slope_scale) && !has_heights)
    throw CLI::ValidationError(command.height ? "--height" : "--slope-scale", "is for height maps");
  if (command.mesh.empty() && changes_space)
    throw CLI::ValidationError(
        "--mesh", "is what lies between object space and the others: give the model that the map belongs to");
  if (!command.mesh.empty() && !changes_space)
    throw CLI::ValidationError("--mesh", "is for --from object or --to object");
  if (changes_space) {
    if (command.from != Content::normal && command.to != Content::normal)
      throw CLI::ValidationError("--mesh",
                                 "takes tangent-space normals to object space and back; convert twice");
    const maps::Conversion& c = command.conversion;
    if (c.retile || c.mips || !command.resize.empty() || !command.roughness.empty() ||
        c.from.channels.count > 0 || c.to.channels.count > 0 || c.to.flips_x)
      throw CLI::ValidationError("--mesh",
                                 "goes with --green, --from-green and --uv; convert twice for the rest");
  }
  if (command.from == Content::object && command.to == Content::object)
    throw CLI::ValidationError("--from", "and --to are both object; rearrange channels with --from normal");
  if (!command.roughness.empty() && command.conversion.to.kind == maps::Kind::height)
    throw CLI::ValidationError("--roughness", "is of slopes: not for --to height");
  if (!command.roughness.empty() && !command.conversion.mips && command.resize.empty())
    throw CLI::ValidationError("--roughness", "is what texels lose: give --mips or --resize");
}

/// How the letters of a form fit what it holds.
void check_channels(const std::string& option, const maps::Form& form) {
  const int count = form.channels.count;
  if (count == 0) return;
  const bool fits = form.kind == maps::Kind::height   ? count == 1
                    : form.kind == maps::Kind::normal ? count == 2 || count == 3
                                                      : count == 2;
  if (fits) return;
  throw CLI::ValidationError(option, form.kind == maps::Kind::height   ? "a height is one channel"
                                     : form.kind == maps::Kind::normal ? "a normal is two or three channels"
                                                                       : "a derivative is two channels");
}

/// The conversion of one map into one file.
maps::Conversion conversion_for(const ConvertCommand& command, const image::Image& map,
                                const fs::path& output) {
  maps::Conversion c = command.conversion;
  c.depth = depth_for(output, command.depth, image::Depth::unorm16);
  c.dither = command.dither.value_or(c.depth == image::Depth::unorm8 && map.depth != image::Depth::unorm8);
  // The two channels of a PNG are grey and opacity.
  c.to.is_filled = c.to.kind != maps::Kind::height && io::lower_extension(output) == ".png";
  if (!command.resize.empty()) {
    const Size size = parse_size(command.resize);
    c.width = size.width;
    c.height = size.height;
  }
  if (command.height) c.slope_scale = *command.height / command.size.value_or(1) * map.width;
  if (!command.roughness.empty()) c.base_roughness = base_roughness_of(command.base_roughness);
  return c;
}

void say(const maps::Converted& made, const maps::Conversion& c, const fs::path& output, Console& console) {
  const double texels = double{1.0 * made.map.width} * made.map.height;
  if (made.inward > 0)
    console.warn(fmt::format("{} texels ({:.1f} %) point inward (z <= 0); they are read as if z was positive",
                             made.inward, 100 * static_cast<double>(made.inward) / texels));
  if (made.clamped > 0 && c.to.kind == maps::Kind::height)
    console.warn(fmt::format("{} heights lie outside 0 to 1 and are clamped; leave out the scale to fit them",
                             made.clamped));
  else if (made.clamped > 0)
    console.warn(
        fmt::format("{} texels are steeper than the range of {:g}: they are flattened to it; --range "
                    "{:.4g} would hold all",
                    made.clamped, c.to.range, 1.0001 * made.steepest));
  std::string more;
  if (made.slope_scale > 0) more += fmt::format(", slope scale {:.4g}", made.slope_scale);
  if (made.tilt && max_abs(*made.tilt) > 1e-6)
    more += fmt::format(", mean slope ({:.4f}, {:.4f}) left out", made.tilt->x, made.tilt->y);
  if (made.not_integrable)
    more += fmt::format(", {:.2f} % of the slopes on no surface", 100 * *made.not_integrable);
  console.say(fmt::format("wrote {} ({}x{}{})", output.string(), made.map.width, made.map.height, more));
}

nlohmann::json summary_of(const maps::Converted& made, const fs::path& input, const fs::path& output) {
  nlohmann::json summary{{"input", input.string()},         {"output", output.string()},
                         {"width", made.map.width},         {"height", made.map.height},
                         {"inward_texels", made.inward},    {"clamped_texels", made.clamped},
                         {"steepest_slope", made.steepest}, {"rearranged", made.is_rearranged}};
  if (made.slope_scale > 0) summary["slope_scale"] = made.slope_scale;
  if (made.not_integrable) summary["not_integrable"] = *made.not_integrable;
  if (made.tilt) summary["mean_slope"] = {made.tilt->x, made.tilt->y};
  return summary;
}

void write(const fs::path& file, const image::Image& map, image::Depth depth, io::Compression compression) {
  const Unbroken whole_file;
  stop_if_interrupted();
  io::write_image(file, map, depth, compression);
}

/// A conversion that changes only codes, written while it is done. Returns its summary for machines.
nlohmann::json recode_file(const ConvertCommand& command, const image::Image& map,
                           const maps::Recoding& recoding, image::Depth depth, const fs::path& input,
                           const fs::path& output, Console& console) {
  OutputFile file(output, {map.width, map.height, recoding.channels(), recoding.has_alpha()}, depth,
                  command.compression);
  constexpr int band_rows = 64; // some megabytes
  for (int top = map.height; top > 0; top -= band_rows) {
    const int rows = std::min(band_rows, top);
    file.write(recoding.rows(top - rows, rows));
  }
  file.commit();
  if (!command.json) console.say(fmt::format("wrote {} ({}x{})", output.string(), map.width, map.height));
  return {{"input", input.string()},
          {"output", output.string()},
          {"width", map.width},
          {"height", map.height},
          {"rearranged", true}};
}

/// One map. Returns its summary for machines.
nlohmann::json convert_file(const ConvertCommand& command, const fs::path& input, Console& console) {
  const fs::path output = command.names.file_for(command.output, input);
  const fs::path roughness = command.names.file_for(command.roughness, input);
  check_output(output, depth_for(output, command.depth, image::Depth::unorm16));
  refuse_to_replace(command.maps, output);
  if (!roughness.empty()) {
    check_output(roughness, depth_for(roughness, "", image::Depth::unorm8));
    refuse_to_replace(command.maps, roughness);
  }
  image::Image map = io::read_image(input);
  stop_if_interrupted();
  const maps::Conversion c = conversion_for(command, map, output);
  maps::Converted made;
  if (command.mesh.empty()) {
    if (const auto recoding = maps::Recoding::of(map, c, input))
      return recode_file(command, map, *recoding, c.depth, input, output, console);
    made = maps::convert(std::move(map), c, input);
  } else {
    const maps::OverMesh job{.model = command.mesh,
                             .uv_set = command.uv_set,
                             .to_object = command.to == Content::object,
                             .green_from = c.from.green,
                             .green_to = c.to.green,
                             .depth = c.depth,
                             .dither = c.dither};
    made.map = maps::in_other_space(map, job, input, console.report());
  }
  write(output, made.map, c.depth, command.compression);
  for (std::size_t i = 0; i < made.mips.size(); ++i)
    write(file_of_level(output, static_cast<int>(i) + 1), made.mips[i], c.depth, command.compression);
  for (std::size_t i = 0; i < made.roughness.size(); ++i)
    write(file_of_level(roughness, static_cast<int>(i)), made.roughness[i],
          depth_for(roughness, "", image::Depth::unorm8), command.compression);
  if (!command.json) say(made, c, output, console);
  return summary_of(made, input, output);
}

/// No two files of a run are the same one.
void claim_outputs(const ConvertCommand& command) {
  constexpr int most_levels = 17; // of the largest picture that can be read
  OutputSet outputs;
  for (const std::string& map : command.maps)
    for (int level = 0; level < (command.conversion.mips ? most_levels : 1); ++level) {
      outputs.claim("--output", file_of_level(command.names.file_for(command.output, map), level), map);
      if (!command.roughness.empty())
        outputs.claim("--roughness", file_of_level(command.names.file_for(command.roughness, map), level),
                      map);
    }
}

void run(ConvertCommand& command) {
  command.conversion.from = form_of(command.from, command.conversion.from);
  command.conversion.to = form_of(command.to, command.conversion.to);
  check(command);
  check_channels("--from-channels", command.conversion.from);
  check_channels("--to-channels", command.conversion.to);
  if (command.output.empty()) {
    if (!command.names.has_folder()) throw CLI::RequiredError("--output or --out-dir");
    command.output = "<NAME>.png";
  }
  command.maps = image_files(command.maps);
  command.names.check("--output", command.output, command.maps);
  command.names.check("--roughness", command.roughness, command.maps);
  claim_outputs(command);
  command.names.make_folder();
  on_threads(command.threads, [&] {
    for_each_map(command.maps, {"converting", command.quiet, command.json},
                 [&](const auto& map, Console& console) { return convert_file(command, map, console); });
  });
}

/// What the file has and what it gets.
void add_form_options(CLI::App& verb, ConvertCommand& command) {
  const std::map<std::string, Content> contents{{"height", Content::height},
                                                {"depth", Content::depth},
                                                {"normal", Content::normal},
                                                {"derivative", Content::derivative},
                                                {"object", Content::object}};
  verb.add_option(
          "--from", command.from,
          "what the maps are: normal (default: tangent space), derivative, height, depth (white lies\n"
          "deepest) or object (normals in the space of --mesh)")
      ->transform(one_of(contents))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_option("--to", command.to, "what they become, likewise")
      ->transform(one_of(contents))
      ->type_name("NAME")
      ->option_text("NAME");
  add_green_option(verb, "--from-green", command.conversion.from.green,
                   "which way the green of the input grows");
  add_green_option(verb, "--green", command.conversion.to.green, "which way that of the output grows");
  verb.add_flag("--flip-x", command.conversion.to.flips_x,
                "negate x, for readers whose red grows to the left");
  add_channels_option(
      verb, "--from-channels", command.conversion.from.channels,
      "channels of x and y (z is reconstructed), or of x, y and z, or of the height: rg, ag, bgr ...");
  add_channels_option(verb, "--to-channels", command.conversion.to.channels,
                      "the same of the output; channels between them are white");
  add_derivative_options(verb, "--from-", command.conversion.from);
  add_derivative_options(verb, "--", command.conversion.to);
}

void add_surface_options(CLI::App& verb, ConvertCommand& command) {
  verb.add_option("--height", command.height, "relief of a height map, from black to white (default: 0.02)")
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("LENGTH");
  verb.add_option("--size", command.size, "width of the map in the same unit (default: 1)")
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("LENGTH");
  verb.add_option("--slope-scale", command.conversion.slope_scale,
                  "instead: slope of a height that rises from black to white within a texel")
      ->check(CLI::PositiveNumber.description(""))
      ->type_name("SLOPE");
  const std::map<std::string, maps::Kernel> kernels{{"central", maps::Kernel::central},
                                                    {"sobel", maps::Kernel::sobel},
                                                    {"scharr", maps::Kernel::scharr},
                                                    {"bspline", maps::Kernel::bspline}};
  verb.add_option("--kernel", command.conversion.kernel,
                  "how heights become slopes: bspline (default), central, sobel or scharr")
      ->transform(one_of(kernels))
      ->type_name("NAME")
      ->option_text("NAME");
  const std::map<std::string, maps::Border> borders{{"repeat", maps::Border::repeat},
                                                    {"clamp", maps::Border::clamp}};
  verb.add_option("--wrap", command.conversion.border,
                  "what adjoins the map: repeat (default), itself, or clamp, nothing")
      ->transform(one_of(borders))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_flag("--retile", command.conversion.retile,
                "remove the mean slope, which keeps a tiled surface from closing");
  verb.add_option("--mesh", command.mesh, "model that lies between object space and tangent space")
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_option("--uv", command.uv_set, "UV set of the model that the map is laid out in")
      ->capture_default_str()
      ->check(CLI::Range(0, 7))
      ->type_name("SET");
}

void add_file_options(CLI::App& verb, ConvertCommand& command) {
  verb.add_option("--resize", command.resize,
                  "side in pixels, or WIDTHxHEIGHT: slopes are averaged, not normals")
      ->type_name("N");
  verb.add_flag("--mips", command.conversion.mips,
                "also write the mip levels, of mean slopes: NAME_mip1.png and so on");
  verb.add_option(
          "--roughness", command.roughness,
          "also write the roughness that the slopes lost in each texel amount to; wants --mips or --resize")
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_option("--base-roughness", command.base_roughness,
                  "roughness without them: a number from 0 to 1, or a map")
      ->capture_default_str()
      ->type_name("VALUE|FILE");
  add_depth_option(verb, command.depth, "16");
  const std::map<std::string, bool> switches{{"on", true}, {"off", false}};
  verb.add_option(
          "--dither", command.dither,
          "on (default, from more bits to 8) or off: noise in place of terraces; flat texels stay flat")
      ->transform(one_of(switches))
      ->type_name("NAME")
      ->option_text("NAME");
  add_compress_option(verb, command.compression);
}

} // namespace

void add_convert_command(CLI::App& program) {
  auto command = std::make_shared<ConvertCommand>();
  CLI::App& verb =
      *program.add_subcommand("convert", "Convert height, normal, derivative and object-space maps");
  verb.footer(
      "Everything becomes slopes in between, which average and add as surfaces do. Where nothing but the\n"
      "arrangement changes (green, x, channels, bits) the vectors stay as they are, to the last code.\n\n"
      "Examples:\n"
      "  surfgrad convert rock_n.png -o rock_dx.png --green down\n"
      "  surfgrad convert brick_h.tif -o brick_n.png --from height --height 0.01 --size 1.2\n"
      "  surfgrad convert rock_n.png -o rock_h.exr --to height\n"
      "  surfgrad convert rock_n.png -o rock_d.png --to derivative --range 2 --retile\n"
      "  surfgrad convert scans --out-dir small --resize 1024 --depth 8\n"
      "  surfgrad convert rock_n.png -o n.png --mips --roughness r.png --base-roughness 0.3\n"
      "  surfgrad convert pirate_os.png -o pirate_ts.png --from object --mesh pirate.glb");
  verb.add_option("MAP", command->maps, "images, folders of images, or patterns with * and ?")
      ->required()
      ->check(not_empty());
  verb.add_option("-o,--output", command->output, "file to write; the extension decides the format")
      ->check(not_empty())
      ->type_name("FILE");
  command->names.add_option(verb);
  add_form_options(verb, *command);
  add_surface_options(verb, *command);
  add_file_options(verb, *command);
  add_job_options(verb, command->threads, command->quiet, command->json);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
