#include "commands.hpp"
#include "console.hpp"
#include "io/image_file.hpp"
#include "options.hpp"
#include "render/render.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace surfgrad::cli {
namespace {

using View = std::pair<double, double>; // yaw and pitch in degrees

struct RenderCommand {
  CommonOptions common;
  render::Options job;
  std::optional<View> view;
  std::string environment;
};

void require_angles(const View& view) {
  if (!std::isfinite(view.first) || !(std::abs(view.second) <= 90))
    throw CLI::ValidationError("--view", "yaw must be a finite number and pitch one from -90 to 90");
}

void run(RenderCommand& command) {
  const Size size = parse_size(command.common.size);
  command.job.width = size.width;
  command.job.height = size.height;
  const std::filesystem::path output = command.common.output;
  const image::Depth depth = depth_for(output, command.common.depth, image::Depth::unorm8);
  check_output(output, depth);
  Console console("rendering", command.common.quiet);
  const ChosenDevice device(command.common.device);
  command.job.backend = device.backend();
  on_threads(command.common.threads, [&] {
    scene::Scene scene = open_scene(command.common, console.report());
    if (command.view) {
      scene.camera.yaw_deg = command.view->first;
      scene.camera.pitch_deg = command.view->second;
      scene.camera.position.reset();
      scene.camera.target.reset();
    }
    if (!command.environment.empty())
      scene.environment = std::make_shared<image::Image>(io::read_image(command.environment));
    const bool raw = depth == image::Depth::half || depth == image::Depth::float32;
    const render::Aov aov = command.job.aov;
    OutputFile file(output, {size.width, size.height, 3}, depth, command.common.compression);
    const render::Counts picture = render::render_bands(
        std::move(scene), command.job,
        [&](const image::Image& band) { file.write(raw ? band : render::encoded_for_display(band, aov)); },
        console.report());
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
                        {"covered_samples", picture.covered},
                        {"degenerate_samples", picture.degenerate}});
      return;
    }
    if (picture.covered == 0) console.warn("the camera sees no surface");
    if (picture.degenerate > 0)
      console.warn(fmt::format(
          "{} of {} samples had no interpolated normal or no tangent frame; the triangle's normal "
          "stands in, layers without a frame add nothing",
          picture.degenerate, picture.covered));
    console.say(fmt::format("wrote {} ({}x{})", output.string(), size.width, size.height));
    say_filtered(filtered, console);
  });
}

} // namespace

void add_render_command(CLI::App& program) {
  auto command = std::make_shared<RenderCommand>();
  CLI::App& verb = *program.add_subcommand("render", "Render a picture of a stack of bump layers");
  verb.footer("Examples:\n"
              "  surfgrad render -o demo.png                          the built-in demo\n"
              "  surfgrad render pirate.json -o pirate.png --size 2048\n"
              "  surfgrad render model.glb -o n.exr --aov normal      raw world-space normals");
  add_common_options(verb, command->common, "8");
  const std::map<std::string, render::Aov> aovs{{"beauty", render::Aov::beauty},
                                                {"normal", render::Aov::normal},
                                                {"base_normal", render::Aov::base_normal},
                                                {"surfgrad", render::Aov::surfgrad},
                                                {"uv", render::Aov::uv}};
  verb.add_option(
          "--aov", command->job.aov,
          "what to show: beauty (default), normal, base_normal, surfgrad or uv; EXR and float TIFF hold raw\n"
          "values, integer files v/2 + 1/2")
      ->transform(one_of(aovs))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_option("--samples", command->job.samples,
                  "samples along each side of a pixel, for beauty; other pictures take one")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  verb.add_option_function<View>(
          "--view",
          [command](const View& view) {
            require_angles(view);
            command->view = view;
          },
          "look from yaw and pitch in degrees instead of the scene's camera")
      ->type_name("YAW PITCH");
  verb.add_option("--environment", command->environment,
                  "light with this panorama (latitude and longitude: .hdr, .exr, ...) instead of the sky")
      ->check(not_empty())
      ->type_name("FILE");
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
