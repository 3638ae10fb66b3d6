#include "commands.hpp"
#include "console.hpp"
#include "diagnostic/error.hpp"
#include "input_files.hpp"
#include "interrupt.hpp"
#include "io/extension.hpp"
#include "io/image_file.hpp"
#include "map_options.hpp"
#include "maps/blend.hpp"
#include "maps/convert.hpp"
#include "options.hpp"
#include "output_names.hpp"
#include "output_set.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <memory>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

struct BlendCommand {
  std::vector<std::string> maps;
  std::vector<std::string> details;
  std::vector<double> weights;
  std::vector<std::string> masks;
  std::vector<std::string> tiles;
  std::vector<double> rotations;
  maps::Method method = maps::Method::surface_gradient;
  maps::Form base{};
  maps::Form detail{};
  maps::Form to{};
  bool is_derivative = false;
  std::string output;
  OutputNames names;
  std::string depth;
  std::optional<bool> dither;
  io::Compression compression = io::Compression::fast;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

/// "8" or "8x4", neither 0.
vec2<double> tile_of(const std::string& text) {
  const auto number = [&](std::string_view part) {
    double value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (error != std::errc() || end != part.data() + part.size() || value == 0 || !std::isfinite(value))
      throw CLI::ValidationError("--tile",
                                 "\"" + text + "\" is not how often a detail repeats; use N or SxT");
    return value;
  };
  const std::size_t x = text.find('x');
  const std::string_view whole = text;
  if (x == std::string::npos) return {number(whole), number(whole)};
  return {number(whole.substr(0, x)), number(whole.substr(x + 1))};
}

/// The value for a detail: its own, or the one for all.
template <class T>
T value_for(const std::vector<T>& values, std::size_t detail, T without) {
  return values.empty() ? without : values.size() == 1 ? values[0] : values[detail];
}

void check_count(const char* option, std::size_t values, std::size_t details) {
  if (values > 1 && values != details)
    throw CLI::ValidationError(option,
                               fmt::format("is given {} times for {} details; give one for each, or one "
                                           "for all",
                                           values, details));
}

image::Image read_normals(const std::string& file, const maps::Form& form) {
  const image::Image map = io::read_image(file);
  maps::require_normals(map, form, maps::Inward::refused, file);
  return maps::read_slopes(map, form, file).map;
}

/// The details, read once for all bases.
std::vector<maps::Detail> read_details(const BlendCommand& command) {
  std::vector<maps::Detail> details;
  for (std::size_t i = 0; i < command.details.size(); ++i) {
    maps::Detail detail;
    detail.slopes = read_normals(command.details[i], command.detail);
    detail.weight = value_for(command.weights, i, 1.0);
    detail.tile = tile_of(value_for(command.tiles, i, std::string("1")));
    detail.rotate_deg = value_for(command.rotations, i, 0.0);
    const std::string mask = value_for(command.masks, i, std::string("none"));
    if (mask != "none")
      detail.mask = maps::read_heights(io::read_image(mask), {.kind = maps::Kind::height}, mask);
    details.push_back(std::move(detail));
    stop_if_interrupted();
  }
  return details;
}

/// Details that are not tiled must be of the base's size, and so must masks.
void check_sizes(const BlendCommand& command, const std::vector<maps::Detail>& details,
                 const image::Image& base, const fs::path& input) {
  const auto check = [&](const std::string& file, const image::Image& picture, const char* what) {
    if (picture.width == base.width && picture.height == base.height) return;
    throw InputError({.file = file,
                      .problem = fmt::format("is {}x{}, but {} is {}x{}", picture.width, picture.height,
                                             input.string(), base.width, base.height),
                      .remedy = what});
  };
  for (std::size_t i = 0; i < details.size(); ++i) {
    const bool is_laid_out = details[i].tile.x != 1 || details[i].tile.y != 1 || details[i].rotate_deg != 0;
    if (!is_laid_out)
      check(command.details[i], details[i].slopes,
            "resize one of them (surfgrad convert --resize), or give --tile");
    if (!details[i].mask.texels.empty())
      check(value_for(command.masks, i, std::string()), details[i].mask,
            "resize it (surfgrad convert --from height --to height --resize)");
  }
}

/// One base. Returns its summary for machines.
nlohmann::json blend_file(const BlendCommand& command, const std::vector<maps::Detail>& details,
                          const fs::path& input, Console& console) {
  const fs::path output = command.names.file_for(command.output, input);
  const image::Depth depth = depth_for(output, command.depth, image::Depth::unorm16);
  check_output(output, depth);
  for (const auto& files : {command.maps, command.details, command.masks}) refuse_to_replace(files, output);
  image::Image base = read_normals(input.string(), command.base);
  check_sizes(command, details, base, input);
  image::Image sum = maps::blended(std::move(base), details, command.method);
  maps::Form to = command.to;
  to.is_filled = io::lower_extension(output) == ".png";
  // Slopes themselves, for the conversion that writes them: floats hold them as they are.
  maps::Conversion conversion{.from = {.kind = maps::Kind::derivative},
                              .to = to,
                              .depth = depth,
                              .dither = command.dither.value_or(depth == image::Depth::unorm8)};
  const maps::Converted made = maps::convert(std::move(sum), conversion, input);
  {
    const Unbroken whole_file;
    stop_if_interrupted();
    io::write_image(output, made.map, depth, command.compression);
  }
  if (!command.json) {
    if (made.clamped > 0)
      console.warn(
          fmt::format("{} texels are steeper than the range of {:g}: they are flattened to it; --range "
                      "{:.4g} would hold all",
                      made.clamped, to.range, 1.0001 * made.steepest));
    console.say(fmt::format("wrote {} ({}x{}, slopes up to {:.3g})", output.string(), made.map.width,
                            made.map.height, made.steepest));
  }
  return {{"input", input.string()},   {"output", output.string()},       {"width", made.map.width},
          {"height", made.map.height}, {"steepest_slope", made.steepest}, {"clamped_texels", made.clamped}};
}

void run(BlendCommand& command) {
  const std::size_t count = command.details.size();
  check_count("--weight", command.weights.size(), count);
  check_count("--mask", command.masks.size(), count);
  check_count("--tile", command.tiles.size(), count);
  check_count("--rotate", command.rotations.size(), count);
  if (command.is_derivative) command.to.kind = maps::Kind::derivative;
  if (command.output.empty()) {
    if (!command.names.has_folder()) throw CLI::RequiredError("--output or --out-dir");
    command.output = "<NAME>.png";
  }
  command.maps = image_files(command.maps);
  command.names.check("--output", command.output, command.maps);
  OutputSet outputs;
  for (const std::string& map : command.maps)
    outputs.claim("--output", command.names.file_for(command.output, map), map);
  command.names.make_folder();
  on_threads(command.threads, [&] {
    const std::vector<maps::Detail> details = read_details(command);
    for_each_map(
        command.maps, {"blending", command.quiet, command.json},
        [&](const auto& map, Console& console) { return blend_file(command, details, map, console); });
  });
}

void add_detail_options(CLI::App& verb, BlendCommand& command) {
  verb.add_option("--detail", command.details,
                  "normal map to put onto the base; again for more, which go on top")
      ->required()
      ->check(not_empty())
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  verb.add_option("--weight", command.weights,
                  "factor of a detail's slopes (default: 1); one for all, or one for each")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FACTOR");
  verb.add_option("--mask", command.masks, "where a detail shows, white for all of it; none for no mask")
      ->check(not_empty())
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  verb.add_option("--tile", command.tiles, "how often a detail repeats over the base: N or SxT (default: 1)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("N");
  verb.add_option("--rotate", command.rotations,
                  "degrees that a detail's coordinates are turned counter-clockwise")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("DEGREES");
}

} // namespace

void add_blend_command(CLI::App& program) {
  auto command = std::make_shared<BlendCommand>();
  CLI::App& verb =
      *program.add_subcommand("blend", "Put detail normal maps onto base maps that share their UVs");
  verb.footer(
      "Slopes add up as the heights do that they belong to; the other methods are here to be compared "
      "with.\n\n"
      "Examples:\n"
      "  surfgrad blend wall_n.png --detail plaster_n.png --tile 8 -o wall_detail_n.png\n"
      "  surfgrad blend skin_n.png --detail pores_n.png --weight 0.4 --mask face.png -o skin_pores_n.png\n"
      "  surfgrad blend walls --detail plaster_n.png --tile 8x4 --out-dir detailed\n"
      "  surfgrad blend a_n.png --detail b_n.png --method rnm -o rnm.png");
  verb.add_option("MAP", command->maps,
                  "base normal maps: images, folders of images, or patterns with * and ?")
      ->required()
      ->check(not_empty());
  verb.add_option("-o,--output", command->output, "file to write; the extension decides the format")
      ->check(not_empty())
      ->type_name("FILE");
  command->names.add_option(verb);
  add_detail_options(verb, *command);
  const std::map<std::string, maps::Method> methods{{"surfgrad", maps::Method::surface_gradient},
                                                    {"linear", maps::Method::linear},
                                                    {"overlay", maps::Method::overlay},
                                                    {"pd", maps::Method::partial_derivative},
                                                    {"whiteout", maps::Method::whiteout},
                                                    {"udn", maps::Method::udn},
                                                    {"rnm", maps::Method::rnm}};
  verb.add_option("--method", command->method,
                  "surfgrad (default), or to compare: linear, overlay, pd, whiteout, udn, rnm")
      ->transform(one_of(methods))
      ->type_name("NAME")
      ->option_text("NAME");
  add_green_option(verb, "--from-green", command->base.green, "which way the green of the base grows");
  add_green_option(verb, "--detail-green", command->detail.green, "which way that of the details grows");
  add_green_option(verb, "--green", command->to.green, "which way that of the output grows");
  verb.add_flag("--derivative", command->is_derivative, "write slopes in place of normals");
  add_derivative_options(verb, "--", command->to);
  add_depth_option(verb, command->depth, "16");
  add_dither_option(verb, command->dither, "with --depth 8");
  add_compress_option(verb, command->compression);
  add_job_options(verb, command->threads, command->quiet, command->json);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
