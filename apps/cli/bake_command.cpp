#include "bake/bake.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <memory>

namespace surfgrad::cli {
namespace {

struct BakeCommand {
  CommonOptions common;
  bake::Options job;
};

void warn_about(const bake::Counts& baked, Console& console) {
  const auto warn = [&](std::int64_t count, const char* what) {
    if (count > 0) console.warn(fmt::format("{} of {} covered texels {}", count, baked.covered, what));
  };
  if (baked.outside > 0)
    console.warn(
        fmt::format("{} triangles reach beyond the unit square of UV set 0; what lies there is not baked",
                    baked.outside));
  warn(baked.overlapping, "lie under more than one triangle; the first triangle is baked");
  warn(baked.singular, "have a tangent frame that cannot be inverted; they are flat in the map");
  warn(baked.clamped, "point below the surface; their steepest slope is baked");
  warn(baked.degenerate,
       "had no interpolated normal or no tangent frame; the triangle's normal stands in, layers without "
       "a frame add nothing");
}

void run(BakeCommand& command) {
  const Size size = parse_size(command.common.size);
  command.job.width = size.width;
  command.job.height = size.height;
  const std::filesystem::path output = command.common.output;
  const image::Depth depth = depth_for(output, command.common.depth, image::Depth::unorm16);
  check_output(output, depth);
  Console console("baking", command.common.quiet);
  const ChosenDevice device(command.common.device);
  command.job.backend = device.backend();
  on_threads(command.common.threads, [&] {
    scene::Scene scene = open_scene(command.common, console.report());
    OutputFile file(output, {size.width, size.height, 3}, depth, command.common.compression);
    const bake::Counts baked = bake::bake_bands(
        std::move(scene), command.job, [&](const image::Image& band) { file.write(band); }, console.report());
    file.commit();
    const ChosenDevice::Filtered filtered = device.filtered();
    if (command.common.json) {
      console.say_json({{"output", output.string()},
                        {"device", device.name()},
                        {"filter", filtered.filter},
                        {"maps_sampled_by_hardware", filtered.sampled},
                        {"filter_bound_deg", filtered.bound_deg},
                        {"width", size.width},
                        {"height", size.height},
                        {"covered_texels", baked.covered},
                        {"triangles_outside", baked.outside},
                        {"overlapping_texels", baked.overlapping},
                        {"singular_texels", baked.singular},
                        {"clamped_texels", baked.clamped},
                        {"degenerate_texels", baked.degenerate}});
      return;
    }
    warn_about(baked, console);
    console.say(fmt::format("wrote {} ({}x{}, {} texels covered)", output.string(), size.width, size.height,
                            baked.covered));
    say_filtered(filtered, console);
  });
}

} // namespace

void add_bake_command(CLI::App& program) {
  auto command = std::make_shared<BakeCommand>();
  CLI::App& verb = *program.add_subcommand("bake", "Bake a stack into one ordinary normal map over UV set 0");
  verb.footer("The map is a MikkTSpace tangent-space normal map, green up: what engines and glTF expect.\n\n"
              "Examples:\n"
              "  surfgrad bake -o demo_normal.png                     the built-in demo\n"
              "  surfgrad bake pirate.json -o pirate_n.png --size 2048\n"
              "  surfgrad bake pirate.json -o pirate_o.exr --space object");
  add_common_options(verb, command->common, "16");
  const std::map<std::string, bake::Space> spaces{
      {"tangent", bake::Space::tangent}, {"object", bake::Space::object}, {"world", bake::Space::world}};
  verb.add_option("--space", command->job.space, "tangent (default), object or world")
      ->transform(one_of(spaces))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
