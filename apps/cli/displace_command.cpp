#include "commands.hpp"
#include "console.hpp"
#include "diagnostic/error.hpp"
#include "displace/scene.hpp"
#include "interrupt.hpp"
#include "io/extension.hpp"
#include "io/model_file.hpp"
#include "options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace surfgrad::cli {
namespace {

struct DisplaceCommand {
  std::string scene; // empty: the built-in demo
  std::string output;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

/// What the demo is displaced by: shallow enough for its tube of radius 0.45.
stack::Displace demo_displacement() {
  stack::Displace displace;
  displace.noise.function = stack::NoiseKind::fractal_sum;
  displace.noise.frequency = 3;
  displace.height = 0.1;
  return displace;
}

scene::Scene scene_of(const DisplaceCommand& command, const Report& report) {
  if (command.scene.empty()) {
    scene::Scene demo = scene::demo_scene();
    demo.displace = demo_displacement();
    return demo;
  }
  scene::Scene scene = scene::load_scene(command.scene, report.at_the_start());
  if (scene.displace) return scene;
  const std::string block = R"("displace": { "function": "fractal_sum", "frequency": 2, "height": 0.05 })";
  if (io::lower_extension(command.scene) == ".json")
    throw InputError(
        {.file = command.scene, .problem = R"(has no "displace")", .remedy = "add e.g. " + block});
  throw InputError({.file = command.scene,
                    .problem = "is a model, which cannot say how to displace it",
                    .remedy = fmt::format(R"(write a stack document: {{ "surfgrad": 1, "mesh": "{}", {} }})",
                                          std::filesystem::path(command.scene).filename().string(), block)});
}

io::Model model_of(scene::Scene scene) {
  io::Model model;
  model.meshes = std::move(scene.meshes);
  for (scene::Object& object : scene.objects)
    model.objects.push_back({std::move(object.name), object.mesh, object.world_from_object});
  for (scene::Material& material : scene.materials)
    model.materials.push_back(
        {.name = std::move(material.name), .double_sided = material.back_faces != stack::BackFaces::cull});
  return model;
}

void run(const DisplaceCommand& command) {
  {
    const Unbroken probe;
    io::check_model_output(command.output);
  }
  Console console("displacing", command.quiet);
  on_threads(command.threads, [&] {
    const scene::Scene scene = scene_of(command, console.report());
    stop_if_interrupted();
    const std::filesystem::path output = command.output;
    displace::DisplacedScene displaced = *displace::displaced(scene, console.report());
    const io::Model model = model_of(std::move(displaced.scene));
    {
      const Unbroken whole_file;
      stop_if_interrupted();
      io::write_model(output, model);
    }
    if (command.json) {
      console.say_json({{"output", output.string()},
                        {"vertices", displaced.vertices},
                        {"triangles", displaced.triangles},
                        {"lowest", displaced.lowest},
                        {"highest", displaced.highest},
                        {"joined_places", displaced.joined_places},
                        {"parted_places", displaced.parted_places}});
      return;
    }
    console.say(fmt::format("wrote {} ({} vertices, {} triangles, heights from {:.4g} to {:.4g})",
                            output.string(), displaced.vertices, displaced.triangles, displaced.lowest,
                            displaced.highest));
    if (displaced.joined_places > 0)
      console.say(
          fmt::format("{} places at seams and hard edges moved together, so that the mesh stays closed",
                      displaced.joined_places));
  });
}

} // namespace

void add_displace_command(CLI::App& program) {
  auto command = std::make_shared<DisplaceCommand>();
  CLI::App& verb = *program.add_subcommand("displace", "Displace the mesh of a stack and write it as glTF");
  verb.footer(
      "The stack document says how, in its \"displace\" block:\n"
      "  { \"surfgrad\": 1, \"mesh\": \"rock.glb\",\n"
      "    \"displace\": { \"function\": \"fractal_sum\", \"frequency\": 2, \"height\": 0.05,\n"
      "                  \"subdivide\": 2, \"edges\": \"curved\" } }\n"
      "Heights are in the mesh's units. A height map works too: \"map\": { \"map\": \"rock_h.png\" }.\n"
      "New normals come from the exact gradient. Seams and hard edges stay closed. Tangents are left\n"
      "out: whoever reads the file makes MikkTSpace ones. Materials keep their names, not their maps.\n"
      "render and bake displace the same mesh by themselves: bake gives the normal map that fits it.\n\n"
      "Examples:\n"
      "  surfgrad displace -o demo.glb                        the built-in demo, by a noise\n"
      "  surfgrad displace rock.json -o rock_displaced.glb\n"
      "  surfgrad bake rock.json -o rock_n.png                finer bumps, for that mesh");
  verb.add_option("SCENE", command->scene,
                  "stack document (.json) with a \"displace\" block; without it the built-in demo")
      ->check(not_empty());
  verb.add_option("-o,--output", command->output, "file to write: .glb, or .gltf with all inside")
      ->required()
      ->check(not_empty())
      ->type_name("FILE");
  add_job_options(verb, command->threads, command->quiet, command->json);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
