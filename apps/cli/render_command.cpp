#include "commands.hpp"
#include "console.hpp"
#include "io/image_file.hpp"
#include "options.hpp"
#include "render/render.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <memory>

namespace surfgrad::cli {
namespace {

struct RenderCommand {
  CommonOptions common;
  std::string depth;
  render::Options job;
  std::vector<double> view;
  std::string environment;
};

void run(RenderCommand& command) {
  const Size size = parse_size(command.common.size);
  command.job.width = size.width;
  command.job.height = size.height;
  const std::filesystem::path output = command.common.output;
  const image::Depth depth = depth_for(output, command.depth, image::Depth::unorm8);
  io::check_image_output(output, depth);
  Console console("rendering", command.common.quiet);
  on_threads(command.common.threads, [&] {
    scene::Scene scene = open_scene(command.common);
    if (!command.view.empty()) {
      scene.camera.yaw_deg = command.view[0];
      scene.camera.pitch_deg = command.view[1];
      scene.camera.position.reset();
      scene.camera.target.reset();
    }
    if (!command.environment.empty())
      scene.environment = std::make_shared<image::Image>(io::read_image(command.environment));
    const render::Picture picture = render::render(scene, command.job, console.report());
    const bool raw = depth == image::Depth::half || depth == image::Depth::float32;
    io::write_image(output, raw ? picture.image : render::encoded_for_display(picture, command.job.aov),
                    depth);
    if (command.common.json) {
      console.say(nlohmann::json({{"output", output.string()},
                                  {"width", size.width},
                                  {"height", size.height},
                                  {"covered_samples", picture.covered},
                                  {"degenerate_samples", picture.degenerate}})
                      .dump());
      return;
    }
    if (picture.covered == 0) console.warn("the camera sees no surface");
    if (picture.degenerate > 0)
      console.warn(
          fmt::format("{} of {} samples had no normal or tangent frame; layers that need one are flat there",
                      picture.degenerate, picture.covered));
    console.say(fmt::format("wrote {} ({}x{})", output.string(), size.width, size.height));
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
  add_common_options(verb, command->common);
  const std::map<std::string, render::Aov> aovs{{"beauty", render::Aov::beauty},
                                                {"normal", render::Aov::normal},
                                                {"base_normal", render::Aov::base_normal},
                                                {"surfgrad", render::Aov::surfgrad},
                                                {"uv", render::Aov::uv}};
  verb.add_option(
          "--aov", command->job.aov,
          "what to show: beauty (default), normal, base_normal, surfgrad or uv; EXR and float TIFF hold raw\n"
          "values, integer files v/2 + 1/2")
      ->transform(CLI::CheckedTransformer(aovs).description(""))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_option("--samples", command->job.samples, "samples along each side of a pixel")
      ->capture_default_str()
      ->check(CLI::Range(1, 16));
  verb.add_option("--view", command->view, "look from yaw and pitch in degrees instead of the scene's camera")
      ->expected(2)
      ->type_name("YAW PITCH");
  verb.add_option("--environment", command->environment,
                  "light with this panorama (latitude and longitude: .hdr, .exr, ...) instead of the sky")
      ->type_name("FILE");
  verb.add_option("--depth", command->depth,
                  "8, 16, half or float (default: 8 for PNG and TIFF, float for EXR)")
      ->check(CLI::IsMember({"8", "16", "half", "float"}).description(""))
      ->type_name("BITS");
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
