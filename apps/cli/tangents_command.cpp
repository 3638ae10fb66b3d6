#include "commands.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "io/file.hpp"
#include "io/model_tangents.hpp"
#include "options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>

namespace surfgrad::cli {
namespace {

struct TangentsCommand {
  std::string model;
  std::string output;
  std::optional<unsigned> uv_set;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

void run(const TangentsCommand& command) {
  {
    const Unbroken probe;
    io::check_glb_output(command.output);
  }
  Console console("making tangents", command.quiet);
  on_threads(command.threads, [&] {
    const std::filesystem::path output = command.output;
    const io::ModelWithTangents model =
        io::add_tangents(command.model, {.uv_set = command.uv_set, .report = console.report()});
    {
      const Unbroken whole_file;
      stop_if_interrupted();
      io::write_file(output, model.glb);
    }
    if (command.json) {
      console.say_json({{"output", output.string()},
                        {"meshes", model.meshes},
                        {"triangles", model.triangles},
                        {"vertices", model.vertices},
                        {"split_vertices", model.split_vertices},
                        {"replaced", model.replaced},
                        {"without_uv", model.without_uv},
                        {"arbitrary_tangents", model.arbitrary_tangents}});
      return;
    }
    console.say(fmt::format("wrote {} (tangents of {} mesh{}, {} triangles, {} vertices, {} of them split)",
                            output.string(), model.meshes, model.meshes == 1 ? "" : "es", model.triangles,
                            model.vertices, model.split_vertices));
  });
}

} // namespace

void add_tangents_command(CLI::App& program) {
  auto command = std::make_shared<TangentsCommand>();
  CLI::App& verb = *program.add_subcommand("tangents", "Write a model with MikkTSpace tangents as glTF");
  verb.footer(
      "Makes the attribute TANGENT of every mesh, in glTF's convention: w is +1 where\n"
      "cross(NORMAL, TANGENT) points up in the texture. Tangents that are there are replaced. They equal\n"
      "those of MikkTSpace's author bit for bit, whatever the number of threads: maps baked by other\n"
      "programs that use MikkTSpace fit. The file to write may be the model itself.\n\n"
      "Of a glTF model all else is kept: nodes, materials, images (which move into the .glb), animations,\n"
      "skins, extensions, extras. What changes: vertices are doubled where their corners need different\n"
      "tangents, those that no triangle uses go, strips and fans become triangles, tangents of morph\n"
      "targets go, meshes without normals get the flat ones of the format. Of an OBJ stay shape, texture\n"
      "coordinates, normals and the materials' names.\n\n"
      "Examples:\n"
      "  surfgrad tangents rock.glb -o rock_tangents.glb\n"
      "  surfgrad tangents rock.obj -o rock.glb               OBJ to glTF, with tangents\n"
      "  surfgrad tangents car.gltf -o car.glb --uv 1         for a map on the second UV set");
  verb.add_option("MODEL", command->model, "model: .glb, .gltf or .obj")->required()->check(not_empty());
  verb.add_option("-o,--output", command->output, "file to write: .glb")
      ->required()
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_option("--uv", command->uv_set,
                  "UV set of every mesh; without it the one that its normal texture uses, else 0")
      ->type_name("N");
  add_job_options(verb, command->threads, command->quiet, command->json);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
