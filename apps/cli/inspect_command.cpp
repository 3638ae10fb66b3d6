#include "commands.hpp"
#include "console.hpp"
#include "input_files.hpp"
#include "interrupt.hpp"
#include "io/image_file.hpp"
#include "map_options.hpp"
#include "maps/inspect.hpp"
#include "maps/mend.hpp"
#include "maps/preview.hpp"
#include "options.hpp"
#include "output_names.hpp"
#include "output_set.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

struct InspectCommand {
  std::vector<std::string> maps;
  std::string heights;
  bool is_depth = false;
  bool fix = false;
  std::string output;
  OutputNames names;
  std::string preview;
  std::string depth;
  io::Compression compression = io::Compression::fast;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

const char* word_of(maps::Confidence confidence) {
  switch (confidence) {
  case maps::Confidence::certain:
    return "certain";
  case maps::Confidence::likely:
    return "likely";
  case maps::Confidence::cannot_tell:
    break;
  }
  return "cannot tell";
}

const char* word_of(stack::Green green) { return green == stack::Green::up ? "up" : "down"; }

const char* words_of(maps::Look look) {
  switch (look) {
  case maps::Look::tangent_normals:
    return "tangent-space normals";
  case maps::Look::other_normals:
    return "object- or world-space normals";
  case maps::Look::heights:
    return "one channel: heights or a mask";
  case maps::Look::no_normals:
    break;
  }
  return "no normals";
}

/// A finding where there is one.
template <class Finding>
std::string told(const Finding& finding, const std::string& what) {
  const bool is_told = finding.confidence != maps::Confidence::cannot_tell;
  return is_told ? fmt::format("{} ({})", what, word_of(finding.confidence)) : "cannot tell";
}

/// What is found, line by line: a name and what there is to say.
std::vector<std::pair<std::string, std::string>> lines_of(const maps::Inspection& found,
                                                          const image::Image& map) {
  std::vector<std::pair<std::string, std::string>> lines;
  const auto add = [&](const char* name, std::string what) { lines.emplace_back(name, std::move(what)); };
  const double texels = double{1.0 * map.width} * map.height;
  add("looks like", fmt::format("{} ({})", words_of(found.look), word_of(found.look_confidence)));
  if (found.look == maps::Look::tangent_normals) {
    add("green", told(found.green, word_of(found.green.green)) +
                     fmt::format("; curls agree by {:.3f}, {:.0f} standard errors", found.green.agreement,
                                 found.green.certainty));
    add("mean slope", fmt::format("({:.4f}, {:.4f})", found.tilt.x, found.tilt.y));
    add("slopes",
        fmt::format("{:.3f} in the root mean square, {:.3g} at most", found.root_mean_slope, found.steepest));
    if (!found.hidden_roughness.empty()) {
      std::string levels;
      for (std::size_t i = 0; i < std::min<std::size_t>(4, found.hidden_roughness.size()); ++i)
        levels += fmt::format("{}{:.3f}", i == 0 ? "" : ", ", found.hidden_roughness[i]);
      add("hidden roughness",
          fmt::format("{} at mip levels 1 to 4, {:.3f} at the last", levels, found.hidden_roughness.back()));
    }
  }
  if (found.mean_length > 0)
    add("lengths", fmt::format("{:.3f} in the mean, off 1 by {:.3f}; {:.1f} % of the texels within 0.2 of 1",
                               found.mean_length, found.length_deviation, 100 * found.unit_share));
  if (found.inward > 0)
    add("inward", fmt::format("{} texels with z <= 0 ({:.1f} %)", found.inward,
                              100 * static_cast<double>(found.inward) / texels));
  if (!found.constant_channels.empty()) {
    std::string channels;
    for (const int c : found.constant_channels)
      channels += std::string(channels.empty() ? "" : ", ") + "rgba"[c];
    add("constant", channels);
  }
  if (found.is_banded) add("banding", "8 bits of data in a file of 16");
  const auto tiling = [](const maps::Tiling& t) {
    return told(t, t.repeats ? "repeats" : "has a seam") +
           (t.seam > 0 ? fmt::format("; seam {:.2f}", t.seam) : "");
  };
  add("along s", tiling(found.along_s));
  add("along t", tiling(found.along_t));
  if (found.heights) {
    add("heights", told(*found.heights, found.heights->is_inverted ? "inverted: the relief goes the other way"
                                                                   : "its relief") +
                       fmt::format("; green {}; correlation {:.3f}, {:.3f}", word_of(found.heights->green),
                                   found.heights->correlation.x, found.heights->correlation.y));
    add("slope scale", fmt::format("{:.4g}", found.heights->scale));
  }
  return lines;
}

nlohmann::json summary_of(const maps::Tiling& tiling) {
  return {{"confidence", word_of(tiling.confidence)}, {"repeats", tiling.repeats}, {"seam", tiling.seam}};
}

nlohmann::json summary_of(const maps::Inspection& found, const image::Image& map, const fs::path& input) {
  nlohmann::json summary{{"input", input.string()},
                         {"width", map.width},
                         {"height", map.height},
                         {"channels", map.channels},
                         {"looks_like", words_of(found.look)},
                         {"looks_like_confidence", word_of(found.look_confidence)},
                         {"constant_channels", found.constant_channels},
                         {"banded", found.is_banded},
                         {"along_s", summary_of(found.along_s)},
                         {"along_t", summary_of(found.along_t)}};
  if (found.mean_length > 0)
    summary.update({{"mean_length", found.mean_length},
                    {"length_deviation", found.length_deviation},
                    {"unit_share", found.unit_share},
                    {"inward_texels", found.inward}});
  if (found.look == maps::Look::tangent_normals)
    summary.update({{"green",
                     {{"confidence", word_of(found.green.confidence)},
                      {"agreement", found.green.agreement},
                      {"standard_errors", found.green.certainty}}},
                    {"mean_slope", {found.tilt.x, found.tilt.y}},
                    {"root_mean_square_slope", found.root_mean_slope},
                    {"steepest_slope", found.steepest},
                    {"hidden_roughness", found.hidden_roughness}});
  if (found.look == maps::Look::tangent_normals && found.green.confidence != maps::Confidence::cannot_tell)
    summary["green"]["value"] = word_of(found.green.green);
  if (found.heights)
    summary["heights"] = {{"confidence", word_of(found.heights->confidence)},
                          {"correlation", {found.heights->correlation.x, found.heights->correlation.y}},
                          {"inverted", found.heights->is_inverted},
                          {"green", word_of(found.heights->green)},
                          {"slope_scale", found.heights->scale}};
  return summary;
}

void write(const fs::path& file, const image::Image& map, image::Depth depth, io::Compression compression) {
  const Unbroken whole_file;
  stop_if_interrupted();
  io::write_image(file, map, depth, compression);
}

/// The bits of the file that was read, where the format has them.
image::Depth depth_like(const image::Image& map, const fs::path& output, const std::string& depth) {
  if (!depth.empty() || !image::is_integer(map.depth)) return depth_for(output, depth, image::Depth::unorm16);
  return depth_for(output, "", map.depth);
}

/// One map. Returns its summary for machines.
nlohmann::json inspect_file(const InspectCommand& command, const image::Image* heights, const fs::path& input,
                            Console& console) {
  const fs::path preview = command.names.file_for(command.preview, input);
  const fs::path output = command.names.file_for(command.output, input);
  for (const fs::path& file : {preview, output})
    if (!file.empty()) refuse_to_replace(command.maps, file);
  if (!preview.empty()) check_output(preview, depth_for(preview, "", image::Depth::unorm8));
  const image::Image map = io::read_image(input);
  stop_if_interrupted();
  const image::Depth depth = depth_like(map, output, command.depth);
  if (command.fix) check_output(output, depth);
  const maps::Inspection found = maps::inspect(map, heights, input);
  nlohmann::json summary = summary_of(found, map, input);
  std::vector<std::pair<std::string, std::string>> lines = lines_of(found, map);
  if (command.fix) {
    const maps::Mended mended = maps::mend(map, found, depth, input);
    write(output, mended.map, depth, command.compression);
    summary.update({{"output", output.string()}, {"fixed", mended.done}});
    for (const std::string& done : mended.done) lines.emplace_back("fixed", done);
    if (mended.done.empty()) lines.emplace_back("fixed", "nothing: no mistake is certain");
    lines.emplace_back("wrote", output.string());
  }
  if (!preview.empty() && map.channels > 1) {
    const maps::Form form{.green = found.green.green};
    const maps::Preview drawn = maps::preview(maps::read_slopes(map, form, input).map);
    write(preview, drawn.picture, depth_for(preview, "", image::Depth::unorm8), command.compression);
    summary.update({{"preview", preview.string()}, {"preview_range", drawn.range}});
    lines.emplace_back("wrote", fmt::format("{} (slopes up to {:g})", preview.string(), drawn.range));
  }
  if (!command.json) {
    console.say(fmt::format("{}: {}x{}, {} channel{}", input.string(), map.width, map.height, map.channels,
                            map.channels == 1 ? "" : "s"));
    for (const auto& [name, what] : lines) console.say(fmt::format("  {:<17}{}", name, what));
  }
  return summary;
}

void run(InspectCommand& command) {
  command.maps = image_files(command.maps);
  if (!command.fix && !command.output.empty()) throw CLI::ValidationError("--output", "goes with --fix");
  if (command.fix && command.output.empty()) {
    if (!command.names.has_folder())
      throw CLI::ValidationError("--fix", "writes maps: give --output or --out-dir");
    command.output = "<NAME>.png";
  }
  command.names.check("--output", command.output, command.maps);
  command.names.check("--preview", command.preview, command.maps);
  OutputSet outputs;
  for (const std::string& map : command.maps)
    for (const auto& [option, pattern] :
         {std::pair{"--output", command.output}, {"--preview", command.preview}})
      if (!pattern.empty()) outputs.claim(option, command.names.file_for(pattern, map), map);
  command.names.make_folder();
  on_threads(command.threads, [&] {
    std::optional<image::Image> heights;
    if (!command.heights.empty())
      heights =
          maps::read_heights(io::read_image(command.heights),
                             {.kind = maps::Kind::height, .is_depth = command.is_depth}, command.heights);
    for_each_map(command.maps, {"inspecting", command.quiet, command.json},
                 [&](const auto& map, Console& console) {
                   return inspect_file(command, heights ? &*heights : nullptr, map, console);
                 });
  });
}

} // namespace

void add_inspect_command(CLI::App& program) {
  auto command = std::make_shared<InspectCommand>();
  CLI::App& verb =
      *program.add_subcommand("inspect", "Say what a normal map is: conventions, slopes, seams, mistakes");
  verb.footer(
      "Green is found by the curl of the slopes, which a surface does not have: a map whose green is turned\n"
      "over has it everywhere. File names are no evidence; where the data cannot tell, that is the "
      "answer.\n\n"
      "Examples:\n"
      "  surfgrad inspect rock_n.png --preview rock.png\n"
      "  surfgrad inspect rock_n.png --heights rock_h.png     which way the relief goes, and its slope "
      "scale\n"
      "  surfgrad inspect maps --json\n"
      "  surfgrad inspect maps --fix --out-dir mended");
  verb.add_option("MAP", command->maps, "images, folders of images, or patterns with * and ?")
      ->required()
      ->check(not_empty());
  verb.add_option("--heights", command->heights, "heights that the maps may have been made of")
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_flag("--depths", command->is_depth, "they are depths: white lies deepest");
  verb.add_flag("--fix", command->fix,
                "mend what is certain (green up, unit length, no mean slope) and say what was done");
  verb.add_option("-o,--output", command->output, "file for the mended map")
      ->check(not_empty())
      ->type_name("FILE");
  command->names.add_option(verb);
  verb.add_option("--preview", command->preview,
                  "picture of a plate with the bumps, lit, and of how often each slope occurs")
      ->check(not_empty())
      ->type_name("FILE");
  add_depth_option(verb, command->depth, "as the input");
  add_compress_option(verb, command->compression);
  add_job_options(verb, command->threads, command->quiet, command->json);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
