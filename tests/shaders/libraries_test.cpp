/// Every file of shaders/ compiles, without a word from the compiler, as all that it promises to be.

#include "shaders/compilers.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <string>

namespace surfgrad::test {
namespace {

void expect_silence(const Verdict& verdict) {
  EXPECT_TRUE(verdict.accepted) << verdict.messages;
  EXPECT_EQ(verdict.messages, "");
}

// What only callers bring to life: the macros, and a choice among overloads.
const std::string glsl_body = R"(
float height_at(vec2 st) { return st.x * st.y; }
float value_at(vec3 p) { return p.x * p.y + p.z; }
vec4 all_macros(vec4 a) {
  SurfgradParallaxHit hit;
  SURFGRAD_MARCH_PARALLAX(hit, height_at, a.xy, a.zw, 8)
  vec3 g = SURFGRAD_GRADIENT_BY_DIFFERENCES(value_at, a.xyz, 0.01);
  vec3 h = SURFGRAD_GRADIENT_BY_FORWARD_DIFFERENCES(value_at, a.xyz, hit.height, 0.01);
  vec2 slope = surfgrad_derivative_from_normal(a.xy) + surfgrad_derivative_from_normal(a.xyz);
  return vec4(surfgrad_scale_bump(2.0, g + h), surfgrad_max_abs(slope));
}
)";

std::string glsl(const std::string& version, const std::string& stage) {
  const std::string start = "#version " + version + "\n";
  // The guard lets a file be included twice.
  const std::string all = library("surfgrad.glsl") + library("surfgrad.glsl") + glsl_body;
  if (stage == "vert")
    return start + all + "layout(location = 0) in vec4 a;\nvoid main() { gl_Position = all_macros(a); }\n";
  if (stage == "comp")
    return start + all +
           "layout(local_size_x = 64) in;\nlayout(binding = 0) buffer Data { vec4 data[]; };\n"
           "void main() { data[gl_GlobalInvocationID.x] = all_macros(data[gl_GlobalInvocationID.x]); }\n";
  return start + "#define SURFGRAD_FRAGMENT\n" + all + "layout(location = 0) out vec4 colour;\n" +
         (version.ends_with("es") ? "" : "layout(location = 0) ") +
         "in vec4 a;\nvoid main() {\n"
         "  SurfgradFrame frame = surfgrad_make_frame_at(a.xyz, a.yzw, gl_FrontFacing, "
         "SURFGRAD_BACK_FACES_FLIP);\n"
         "  SurfgradTangentFrame t = surfgrad_tangent_basis_at(frame, a.xy);\n"
         "  colour = all_macros(vec4(t.tangent, frame.resolve_sign));\n}\n";
}

TEST(GlslLibrary, CompilesAs450InEveryStage) {
  for (const char* stage : {"vert", "frag", "comp"}) expect_silence(compile_glsl(glsl("450", stage), stage));
}

TEST(GlslLibrary, CompilesAs460InEveryStage) {
  for (const char* stage : {"vert", "frag", "comp"}) expect_silence(compile_glsl(glsl("460", stage), stage));
}

TEST(GlslLibrary, CompilesAsEs300AndEs310) {
  for (const char* version : {"300 es", "310 es"})
    for (const char* stage : {"vert", "frag"}) expect_silence(compile_glsl(glsl(version, stage), stage));
  expect_silence(compile_glsl(glsl("310 es", "comp"), "comp"));
}

// Godot's compiler is not at hand. Its dialect is nearest to GLSL ES 3.00; what it lacks besides is looked
// for.
TEST(GlslLibrary, KeepsToGodotsDialect) {
  const std::string text = library("surfgrad.glsl");
  expect_silence(compile_glsl("#version 300 es\nprecision highp float;\nprecision highp int;\n"
                              "#define SURFGRAD_GODOT\n#define SURFGRAD_FRAGMENT\n" +
                                  text + glsl_body +
                                  "out vec4 colour;\nvoid main() { colour = all_macros(vec4(1.0)); }\n",
                              "frag"));
  // Several members in one declaration, constants of a struct type, matrices of single numbers.
  for (const char* foreign : {"\n  (float|int|uint|vec[234]) [a-z_]+, [a-z_]+", "const Surfgrad",
                              "\\bmat[34]\\([-a-z_0-9]+\\.[xyz0],"}) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, std::regex(foreign))) << found.str();
  }
}

TEST(GlslLibrary, TakesDerivativesInFragmentShadersOnly) {
  const Verdict verdict =
      compile_glsl("#version 450\n#define SURFGRAD_FRAGMENT\n" + library("surfgrad.glsl") +
                       "void main() { gl_Position = vec4(0); }\n",
                   "vert");
  EXPECT_FALSE(verdict.accepted);
}

const std::string hlsl_body = R"(
float height_at(float2 st) { return st.x * st.y; }
float value_at(float3 p) { return p.x * p.y + p.z; }
float4 all_macros(float4 a) {
  SurfgradParallaxHit hit;
  SURFGRAD_MARCH_PARALLAX(hit, height_at, a.xy, a.zw, 8)
  float3 g = SURFGRAD_GRADIENT_BY_DIFFERENCES(value_at, a.xyz, 0.01);
  float3 h = SURFGRAD_GRADIENT_BY_FORWARD_DIFFERENCES(value_at, a.xyz, hit.height, 0.01);
  float2 slope = surfgrad_derivative_from_normal(a.xy) + surfgrad_derivative_from_normal(a.xyz);
  return float4(surfgrad_scale_bump(2.0, g + h), surfgrad_max_abs(slope));
}
)";

TEST(HlslLibrary, CompilesInEveryStage) {
  const std::string all = library("surfgrad.hlsl") + library("surfgrad.hlsl") + hlsl_body;
  expect_silence(compile_hlsl(
      all + "float4 main(float4 a : POSITION) : SV_Position { return all_macros(a); }\n", "vert"));
  expect_silence(compile_hlsl(
      all + "[[vk::binding(0, 0)]] RWStructuredBuffer<float4> data;\n[numthreads(64, 1, 1)]\n"
            "void main(uint3 id : SV_DispatchThreadID) { data[id.x] = all_macros(data[id.x]); }\n",
      "comp"));
  expect_silence(compile_hlsl(
      "#define SURFGRAD_FRAGMENT\n" + all +
          "float4 main(float4 a : TEXCOORD0, bool front : SV_IsFrontFace) : SV_Target {\n"
          "  SurfgradFrame frame = surfgrad_make_frame_at(a.xyz, a.yzw, front, SURFGRAD_BACK_FACES_FLIP);\n"
          "  SurfgradTangentFrame t = surfgrad_tangent_basis_at(frame, a.xy);\n"
          "  return all_macros(float4(t.tangent, frame.resolve_sign));\n}\n",
      "frag"));
}

// glslang forgives what FXC and DXC refuse: a vector constructor with one number, GLSL's types, HLSL 2021.
TEST(HlslLibrary, KeepsToShaderModel5) {
  const std::string text = library("surfgrad.hlsl");
  for (const char* foreign :
       {"\\b(float|int|uint)[234]\\([-+0-9.eu/* ]*\\)", "\\b[iu]?vec[234]\\b", "\\bmat[34]\\b",
        "\\bselect\\(", "\\btemplate\\b", "\\bWave[A-Z]", "\\b(float16|int64|uint64)_t"}) {
    std::smatch found;
    EXPECT_FALSE(std::regex_search(text, found, std::regex(foreign))) << found.str();
  }
}

TEST(WgslLibrary, CompilesInEveryStage) {
  expect_silence(compile_wgsl(library("surfgrad.wgsl") + R"(
@group(0) @binding(0) var<storage, read_write> data: array<vec4f>;
@vertex fn vertex_main(@location(0) a: vec4f) -> @builtin(position) vec4f {
  return vec4f(surfgrad_perlin(a.xyz).gradient, 1.0);
}
@compute @workgroup_size(64) fn compute_main(@builtin(global_invocation_id) id: vec3u) {
  let a = data[id.x];
  var march = surfgrad_march_parallax_begin(a.xy, a.zw, 8);
  while (surfgrad_march_parallax_asks(march)) {
    let st = surfgrad_march_parallax_at(march);
    march = surfgrad_march_parallax_answer(march, st.x * st.y);
  }
  let hit = surfgrad_march_parallax_end(march);
  data[id.x] = vec4f(hit.texture_coordinate, hit.height, f32(hit.hit));
}
@fragment fn fragment_main(@location(0) a: vec4f, @builtin(front_facing) front: bool) -> @location(0) vec4f {
  let frame = surfgrad_make_frame_at_two_sided(a.xyz, a.yzw, front, SURFGRAD_BACK_FACES_FLIP);
  let t = surfgrad_tangent_basis_at(frame, a.xy);
  return vec4f(surfgrad_resolve_normal(frame, surfgrad_from_tbn(a.xy, t.tangent, t.bitangent)), 1.0);
}
)"));
}

const std::string wgsl_textures = R"(
@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var linear_wrap: sampler;
)";

// Derivatives are taken first; then the functions may be called where pixels part ways, and after that the
// flow is uniform again: a sample with implicit derivatives is in order.
TEST(WgslLibrary, MayBeCalledWherePixelsPartWays) {
  expect_silence(compile_wgsl(library("surfgrad.wgsl") + wgsl_textures + R"(
@fragment fn main(@location(0) p: vec3f, @location(1) n: vec3f, @location(2) st: vec2f) -> @location(0) vec4f {
  let dst_dx = dpdx(st);
  let dst_dy = dpdy(st);
  let frame = surfgrad_make_frame(n, dpdx(p), dpdy(p));
  var g = vec3f(0.0);
  if (st.x > 0.5) {
    let m = textureSampleGrad(map, linear_wrap, st, dst_dx, dst_dy).xyz;
    let t = surfgrad_tangent_basis(frame, dst_dx, dst_dy);
    g = surfgrad_from_tbn(surfgrad_derivative_from_normal(2.0 * m - 1.0), t.tangent, t.bitangent);
    let noise = surfgrad_fractal_sum(p, SurfgradFractal(4, 2.0, 0.5), 0.0, SURFGRAD_BASIS_WORLEY_F1);
    g += surfgrad_from_volume_gradient(frame.normal, noise.gradient);
    let box = surfgrad_box_decal(SurfgradDecalFrame(vec3f(0.0), n, n, n), p, vec3f(1.0), 0.1);
    g += surfgrad_from_decal(frame.normal, st, box.axis_s, box.axis_t);
  }
  let after = textureSample(map, linear_wrap, st).x;
  return vec4f(after * surfgrad_resolve_normal(frame, g), 1.0);
}
)"));
}

// A compiler looks at what an entry point calls: this looks at all functions.
TEST(WgslLibrary, TakesDerivativesInTheLastSectionOnly) {
  const std::string text = library("surfgrad.wgsl");
  const std::size_t last = text.find("// Derivatives across pixels");
  ASSERT_NE(last, std::string::npos);
  static const std::regex derivative("\\b(dpdx|dpdy|fwidth)(Fine|Coarse)?\\(");
  std::smatch found;
  const std::string before = text.substr(0, last);
  EXPECT_FALSE(std::regex_search(before, found, derivative)) << found.str();
  EXPECT_TRUE(std::regex_search(text, derivative));
}

TEST(WgslLibrary, DerivativesWantUniformFlowAndTheValidatorSeesIt) {
  const Verdict verdict = compile_wgsl(library("surfgrad.wgsl") + R"(
@fragment fn main(@location(0) p: vec3f, @location(1) n: vec3f) -> @location(0) vec4f {
  if (p.x > 0.5) { return vec4f(surfgrad_make_frame_at(p, n).sigma_x, 1.0); }
  return vec4f(0.0);
}
)");
  EXPECT_FALSE(verdict.accepted);
  EXPECT_NE(verdict.messages.find("uniform control flow"), std::string::npos) << verdict.messages;
}

} // namespace
} // namespace surfgrad::test
