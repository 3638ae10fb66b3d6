#include "shadergen/shadergen.hpp"

#include "shadergen/declarations.hpp"
#include "shadergen/displace.hpp"
#include "shadergen/generator.hpp"
#include "shadergen/layers/layers.hpp"
#include "shadergen/library.hpp"
#include "shadergen/line_breaks.hpp"
#include "shadergen/parameters.hpp"
#include "shadergen/spelling.hpp"
#include "stack/uses.hpp"

#include <algorithm>
#include <stdexcept>

namespace surfgrad::shadergen {
namespace {

using Role = SurfaceMember::Role;

std::string_view library_name(Language language) {
  switch (language) {
  case Language::hlsl:
    return "surfgrad.hlsl";
  case Language::wgsl:
    return "surfgrad.wgsl";
  case Language::glsl:
  case Language::godot:
    break;
  }
  return "surfgrad.glsl";
}

std::string_view word_of(stack::BackFaces back_faces) {
  switch (back_faces) {
  case stack::BackFaces::mirror:
    return "SURFGRAD_BACK_FACES_MIRROR";
  case stack::BackFaces::flip:
    return "SURFGRAD_BACK_FACES_FLIP";
  case stack::BackFaces::same:
  case stack::BackFaces::cull:
    break;
  }
  return "SURFGRAD_BACK_FACES_SAME";
}

/// The UV set in whose vertex tangents all layers are slopes that add up; -1 if they are not.
int tangents_alone(const std::vector<stack::Layer>& layers, const Options& options) {
  if (options.diagnostics || layers.empty()) return -1;
  int set = -1;
  for (const stack::Layer& layer : layers) {
    const bool fits = std::visit(
        [&](const auto& kind) {
          using Kind = std::decay_t<decltype(kind)>;
          if constexpr (std::is_same_v<Kind, stack::NormalMapLayer> ||
                        std::is_same_v<Kind, stack::DerivativeMapLayer>) {
            const bool first = &layer == &layers.front();
            if (first) set = kind.map.uv;
            return kind.basis == stack::Basis::mikktspace && kind.map.uv == set &&
                   (first || kind.common.blend == stack::Blend::add);
          } else {
            return false;
          }
        },
        layer);
    if (!fits) return -1;
  }
  return set;
}

/// The frame of the first pass.
std::string first_frame(Generator& g) {
  const bool footprint = std::any_of(g.shader().surface.begin(), g.shader().surface.end(),
                                     [](const SurfaceMember& m) { return m.role == Role::dp_dx; });
  const std::string normal = g.surface(Role::normal);
  const std::string dp = footprint ? "s.dp_dx, s.dp_dy" : "vec3(0.0, 0.0, 0.0), vec3(0.0, 0.0, 0.0)";
  const stack::BackFaces back_faces = g.options().back_faces;
  if (back_faces == stack::BackFaces::mirror || back_faces == stack::BackFaces::flip)
    return fmt::format("surfgrad_make_frame__two_sided({}, {}, {}, {})", normal, dp,
                       g.surface(Role::front_facing), word_of(back_faces));
  return footprint ? fmt::format("surfgrad_make_frame({}, {})", normal, dp)
                   : fmt::format("surfgrad_make_frame__normal({})", normal);
}

std::string_view kind_of(const stack::Layer& layer) {
  return std::visit([](const auto& kind) { return std::decay_t<decltype(kind)>::type; }, layer);
}

std::string key_of(const stack::Layer& layer) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (requires { kind.common.key; })
          return kind.common.key;
        else
          return kind.key;
      },
      layer);
}

/// A name as a line comment can hold it: no line ends, and no backslash that would take the next line along.
std::string in_comment(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < ' ' || c == '\\' || c == 0x7f) c = '?';
  return name;
}

/// The names of a layer's files, for a comment.
std::string maps_of(const stack::Layer& layer) {
  stack::Layer copy = layer; // files_of gives what can be changed
  std::string names;
  for (const stack::FileName* file : stack::files_of(copy))
    names += (names.empty() ? "" : ", ") + in_comment(file->path.filename().string());
  return names;
}

/// What a member of the surface is, for whoever fills it.
std::string_view remark_on(Role role) {
  switch (role) {
  case Role::position:
    return "world space, where the surface lies";
  case Role::normal:
    return "world space, interpolated, not normalised";
  case Role::dp_dx:
    return "change of position per pixel along x";
  case Role::dp_dy:
    return "and along y";
  case Role::front_facing:
    return "of an object whose transform mirrors: the opposite";
  case Role::normal_is_absent:
    return "normal stands in for one that interpolation lacks";
  case Role::st:
    return "texture coordinate";
  case Role::dst_dx:
  case Role::dst_dy:
    return "its change per pixel";
  case Role::tangent:
    return "vertex tangent, interpolated, not normalised; w its sign";
  case Role::object_position:
    return "in the object's space, before any displacement";
  case Role::world_position:
    return "world space, before any displacement";
  case Role::world_from_object:
    return "linear part of the object's transform";
  case Role::object_from_world:
    return "its inverse";
  case Role::object_origin:
    return "position of the object's own origin";
  case Role::world_origin:
    return "world position that position is relative to; zero if it is not";
  case Role::to_viewer:
    return "unit; zero where nobody looks";
  case Role::to_sun:
    return "unit; zero without a sun";
  case Role::raster:
    return "pixel coordinate, centres at .5";
  case Role::dn_dx:
    return "change of normal per pixel along x";
  case Role::dn_dy:
    return "and along y";
  case Role::relative_from_screen:
    return "takes (x, y, depth, 1) in pixels to position; zero if no screen";
  case Role::roughness:
    return "between the bumps, perceptual: the root of GGX's or Beckmann's alpha";
  }
  return "";
}

std::string surface_struct(const Shader& shader) {
  std::string text = "// What the stack reads of a surface.\nstruct StackSurface {\n";
  for (const SurfaceMember& m : shader.surface)
    text += fmt::format("  {} {}; // {}\n", m.type, m.name, remark_on(m.role));
  return text + "};\n\n";
}

std::vector<std::string> moved_members(const Shader& shader) {
  std::vector<std::string> names;
  if (!shader.moves) return names;
  for (const SurfaceMember& m : shader.surface)
    if (m.role == Role::position || m.role == Role::st) names.push_back(m.name);
  return names;
}

std::string result_struct(const Shader& shader, const Options& options) {
  std::string text = "struct StackResult {\n  vec3 normal; // unit, world space\n";
  for (const std::string& name : moved_members(shader))
    text += fmt::format("  {} {}; // where the parallax has moved it\n", name == "position" ? "vec3" : "vec2",
                        name);
  if (shader.has_sunlight) text += "  float sunlight; // share of the sun that reaches the point\n";
  if (options.roughness) text += "  float roughness; // with the slopes that minification hides\n";
  if (options.diagnostics)
    text += "  vec3 base_normal; // the mesh's; negated on back faces in modes mirror and flip\n"
            "  bool degenerate; // a normal or a frame that a layer needed did not exist\n";
  return text + "};\n\n";
}

/// The surface with its derivatives across pixels.
std::string derivatives_function(const Shader& shader) {
  const bool godot = shader.language == Language::godot;
  const char* const ddx = godot ? "dFdx" : "SURFGRAD_DDX";
  const char* const ddy = godot ? "dFdy" : "SURFGRAD_DDY";
  std::string lines;
  for (const SurfaceMember& m : shader.surface) {
    const std::string st = fmt::format("s.st{}", m.uv);
    const auto differentiate = [&](const char* function, const std::string& what) {
      lines += fmt::format("  t.{} = {}({});\n", m.name, function, what);
    };
    if (m.role == Role::dp_dx) differentiate(ddx, "s.position");
    if (m.role == Role::dp_dy) differentiate(ddy, "s.position");
    if (m.role == Role::dst_dx) differentiate(ddx, st);
    if (m.role == Role::dst_dy) differentiate(ddy, st);
    if (m.role == Role::dn_dx) differentiate(ddx, "s.normal");
    if (m.role == Role::dn_dy) differentiate(ddy, "s.normal");
  }
  if (lines.empty()) return {};
  // As in the library, which is perhaps not there. Fine where the version has them: coarse ones make blocks.
  const std::string macros = shader.language == Language::glsl ? "#ifndef SURFGRAD_DDX\n"
                                                                 "#ifdef GL_ES\n"
                                                                 "#define SURFGRAD_DDX dFdx\n"
                                                                 "#define SURFGRAD_DDY dFdy\n"
                                                                 "#else\n"
                                                                 "#define SURFGRAD_DDX dFdxFine\n"
                                                                 "#define SURFGRAD_DDY dFdyFine\n"
                                                                 "#endif\n"
                                                                 "#endif\n"
                                                               : "";
  return macros +
         "// A fragment's surface, its derivatives filled in. Call it in uniform control flow.\n"
         "StackSurface stack_with_derivatives(StackSurface s) {\n  StackSurface t = s;\n" +
         lines + "  return t;\n}\n";
}

std::string only_in_fragments(const Shader& shader, const std::string& code) {
  if (code.empty() || shader.language == Language::wgsl || shader.language == Language::godot) return code;
  return "#ifdef SURFGRAD_FRAGMENT\n" + code + "#endif\n";
}

/// The function of the fragment, from where its layers have been written.
std::string fragment_function(Generator& g, const std::string& frame, const Options& options) {
  const Shader& shader = g.shader();
  const std::string normal = g.resolved();
  std::string text = shader.moves
                         ? "StackResult stack_normal(StackSurface surface) {\n  StackSurface s = surface;\n"
                         : "StackResult stack_normal(StackSurface s) {\n";
  if (!g.tangents_alone()) text += fmt::format("  SurfgradFrame frame = {};\n", frame);
  if (options.diagnostics)
    text += "  bool degenerate = s.normal_is_absent || surfgrad_max_abs(frame.normal) == 0.0;\n";
  if (shader.has_sunlight) text += "  float sunlight = 1.0;\n";
  std::string rest = fmt::format("\n  StackResult result;\n  result.normal = {};\n", normal);
  for (const std::string& name : moved_members(shader)) rest += fmt::format("  result.{0} = s.{0};\n", name);
  if (shader.has_sunlight) rest += "  result.sunlight = sunlight;\n";
  if (options.roughness) rest += fmt::format("  result.roughness = {};\n", g.widened_roughness());
  if (options.diagnostics)
    rest += "  result.base_normal = frame.normal;\n  result.degenerate = degenerate;\n";
  // A layer's comment follows an empty line, but at the beginning.
  const std::string body = g.body(rest);
  text += (text.ends_with("{\n") && !body.empty() ? body.substr(1) : body) + rest;
  return "// The normal that the layers make of a surface's.\n" + text + "  return result;\n}\n";
}

/// Everything of the stack's in common code, the library aside.
struct Common {
  std::string structs, code, fragment_only;
};

Common written(const std::vector<stack::Layer>& layers, const Options& options, Shader& shader,
               const std::vector<SurfaceMember>& expected) {
  Generator g(options, shader, expected, tangents_alone(layers, options));
  if (!g.tangents_alone()) static_cast<void>(g.unused_name("frame"));
  static_cast<void>(g.surface(Role::normal));
  if (options.diagnostics) static_cast<void>(g.surface(Role::normal_is_absent));
  if (options.roughness) static_cast<void>(g.surface(Role::roughness));
  for (const stack::Layer& layer : layers) {
    g.begin_layer(key_of(layer), kind_of(layer), maps_of(layer));
    std::visit([&](const auto& kind) { write(kind, g); }, layer);
  }
  const std::string frame = g.tangents_alone() ? "" : first_frame(g);
  const std::string function = fragment_function(g, frame, options);
  const std::string vertex = options.displace != nullptr ? vertex_stage(g, *options.displace) : "";
  shader.displaces = options.displace != nullptr;
  Common common;
  common.structs = surface_struct(shader) + result_struct(shader, options);
  common.code = g.functions() + function + (vertex.empty() ? "" : "\n" + vertex);
  common.fragment_only = derivatives_function(shader);
  return common;
}

std::string comment_block(const Options& options, const Shader& shader, bool differentiates) {
  const std::string file =
      options.document.empty() ? "a stack" : in_comment(options.document.filename().string());
  std::string text = fmt::format("// The bump layers of {0}, written by surfgrad.\n"
                                 "//\n"
                                 "//   {2}Surface s; // what the layers read: fill it in\n"
                                 "//   {2}Result r = {1}_normal(s);\n",
                                 file, shader.name, shader.type_name);
  if (differentiates && (shader.language == Language::glsl || shader.language == Language::hlsl))
    text += fmt::format("//\n// In fragment shaders define SURFGRAD_FRAGMENT before this: "
                        "{}_with_derivatives(s) then gives s its\n"
                        "// derivatives.\n",
                        shader.name);
  return text + "\n";
}

/// The library's part in a text that includes nothing.
std::string inlined_library(const Options& options, std::string_view code) {
  const Library functions(library_text(options.language), options.language);
  // WGSL has no preprocessor, and the engine's own device joins nothing.
  const bool guarded = options.access != TextureAccess::exact && options.language != Language::wgsl;
  std::string text = functions.used_by(code, guarded);
  // Where the whole library stands before, nothing of it is wanted again.
  if (guarded && !text.empty())
    text = fmt::format("// What is called of the library. Guards let standalone files stand in one program.\n"
                       "#ifndef {}\n\n{}#endif\n\n",
                       options.language == Language::hlsl ? "SURFGRAD_HLSL" : "SURFGRAD_GLSL", text);
  if (options.language == Language::glsl)
    text = "#ifdef GL_ES\nprecision highp float;\nprecision highp int;\n#endif\n\n" + text;
  return text;
}

} // namespace

bool is_name(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && text != "surfgrad" && text != "gl" && text[0] >= 'a' && text[0] <= 'z' &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || digit(c); });
}

Shader generate(const std::vector<stack::Layer>& layers, const Options& options) {
  if (!is_name(options.name))
    throw std::invalid_argument("a shader's name is a lower-case letter, then letters and digits");
  if (options.first_binding < 0 || options.group < 0)
    throw std::invalid_argument("a shader's bindings and groups are numbered from 0 on");
  Shader shader;
  const auto fresh = [&] {
    Shader s;
    s.language = options.language;
    s.name = options.name;
    s.type_name = options.name;
    s.type_name[0] = static_cast<char>(s.type_name[0] - 'a' + 'A');
    return s;
  };
  // A parallax moves whatever layers after it read: a first run finds out what that is.
  Shader survey = fresh();
  static_cast<void>(written(layers, options, survey, {}));
  shader = fresh();
  const Common common = written(layers, options, shader, survey.surface);
  number_bindings(shader, options);
  shader.parameter_data = block_data(shader);

  const auto sampler_of = [&](std::string_view texture) {
    const auto found = std::find_if(shader.textures.begin(), shader.textures.end(),
                                    [&](const TextureBinding& t) { return t.name == texture; });
    return found->sampler;
  };
  const bool exact = options.access == TextureAccess::exact;
  const Library support(support_text(), Language::glsl);
  const std::string supporting = support.used_by(common.code + common.structs);
  std::string code = spelled(supporting + common.structs + common.code, options.language, sampler_of);
  if (!common.fragment_only.empty())
    code += "\n" + only_in_fragments(shader, spelled(common.fragment_only, options.language, sampler_of));
  if (exact) {
    const Library sampler(exact_text(), Language::glsl);
    code = sampler.used_by(code) + code;
  }
  code = declarations(shader, options, code) + code;

  const bool inlined = options.standalone || exact || options.language == Language::godot;
  std::string library;
  if (inlined) {
    library = inlined_library(options, code);
  } else if (options.language == Language::wgsl) {
    library = fmt::format("// Needs {}: join it to this file.\n\n", library_name(options.language));
  } else {
    library = fmt::format("#include \"{}\"\n\n", library_name(options.language));
  }
  shader.source = comment_block(options, shader, !common.fragment_only.empty()) + library +
                  with_line_breaks(renamed(code, shader.name, shader.type_name));
  for (TextureBinding& t : shader.textures) {
    t.name = renamed(t.name, shader.name, shader.type_name);
    t.sampler = renamed(t.sampler, shader.name, shader.type_name);
  }
  for (SurfaceMember& m : shader.surface) m.type = type_in(options.language, m.type);
  return shader;
}

} // namespace surfgrad::shadergen
