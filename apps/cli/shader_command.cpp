#include "commands.hpp"
#include "console.hpp"
#include "diagnostic/error.hpp"
#include "image/map.hpp"
#include "interrupt.hpp"
#include "io/file.hpp"
#include "options.hpp"
#include "shadergen/shadergen.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

namespace surfgrad::cli {
namespace {

/// What the code is for: the languages, and GLSL twice.
enum class Target { glsl, glsl_es, hlsl, wgsl, godot };

shadergen::Language language_of(Target target) {
  switch (target) {
  case Target::hlsl:
    return shadergen::Language::hlsl;
  case Target::wgsl:
    return shadergen::Language::wgsl;
  case Target::godot:
    return shadergen::Language::godot;
  case Target::glsl:
  case Target::glsl_es:
    break;
  }
  return shadergen::Language::glsl;
}

struct ShaderCommand {
  std::string scene; // empty: the built-in demo
  std::string output;
  std::string material;
  Target target = Target::glsl;
  shadergen::Options job;
  std::optional<TextureOrigin> origin;
  bool quiet = false;
  bool json = false;
};

/// Where texture coordinates begin where the language is at home.
TextureOrigin usual_origin(shadergen::Language language) {
  return language == shadergen::Language::glsl ? TextureOrigin::lower_left : TextureOrigin::upper_left;
}

/// The material that the user names, or the only one that has layers.
const scene::Material& material_of(const scene::Scene& scene, const ShaderCommand& command) {
  std::vector<const scene::Material*> bumped;
  for (const scene::Material& material : scene.materials) {
    if (!command.material.empty() && material.name == command.material) return material;
    if (!material.layers.empty()) bumped.push_back(&material);
  }
  const auto& candidates = scene.materials;
  std::vector<std::string> names;
  for (const scene::Material& material : candidates) names.push_back("\"" + material.name + "\"");
  if (!command.material.empty())
    throw InputError({.file = scene.source,
                      .problem = fmt::format("has no material \"{}\"", command.material),
                      .remedy = fmt::format("expected --material {}", fmt::join(names, " or "))});
  if (bumped.size() == 1) return *bumped.front();
  if (candidates.size() == 1) return candidates.front();
  throw InputError({.file = scene.source,
                    .problem = fmt::format("has {} materials with layers", bumped.size()),
                    .remedy = fmt::format("choose one: --material {}", fmt::join(names, " or "))});
}

shadergen::FileFacts facts_of(const image::Image& image) {
  shadergen::FileFacts facts;
  facts.codes = image.depth == image::Depth::unorm8    ? shadergen::Codes::unorm8
                : image.depth == image::Depth::unorm16 ? shadergen::Codes::unorm16
                                                       : shadergen::Codes::floats;
  if (image.channels < 2) return facts; // no vectors
  const image::NormalChannels channels =
      image::make_slope_map(image, image::NormalChannels::automatic, true).channels;
  facts.channels = channels == image::NormalChannels::xy ? stack::Channels::xy : stack::Channels::xyz;
  return facts;
}

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

void run(const ShaderCommand& command) {
  const std::filesystem::path output = command.output;
  std::filesystem::path beside = output;
  beside += ".json";
  {
    const Unbroken probe;
    io::check_writable(output);
    io::check_writable(beside);
  }
  Console console("generating", command.quiet);
  const scene::Scene scene = [&] {
    CommonOptions source;
    source.scene = command.scene;
    return open_scene(source, console.report());
  }();
  check_is_no_input(scene, output, "-o");
  check_is_no_input(scene, beside, "-o");
  const scene::Material& material = material_of(scene, command);
  shadergen::Options job = command.job;
  job.language = language_of(command.target);
  job.es = command.target == Target::glsl_es;
  job.back_faces = material.back_faces;
  job.origin = command.origin.value_or(usual_origin(job.language));
  job.displace = scene.displace ? &*scene.displace : nullptr;
  job.document = scene.source;
  std::map<std::filesystem::path, shadergen::FileFacts> facts; // asked for more than once
  job.facts_of = [&](const stack::FileName& file) {
    const auto [known, is_new] = facts.try_emplace(file.path);
    if (is_new) known->second = facts_of(scene.image(file.path));
    return known->second;
  };
  const shadergen::Shader shader = shadergen::generate(material.layers, job);
  const std::string manifest = shadergen::manifest(shader);
  {
    const Unbroken whole_files;
    stop_if_interrupted();
    io::OutputFile code(output), bindings(beside);
    code.write(bytes_of(shader.source));
    bindings.write(bytes_of(manifest));
    code.finish();
    bindings.finish();
    code.commit();
    bindings.commit();
  }
  if (!shader.beyond_es.empty()) console.warn(shader.beyond_es);
  const auto lines = std::count(shader.source.begin(), shader.source.end(), '\n');
  if (command.json) {
    nlohmann::json warnings = nlohmann::json::array();
    if (!shader.beyond_es.empty()) warnings.push_back(shader.beyond_es);
    console.say_json({{"output", output.string()},
                      {"bindings", beside.string()},
                      {"function", shader.name + "_normal"},
                      {"lines", lines},
                      {"textures", shader.textures.size()},
                      {"parameters", shader.parameters.size()},
                      {"decals", shader.decal_count},
                      {"warnings", warnings}});
    return;
  }
  console.say(fmt::format("wrote {} ({} lines: {}_normal; {} textures, {} parameters) and {}",
                          output.string(), lines, shader.name, shader.textures.size(),
                          shader.parameters.size(), beside.string()));
}

/// Standard output has no place for the second file.
CLI::Validator file_name() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        return text == "-" ? "two files are written: give the name of one" : "";
      },
      "");
}

CLI::Validator identifier() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        if (shadergen::is_name(text)) return {};
        return fmt::format("\"{}\" is not a lower-case letter followed by letters and digits, or is taken",
                           text);
      },
      "");
}

} // namespace

void add_shader_command(CLI::App& program) {
  auto command = std::make_shared<ShaderCommand>();
  CLI::App& verb =
      *program.add_subcommand("shader", "Write a stack as a shader function: GLSL, HLSL, WGSL or Godot");
  verb.footer(
      "FILE gets one function, stack_normal: give it what the layers read of a surface, it gives the "
      "normal.\n"
      "FILE.json says what to bind: textures with their maps and samplers, the parameters' values and\n"
      "offsets. Scale, opacity, tiling and the like are uniforms; what a stack leaves at its default is "
      "none.\n"
      "The code includes surfgrad.glsl, .hlsl or .wgsl; --standalone writes the functions it uses "
      "instead.\n"
      "Files with other names, first bindings or groups stand in one program, standalone ones too (not "
      "WGSL's).\n\n"
      "Texture coordinates begin at the lower left in GLSL and at the upper left elsewhere, unless --origin\n"
      "says otherwise (Unity: lower_left; glTF in three.js: upper_left).\n\n"
      "Examples:\n"
      "  surfgrad shader --lang glsl --standalone -o demo.glsl     the built-in demo\n"
      "  surfgrad shader rock.json --lang hlsl -o rock.hlsl\n"
      "  surfgrad shader figure.json --lang wgsl --material skin --name skin -o skin.wgsl");
  verb.add_option("SCENE", command->scene,
                  "stack document (.json) or model (.gltf, .glb, .obj); without it the built-in demo")
      ->check(not_empty());
  verb.add_option("-o,--output", command->output, "file to write; FILE.json is written beside it")
      ->required()
      ->check(not_empty())
      ->check(file_name())
      ->type_name("FILE");
  const std::map<std::string, Target> targets{{"glsl", Target::glsl},
                                              {"glsl_es", Target::glsl_es},
                                              {"hlsl", Target::hlsl},
                                              {"wgsl", Target::wgsl},
                                              {"godot", Target::godot}};
  verb.add_option("--lang", command->target,
                  "glsl (450 and ES 3.00), glsl_es (the same, sure to be ES 3.00's), hlsl (shader model 5),\n"
                  "wgsl or godot (4.5)")
      ->required()
      ->transform(one_of(targets))
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_flag("--standalone", command->job.standalone, "write the library functions that are used, too");
  verb.add_flag("--roughness", command->job.roughness,
                "take the surface's roughness, too, and give it with the slopes that distance hides");
  verb.add_option("--name", command->job.name, "begins every name in the code")
      ->capture_default_str()
      ->check(identifier())
      ->type_name("NAME");
  verb.add_option("--material", command->material, "whose layers, where the scene has several materials")
      ->check(not_empty())
      ->type_name("NAME");
  const std::map<std::string, TextureOrigin> origins{{"lower_left", TextureOrigin::lower_left},
                                                     {"upper_left", TextureOrigin::upper_left}};
  verb.add_option("--origin", command->origin, "where texture coordinates begin: lower_left or upper_left")
      ->transform(one_of(origins))
      ->type_name("NAME")
      ->option_text("NAME");
  constexpr int most_bindings = 999, most_groups = 31; // WebGPU's largest binding; groups beyond any device's
  CLI::Option* const first = verb.add_option("--first-binding", command->job.first_binding,
                                             "number of the first binding: in HLSL of each kind of register")
                                 ->capture_default_str()
                                 ->check(CLI::Range(0, most_bindings).description(""))
                                 ->type_name("N");
  CLI::Option* const group =
      verb.add_option("--group", command->job.group, "WGSL's group, HLSL's space, in Vulkan's GLSL the set")
          ->capture_default_str()
          ->check(CLI::Range(0, most_groups).description(""))
          ->type_name("N");
  verb.add_flag("-q,--quiet", command->quiet, "no warnings or summary (but --json)");
  verb.add_flag("--json", command->json, "summary as one line of JSON, even with --quiet");
  verb.callback([command, first, group] {
    if (command->target == Target::godot && (!first->empty() || !group->empty()))
      throw CLI::ValidationError(first->empty() ? "--group" : "--first-binding", "Godot numbers no bindings");
    run(*command);
  });
}

} // namespace surfgrad::cli
