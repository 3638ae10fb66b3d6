#include "bake/bake.hpp"
#include "bake/verify.hpp"
#include "bake_job.hpp"
#include "bake_record.hpp"
#include "bake_summary.hpp"
#include "batch.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "gltf_output.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "io/model_files.hpp"
#include "io/read_log.hpp"
#include "lost_detail_output.hpp"
#include "options.hpp"
#include "output_names.hpp"
#include "output_set.hpp"
#include "shard.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::cli {
namespace {

struct BakeCommand {
  CommonOptions common;
  BakeJob job;
  bool verify = false;
  GltfOutput gltf;
  LostDetailOutput lost_detail;
  std::vector<std::string> scenes; // without any the built-in demo
  OutputNames names;
  Shard shard;
  bool if_changed = false;
  const CLI::App* verb = nullptr;
  std::shared_ptr<OutputSet> outputs = std::make_shared<OutputSet>(); // of all scenes
};

constexpr std::string_view udim_mark = "<UDIM>";

bool has_udim(const std::filesystem::path& output) {
  return output.string().find(udim_mark) != std::string::npos;
}

std::filesystem::path file_of_tile(const std::filesystem::path& output, const bake::UdimTile& tile) {
  std::string name = output.string();
  for (std::size_t at = 0; (at = name.find(udim_mark, at)) != std::string::npos;)
    name.replace(at, udim_mark.size(), std::to_string(tile.number()));
  return name;
}

/// All that decides what an output holds but the contents of the files that are read.
nlohmann::json job_to_record(const BakeCommand& command, const std::filesystem::path& output,
                             const ChosenDevice& device) {
  nlohmann::json options;
  for (const CLI::Option* option : command.verb->get_options()) {
    static const std::set<std::string> without_effect{"SCENE",  "--threads",    "--quiet", "--json",
                                                      "--help", "--if-changed", "--shard", "--verify"};
    if (option->count() > 0 && !without_effect.contains(option->get_name()))
      options[option->get_name()] = option->results();
  }
  // Relative names among the options mean files of this folder.
  return {{"surfgrad", SURFGRAD_VERSION}, {"folder", std::filesystem::current_path().string()},
          {"device", device.name()},      {"scene", command.common.scene},
          {"output", output.string()},    {"options", options}};
}

/// Whether --if-changed finds the output as it would be made; that is told.
bool is_unchanged(const BakeCommand& command, const std::filesystem::path& output,
                  const ChosenDevice& device) {
  if (!command.if_changed || command.verify) return false;
  Console console("comparing", command.common.quiet);
  const BakeRecord record(output, job_to_record(command, output, device));
  if (!record.is_up_to_date([&](std::string_view text) { console.warn(text); })) return false;
  if (!command.common.json) console.say(fmt::format("{} is up to date", output.string()));
  return true;
}

nlohmann::json unchanged_summary(const std::filesystem::path& output) {
  return {{"output", output.string()}, {"unchanged", true}};
}

/// Bakes, verifies and tells of one map. Returns its summary for machines.
///
/// stage  of the scene, if it is for other maps too; else the scene is given away where nothing else needs it
nlohmann::json bake_map(BakeCommand& command, scene::Scene& scene, const stage::Stage* stage,
                        const bake::Options& job, const std::filesystem::path& output,
                        const ChosenDevice& device) {
  const bool is_one_of_many = command.scenes.size() > 1 || has_udim(command.common.output);
  Console console(is_one_of_many ? "baking " + output.filename().string() : "baking", command.common.quiet);
  const int channels = job.encoding == bake::Encoding::rgb || job.full_blue ? 3 : 2;
  OutputFile file(output, {job.width, job.height, channels}, job.depth, command.common.compression);
  const auto write = [&](const image::Image& band) { file.write(band); };
  // Images leave a scene that is handed over; one that is verified or written is still needed.
  const bool is_kept = command.verify || command.gltf.is_wanted() || command.lost_detail.is_wanted();
  bake::Counts baked =
      stage != nullptr ? bake::bake_bands(*stage, job, write, console.report())
                       : bake::bake_bands(is_kept ? scene : std::move(scene), job, write, console.report());
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
  nlohmann::json summary = summary_of(baked, job);
  summary.update({{"output", output.string()},
                  {"device", device.name()},
                  {"filter", filtered.filter},
                  {"maps_sampled_by_hardware", filtered.sampled},
                  {"filter_bound_deg", filtered.bound_deg}});
  if (verified) summary.update(summary_of(*verified, job));
  for (const std::filesystem::path& written : command.lost_detail.files())
    summary["lost_detail"].push_back(written.string());
  if (command.gltf.is_wanted()) summary["gltf"] = command.gltf.file().string();
  if (command.common.json) return summary;
  warn_about(baked, job, console);
  console.say(fmt::format("wrote {} ({}x{}, {} texels covered)", output.string(), job.width, job.height,
                          baked.covered));
  for (const std::filesystem::path& written : command.lost_detail.files())
    console.say(fmt::format("wrote {}", written.string()));
  if (command.gltf.is_wanted()) console.say(fmt::format("wrote {}", command.gltf.file().string()));
  if (verified) say_verified(*verified, job, console);
  say_filtered(filtered, console);
  return summary;
}

std::vector<std::filesystem::path> written_by(const BakeCommand& command,
                                              const std::filesystem::path& output) {
  std::vector<std::filesystem::path> files = command.lost_detail.files();
  files.push_back(output);
  if (command.gltf.is_wanted()) files.push_back(command.gltf.file());
  return files;
}

/// A map for each tile that the mesh lies in, and its summary for machines.
///
/// number  of the scene among those of the command
void bake_tiles(BakeCommand& command, scene::Scene scene, std::size_t number, bake::Options job,
                const ChosenDevice& device, const io::ReadLog& log, nlohmann::json& summary) {
  const std::filesystem::path output = command.common.output;
  const auto inputs = log.files();
  const std::vector<bake::UdimTile> tiles = bake::udim_tiles(scene, job.uv_set);
  for (const bake::UdimTile& tile : tiles) check_is_no_input(scene, file_of_tile(output, tile), "--output");
  struct Tile {
    bake::UdimTile tile;
    std::filesystem::path file;
    bool is_unchanged;
  };
  std::vector<Tile> mine;
  for (const bake::UdimTile& tile : tiles) {
    if (!command.shard.has(number++)) continue;
    const std::filesystem::path file = file_of_tile(output, tile);
    mine.push_back({tile, file, is_unchanged(command, file, device)});
  }
  nlohmann::json& summaries = summary["tiles"] = nlohmann::json::array();
  std::unique_ptr<const stage::Stage> stage;
  if (std::any_of(mine.begin(), mine.end(), [](const Tile& t) { return !t.is_unchanged; })) {
    Console console("preparing", command.common.quiet);
    // Only what is verified needs the scene again.
    stage.reset(
        new stage::Stage(bake::stage_of(command.verify ? scene : std::move(scene), job, console.report())));
  }
  Batch batch("tiles", tiles.size());
  for (const Tile& one : mine) {
    if (one.is_unchanged) {
      summaries.push_back(unchanged_summary(one.file));
    } else {
      job.tile = one.tile;
      const auto failure = batch.run(one.file.string(), [&] {
        summaries.push_back(bake_map(command, scene, stage.get(), job, one.file, device));
        if (command.if_changed)
          BakeRecord(one.file, job_to_record(command, one.file, device)).write(inputs, {one.file});
      });
      if (failure) summaries.push_back({{"output", one.file.string()}, {"error", failure->what}});
    }
    summaries.back()["udim"] = one.tile.number();
  }
  batch.finish();
}

/// The maps of one scene, and their summary for machines.
///
/// number  of the scene among those of the command
void bake_scene(BakeCommand& command, std::size_t number, const ChosenDevice& device,
                nlohmann::json& summary) {
  const std::filesystem::path output = command.common.output;
  const image::Depth depth = depth_for(output, command.common.depth, image::Depth::unorm16);
  bake::Options job = command.job.options(parse_size(command.common.size), depth, output);
  job.backend = device.backend();
  command.outputs->check_outputs(command.common.scene);
  check_output(output, depth);
  command.gltf.check(job, output);
  command.lost_detail.check(job, output);
  const bool tiled = has_udim(output);
  if (tiled && (command.gltf.is_wanted() || command.lost_detail.is_wanted()))
    throw CLI::ValidationError("--output",
                               "<UDIM> goes with the normal map alone: leave out --gltf, --roughness, "
                               "--anisotropy and --mips");
  if (command.verify || job.fill) check_memory({job.width, job.height}); // they hold the map
  if (command.if_changed) {
    const Unbroken probe;
    io::check_writable(BakeRecord::file_for(output));
  }
  if (!tiled && is_unchanged(command, output, device)) {
    summary = unchanged_summary(output);
    return;
  }
  const io::ReadLog log;
  Console console("reading", command.common.quiet);
  scene::Scene scene = open_scene(command.common, console.report());
  command.lost_detail.read_base();
  for (const auto& [file, digest] : log.files()) command.outputs->check_input(file, command.common.scene);
  if (command.gltf.is_wanted() && !scene.model.empty())
    for (const std::filesystem::path& file : io::files_named_by(scene.model))
      command.outputs->check_input(file, command.common.scene);
  if (tiled) {
    bake_tiles(command, std::move(scene), number, job, device, log, summary);
    return;
  }
  summary = bake_map(command, scene, nullptr, job, output, device);
  if (command.if_changed)
    BakeRecord(output, job_to_record(command, output, device))
        .write(log.files(), written_by(command, output));
}

/// What the outputs of a scene are called, as far as that is known before it is read.
void claim_outputs(const BakeCommand& one) {
  const auto claim = [&](const std::string& option, const std::filesystem::path& file) {
    one.outputs->claim(option, file, one.common.scene);
  };
  claim("--output", one.common.output);
  if (one.if_changed) claim("--if-changed", BakeRecord::file_for(one.common.output));
  if (one.gltf.is_wanted()) claim("--gltf", one.gltf.file());
  const Size size = parse_size(one.common.size);
  one.lost_detail.claim(one.common.output, std::max(size.width, size.height), claim);
}

/// The command as if it was given for this scene alone.
BakeCommand for_scene(const BakeCommand& all, const std::string& scene) {
  BakeCommand one = all;
  const auto file_for = [&](const std::string& pattern) { return all.names.file_for(pattern, scene); };
  one.common.scene = scene;
  one.common.output = file_for(all.common.output).string();
  one.gltf.rename(file_for);
  one.lost_detail.rename(file_for);
  return one;
}

void run(BakeCommand& command) {
  if (command.common.output.empty()) {
    if (!command.names.has_folder()) throw CLI::RequiredError("--output or --out-dir");
    command.common.output = "<NAME>_normal.png";
  }
  std::vector<std::string> scenes = command.scenes;
  if (scenes.empty()) scenes.emplace_back(); // the demo
  command.names.check("--output", command.common.output, scenes);
  command.gltf.check(command.names, scenes);
  command.lost_detail.check(command.names, scenes);
  for (const std::string& scene : scenes) claim_outputs(for_scene(command, scene));
  command.names.make_folder();
  const ChosenDevice device(command.common.device);
  on_threads(command.common.threads, [&] {
    Batch batch("scenes", scenes.size());
    nlohmann::json summaries = nlohmann::json::array();
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const bool tiled = has_udim(command.common.output);
      if (!tiled && !command.shard.has(i)) continue;
      nlohmann::json summary = nlohmann::json::object();
      const auto failure = batch.run(scenes[i], [&] {
        BakeCommand one = for_scene(command, scenes[i]);
        bake_scene(one, i, device, summary);
      });
      if (failure) summary["error"] = failure->what;
      summary["scene"] = scenes[i];
      summaries.push_back(std::move(summary));
    }
    if (command.common.json) {
      Console console("baking", command.common.quiet);
      if (command.scenes.size() > 1)
        console.say_json({{"scenes", summaries}});
      else if (!summaries.empty() && (!summaries[0].contains("error") || summaries[0].contains("tiles")))
        console.say_json(summaries[0]);
    }
    batch.finish();
  });
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
              "  surfgrad bake pirate.json -o pirate_o.exr --space object\n"
              "  surfgrad bake *.json --out-dir baked --if-changed    each scene that is not baked yet\n"
              "  surfgrad bake *.json --out-dir baked --gltf \"<NAME>.glb\" --shard 2/8");
  command->verb = &verb;
  verb.add_option("SCENE", command->scenes,
                  "stack documents (.json) or models (.gltf, .glb, .obj); without any the built-in demo")
      ->check(not_empty());
  verb.add_option("-o,--output", command->common.output,
                  "file to write; the extension decides the format. <UDIM> in its name: one for each tile\n"
                  "(default with --out-dir: <NAME>_normal.png)")
      ->check(not_empty())
      ->type_name("FILE");
  command->names.add_option(verb);
  add_picture_options(verb, command->common, "16");
  command->job.add_options(verb);
  verb.add_flag(
      "--verify", command->verify,
      "decode the written map as an engine does and print how far its normals are from the stack's:\n"
      "at the baked points, and filtered in a picture from the scene's camera");
  command->lost_detail.add_options(verb);
  command->gltf.add_option(verb);
  verb.add_flag("--if-changed", command->if_changed,
                "leave an output alone that is there as it was made, if what it was made from still holds\n"
                "the same; that is kept beside it, as FILE.bake-record");
  command->shard.add_option(verb);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
