#include "stacks.hpp"

#include <regex>

namespace surfgrad::shadergen::test {

NamedStack parsed(const std::string& name, std::string_view document) {
  stack::Stack stack = stack::parse_stack(document, name + ".json");
  return {name, std::move(stack.layers), stack.back_faces.value_or(stack::BackFaces::flip),
          std::move(stack.displace)};
}

NamedStack one_normal_map() {
  return parsed("bricks",
                R"({ "surfgrad": 1, "layers": [ { "type": "normal_map", "map": "bricks_n.png" } ] })");
}

NamedStack two_passes() {
  return parsed("torus", R"({ "surfgrad": 1, "layers": [
    { "type": "normal_map", "map": "plates_n.png", "tile": [4, 2] },
    { "type": "normal_map", "map": "weave_n.png", "uv": 1, "basis": "derived", "blend": "mix",
      "mask": { "map": "stripes.png", "channel": "g" } },
    { "type": "resolve" },
    { "type": "normal_map", "map": "weave_n.png", "uv": 1, "basis": "derived", "tile": 3, "rotate": 30, "scale": 0.12 },
    { "type": "noise", "function": "turbulence", "frequency": 4, "power": 3, "scale": -0.03 } ] })");
}

std::vector<NamedStack> every_kind() {
  return {one_normal_map(),
          two_passes(),
          parsed("slopes", R"({ "surfgrad": 1, "back_faces": "mirror", "layers": [
        { "type": "normal_map", "map": "a.png", "filter": "bilinear", "green": "down" },
        { "type": "normal_map", "map": "b.png", "channels": "xy", "rotate": 20, "offset": [0.1, 0.2] },
        { "type": "derivative_map", "map": "c.png", "neutral": "whole", "range": 2 } ] })"),
          parsed("tiles", R"({ "surfgrad": 1, "back_faces": "same", "layers": [
        { "type": "normal_map", "map": "a.png", "tiling": "hex", "tile": [3, -2], "filter": "anisotropic" },
        { "type": "derivative_map", "map": "b.png", "basis": "derived", "blend": "mix", "opacity": 0.5,
          "mask": { "map": "m.png", "tiling": "hex" } } ] })"),
          parsed("heights", R"({ "surfgrad": 1, "layers": [
        { "type": "height_map", "map": "h.png", "taps": "bicubic", "tiling": "hex" },
        { "type": "height_map", "map": "h.png", "taps": "one", "filter": "nearest", "units": "object" },
        { "type": "height_map", "map": "h.png", "height": 0.1, "channel": "a" },
        { "type": "resolve" },
        { "type": "height_map", "map": "h.png", "mode": "scale_free", "height": 0.1, "taps": "bicubic", "wrap": "clamp" },
        { "type": "height_map", "map": "h.png", "mode": "scale_free", "tiling": "hex", "basis": "mikktspace" } ] })"),
          parsed("space", R"({ "surfgrad": 1, "back_faces": "mirror", "layers": [
        { "type": "object_normal_map", "map": "o.png", "blend": "mix", "opacity": 0.5, "green": "down" },
        { "type": "noise", "function": "worley", "worley": "f2_minus_f1", "space": "world", "method": "perlin1985" },
        { "type": "noise", "function": "ridged", "basis": "simplex", "offset": [1, 2, 3] },
        { "type": "planar", "map": "p.png", "axis": "y", "content": "height", "height": 0.02 },
        { "type": "triplanar", "map": ["a.png", "b.png", "c.png"], "space": "world", "sharpness": 8 },
        { "type": "triplanar", "map": "o.png", "content": "object_normal", "convention": { "planes": "golubev" } } ] })"),
          parsed("decals", R"({ "surfgrad": 1, "back_faces": "same", "layers": [
        { "type": "normal_map", "map": "n.png" },
        { "type": "decal", "map": "rivet_n.png", "space": "object", "instances": [
          { "position": [0.3, 0.5, 0], "direction": [-1, 0, 0] },
          { "position": [-0.3, 0.5, 0], "direction": [1, 0, 0], "roll": 45, "opacity": 0.5, "blend": "replace" },
          { "blend": "mix" } ] },
        { "type": "decal", "shape": "cone", "map": "crack_h.png", "content": "height", "height": 0.02, "blend": "mix",
          "mask": { "map": "m.png" } },
        { "type": "decal", "shape": "wedge", "map": "crack_d.png", "content": "derivative", "gradient": "scale_free" },
        { "type": "decal", "shape": "capsule", "map": "crater.exr", "blend": "replace" },
        { "type": "decal", "shape": "sphere", "map": "crater.exr" } ] })"),
          parsed("relief", R"({ "surfgrad": 1,
        "displace": { "function": "fractal_sum", "frequency": 2, "height": 0.1 },
        "layers": [
          { "type": "parallax", "map": "h.png", "self_shadow": true, "facing": "reflect", "tile": 2 },
          { "type": "normal_map", "map": "n.png", "uv": 1 },
          { "type": "noise", "function": "simplex", "space": "world" } ] })"),
          parsed("offset", R"({ "surfgrad": 1,
        "displace": { "map": { "map": "h.png", "tile": [4, 2] }, "level": 0.5, "height": 0.03 },
        "layers": [
          { "type": "parallax", "map": "h.png", "method": "offset", "limit_offset": true, "lod": "displaced",
            "normal": "none", "curvature": false, "mask": { "map": "m.png" } },
          { "type": "normal_map", "map": "n.png" } ] })"),
          parsed("nothing", R"({ "surfgrad": 1, "layers": [] })")};
}

std::string as_glsl_es(const std::string& godot) {
  std::string code = std::regex_replace(godot, std::regex("(\nuniform [^;:=]*)[:=][^;]*;"), "$1;");
  code = std::regex_replace(code, std::regex("\nuniform (sampler2D|samplerCube)"), "\nuniform highp $1");
  return "precision highp float;\nprecision highp int;\n" + code;
}

Options options_of(const NamedStack& stack, Language language) {
  Options options;
  options.language = language;
  options.name = stack.name;
  options.back_faces = stack.back_faces;
  options.displace = stack.displace ? &*stack.displace : nullptr;
  options.document = stack.name + ".json";
  return options;
}

} // namespace surfgrad::shadergen::test
