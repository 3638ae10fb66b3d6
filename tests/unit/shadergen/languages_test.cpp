// Every language gives the engine's normals: the same fragments through engine::compose in double and through
// what was generated, run on a device. Textures hold the files' codes and are filtered by the device (in
// float: the software driver is told so), and the stacks are such that this means the same: what is filtered
// is linear in the codes, and magnified.

#include "engine/compose.hpp"
#include "engine/program.hpp"
#include "gpu/buffer.hpp"
#include "gpu/pipeline.hpp"
#include "gpu/shader.hpp"
#include "gpu/texture.hpp"
#include "image/pyramid.hpp"
#include "stacks.hpp"
#include "support/angle.hpp"
#include "support/images.hpp"
#include "support/temporary_folder.hpp"
#include "support/vulkan.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>

namespace surfgrad::shadergen::test {
namespace {

using Role = SurfaceMember::Role;
using raster::Fragment;
using surfgrad::test::Random;

/// A number as the device has it, too.
double rounded(double v) { return static_cast<float>(v); }
vec2<double> rounded(vec2<double> v) { return {rounded(v.x), rounded(v.y)}; }
vec3<double> rounded(vec3<double> v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }

vec3<double> random_vector(Random& random, double size) {
  return rounded(
      vec3<double>{random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)});
}

/// A fragment as some surface may have it: nothing is collapsed, and no map is minified.
Fragment<double> random_fragment(Random& random) {
  Fragment<double> f{};
  f.normal =
      rounded(random.uniform(0.5, 2) * normalize_or_zero(random_vector(random, 1) + vec3<double>{0, 0, 1.8}));
  const vec3<double> n = normalize_or_zero(f.normal);
  const vec3<double> u = normalize_or_zero(cross(n, random_vector(random, 1) + vec3<double>{1.5, 0, 0}));
  f.dp_dx = rounded(0.01 * (u + 0.3 * random.uniform(-1, 1) * cross(n, u)));
  f.dp_dy = rounded(0.01 * (cross(n, u) + 0.3 * random.uniform(-1, 1) * u));
  f.position = random_vector(random, 1);
  f.object_position = random_vector(random, 1);
  f.front_facing = random.uniform(0, 1) < 0.5;
  f.slots = 2;
  for (raster::UvFragment<double>& uv : f.uvs) {
    uv.st = rounded(vec2<double>{random.uniform(-2, 2), random.uniform(-2, 2)});
    uv.dst_dx = rounded(0.002 * vec2<double>{1, random.uniform(-0.4, 0.4)});
    uv.dst_dy = rounded(0.002 * vec2<double>{random.uniform(-0.4, 0.4), -1});
    uv.footprint_dx = uv.dst_dx;
    uv.footprint_dy = uv.dst_dy;
    uv.tangent = rounded(u + 0.2 * random_vector(random, 1));
    uv.sign = random.uniform(0, 1) < 0.5 ? -1 : 1;
  }
  return f;
}

struct Placed {
  mat3<double> linear{{1.25, 0.25, 0}, {-0.125, 0.75, 0.5}, {0.25, 0, 1.125}}; // exact in float
  vec3<double> shift{0.5, -2, 1};

  [[nodiscard]] engine::Placement placement() const {
    const mat3<double>& m = linear;
    return engine::place({{m.x.x, m.x.y, m.x.z, shift.x},
                          {m.y.x, m.y.y, m.y.z, shift.y},
                          {m.z.x, m.z.y, m.z.z, shift.z},
                          {0, 0, 0, 1}},
                         {0, 0, 0});
  }
};

/// A member of the surface as floats, matrices column by column.
std::vector<double> numbers_of(const SurfaceMember& member, const Fragment<double>& f,
                               const engine::Placement& p) {
  const auto three = [](vec3<double> v) { return std::vector<double>{v.x, v.y, v.z}; };
  const auto columns = [](const mat3<double>& m) {
    return std::vector<double>{m.x.x, m.y.x, m.z.x, m.x.y, m.y.y, m.z.y, m.x.z, m.y.z, m.z.z};
  };
  const vec3<double> origin{p.world_from_object.x.w, p.world_from_object.y.w, p.world_from_object.z.w};
  const raster::UvFragment<double>& uv = f.uvs[static_cast<std::size_t>(std::max(member.uv, 0))];
  switch (member.role) {
  case Role::position:
    return three(f.position);
  case Role::normal:
    return three(f.normal);
  case Role::dp_dx:
    return three(f.dp_dx);
  case Role::dp_dy:
    return three(f.dp_dy);
  case Role::front_facing:
    return {f.front_facing ? 1.0 : 0.0};
  case Role::st:
    return {uv.st.x, uv.st.y};
  case Role::dst_dx:
    return {uv.dst_dx.x, uv.dst_dx.y};
  case Role::dst_dy:
    return {uv.dst_dy.x, uv.dst_dy.y};
  case Role::tangent:
    return {uv.tangent.x, uv.tangent.y, uv.tangent.z, uv.sign};
  case Role::object_position:
    return three(f.object_position);
  case Role::world_position:
    return three(p.linear * f.object_position + origin);
  case Role::world_from_object:
    return columns(p.linear);
  case Role::object_from_world:
    return columns(p.inverse_linear);
  case Role::object_origin:
    return three(origin);
  case Role::world_origin:
    return three({0, 0, 0});
  default:
    throw std::logic_error("the stacks of this test do not read " + member.name);
  }
}

/// How a language spells what stands around the function: a compute shader that reads one buffer of floats
/// and writes another.
struct Frame {
  std::string declarations, before, after;
};

Frame frame_of(const Shader& shader, int count, int stride) {
  const std::string body = fmt::format("  {0}Result r = {1}_normal(s);\n", shader.type_name, shader.name);
  const std::string writes = "  data_out[4 * i] = r.normal.x;\n"
                             "  data_out[4 * i + 1] = r.normal.y;\n"
                             "  data_out[4 * i + 2] = r.normal.z;\n}\n";
  switch (shader.language) {
  case Language::wgsl:
    return {
        "@group(0) @binding(40) var<storage, read> data_in: array<f32>;\n"
        "@group(0) @binding(41) var<storage, read_write> data_out: array<f32>;\n",
        fmt::format(
            "@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{\n"
            "  let i = i32(id.x);\n  if (i >= {}) {{ return; }}\n  let base = i * {};\n  var s: {}Surface;\n",
            count, stride, shader.type_name),
        fmt::format("  let r = {}_normal(s);\n", shader.name) + writes};
  case Language::hlsl:
    return {
        "StructuredBuffer<float> data_in : register(t39);\nRWStructuredBuffer<float> data_out : "
        "register(u40);\n",
        fmt::format("[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {{\n"
                    "  int i = int(id.x);\n  if (i >= {}) return;\n  int base = i * {};\n  {}Surface s;\n",
                    count, stride, shader.type_name),
        body + writes};
  default:
    return {"layout(local_size_x = 64) in;\n"
            "layout(std430, binding = 40) readonly buffer In { float data_in[]; };\n"
            "layout(std430, binding = 41) buffer Out { float data_out[]; };\n",
            fmt::format("void main() {{\n  int i = int(gl_GlobalInvocationID.x);\n  if (i >= {}) return;\n"
                        "  int base = i * {};\n  {}Surface s;\n",
                        count, stride, shader.type_name),
            body + writes};
  }
}

std::size_t side_of(std::size_t numbers) { return numbers == 9 ? 3 : numbers == 16 ? 4 : 0; }

/// The words of a SPIR-V file that `command` makes of a text.
gpu::Spirv made_by(const std::string& command, const std::string& name, const std::string& text) {
  const surfgrad::test::TemporaryFolder folder;
  const std::string file = folder.write(name, text).string();
  const std::string spirv = (folder.path() / "shader.spv").string();
  const std::string whole = fmt::format(fmt::runtime(command), file, spirv) + " > /dev/null";
  if (std::system(whole.c_str()) != 0) throw std::runtime_error(name + " does not compile:\n" + text);
  std::ifstream stream(spirv, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  gpu::Spirv words(bytes.size() / 4);
  std::memcpy(words.data(), bytes.data(), 4 * words.size());
  return words;
}

gpu::Spirv spirv_of(Language language, const std::string& text) {
  if (language == Language::wgsl)
    return made_by("node " SURFGRAD_SOURCE_DIR "/tests/conformance/wgsl.mjs spirv {} {}", "shader.wgsl",
                   text);
  if (language == Language::hlsl) // shifted as HLSL's spaces of registers overlap
    return made_by("glslangValidator -V -D -S comp -e main --target-env vulkan1.1 --shift-texture-binding 1 "
                   "--shift-ssbo-binding 1 "
                   "--shift-sampler-binding 20 {} -o {}",
                   "shader.hlsl", text);
  return gpu::compile({.text = "#version 450\n" + text});
}

class Languages : public surfgrad::test::VulkanTest {
 protected:
  void SetUp() override {
    VulkanTest::SetUp();
    Random random(90210);
    images_["normals"] = surfgrad::test::random_normal_map(random, 8, 8, 0.5);
    images_["slopes"] = surfgrad::test::random_image(random, 8, 8, 3);
    images_["heights"] = surfgrad::test::random_image(random, 8, 8, 3);
    images_["mask"] = surfgrad::test::random_image(random, 4, 4, 3);
  }

  /// Largest angle in degrees between the engine's normals and those of the language.
  double worst_angle(const NamedStack& stack, Language language, TextureOrigin origin) {
    Random random(1511);
    const engine::Placement placement = Placed().placement();
    std::vector<Fragment<double>> fragments;
    for (int i = 0; i < 512; ++i) fragments.push_back(random_fragment(random));

    Options options = options_of(stack, language);
    options.standalone = true;
    options.origin = origin;
    const Shader shader = generate(stack.layers, options);
    std::vector<float> in;
    std::string fills;
    int stride = 0;
    for (const SurfaceMember& member : shader.surface) {
      const std::size_t count = numbers_of(member, fragments[0], placement).size();
      const std::size_t side = language == Language::hlsl ? side_of(count) : 0; // its constructors take rows
      std::string values;
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = side > 0 ? k % side * side + k / side : k;
        values +=
            fmt::format("{}data_in[base + {}]", k > 0 ? ", " : "", static_cast<std::size_t>(stride) + at);
      }
      fills += count > 1               ? fmt::format("  s.{} = {}({});\n", member.name, member.type, values)
               : member.type == "bool" ? fmt::format("  s.{} = {} > 0.5;\n", member.name, values)
                                       : fmt::format("  s.{} = {};\n", member.name, values);
      stride += static_cast<int>(count);
    }
    for (const Fragment<double>& f : fragments)
      for (const SurfaceMember& member : shader.surface)
        for (const double v : numbers_of(member, f, placement)) in.push_back(static_cast<float>(v));
    const Frame frame = frame_of(shader, static_cast<int>(fragments.size()), stride);
    const std::string text = shader.source + frame.declarations + frame.before + fills + frame.after;
    const std::vector<float> out = run(shader, spirv_of(language, text), in, fragments.size());

    const engine::Program program = compiled(stack);
    const BackFaces back_faces = stack.back_faces == stack::BackFaces::flip     ? BackFaces::flip
                                 : stack.back_faces == stack::BackFaces::mirror ? BackFaces::mirror
                                                                                : BackFaces::same;
    double worst = 0;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      const vec3<double> truth = engine::compose(program, fragments[i], back_faces, placement).normal;
      const vec3<double> n{out[4 * i], out[4 * i + 1], out[4 * i + 2]};
      worst = std::max(worst, surfgrad::test::unit_angle(n, truth));
    }
    return worst;
  }

 private:
  engine::Program compiled(const NamedStack& stack) {
    std::vector<raster::UvSlot> slots{{0, true}, {1, true}};
    engine::collect_uv_slots(stack.layers, slots);
    engine::MapLibrary maps(
        [this](const std::filesystem::path& file) -> const image::Image& { return images_.at(file); });
    return engine::compile(stack.layers, slots, maps);
  }

  /// The file's codes, level 0 alone: nothing is minified.
  image::Map codes_of(const stack::FileName& file, bool from_top) const {
    const image::Image& image = images_.at(file.path);
    std::vector<float> texels = image.texels;
    const auto row = static_cast<std::size_t>(image.width) * 3;
    for (std::size_t y = 0; from_top && y < static_cast<std::size_t>(image.height) / 2; ++y)
      std::swap_ranges(texels.begin() + static_cast<std::ptrdiff_t>(y * row),
                       texels.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                       texels.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
    return image::with_pyramid(image::rows_of(texels, image.width, 3), image.width, image.height, 3);
  }

  std::vector<float> run(const Shader& shader, const gpu::Spirv& spirv, const std::vector<float>& in,
                         std::size_t count) {
    const bool hlsl = shader.language == Language::hlsl;
    const bool from_top = shader.source.find(shader.name + "_from_top(") != std::string::npos;
    std::vector<gpu::Binding> bindings{{40}, {41}};
    if (!shader.parameters.empty()) bindings.push_back({0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
    const auto decals_binding = static_cast<std::uint32_t>(shader.decals_binding + (hlsl ? 1 : 0));
    if (shader.decal_count > 0)
      bindings.push_back({decals_binding, shader.decals_in_block ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
                                                                 : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    // A combined descriptor serves as either half, too.
    std::map<std::uint32_t, std::size_t> halves;
    for (std::size_t i = 0; i < shader.textures.size(); ++i) {
      const TextureBinding& t = shader.textures[i];
      halves.emplace(static_cast<std::uint32_t>(t.binding + (hlsl ? 1 : 0)), i);
      if (!t.sampler.empty())
        halves.emplace(static_cast<std::uint32_t>(t.sampler_binding + (hlsl ? 20 : 0)), i);
    }
    for (const auto& [binding, texture] : halves)
      bindings.push_back({binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
    const gpu::ComputePipeline pipeline(device(), spirv, bindings);
    gpu::BoundResources resources(device(), pipeline);
    const gpu::Buffer input = gpu::make_device_buffer(device(), std::as_bytes(std::span(in)));
    const gpu::Buffer output(device(), count * 16, gpu::Residence::result);
    // No normal: a shader that writes nothing is seen.
    std::memset(output.mapped().data(), 0x55, output.mapped().size());
    gpu::Buffer parameters, decals;
    resources.bind(40, input);
    resources.bind(41, output);
    if (!shader.parameters.empty()) {
      parameters = gpu::make_device_buffer(device(), shader.parameter_data);
      resources.bind(0, parameters);
    }
    if (shader.decal_count > 0) {
      decals = gpu::make_device_buffer(device(), shader.decal_data);
      resources.bind(decals_binding, decals);
    }
    const auto sampler = gpu::make_sampler(device(), gpu::Sampling::bilinear, gpu::Addressing::repeat,
                                           gpu::Addressing::repeat);
    std::vector<gpu::Texture> textures;
    for (const TextureBinding& t : shader.textures)
      textures.emplace_back(device(), codes_of(t.files[0], from_top));
    for (const auto& [binding, texture] : halves) resources.bind(binding, textures[texture], sampler.get());
    device().run([&](VkCommandBuffer commands) {
      resources.dispatch(commands, static_cast<std::uint32_t>((count + 63) / 64));
      gpu::barrier_after_writes(commands);
    });
    std::vector<float> out(4 * count);
    std::memcpy(out.data(), output.mapped().data(), 4 * out.size());
    return out;
  }

  std::map<std::filesystem::path, image::Image> images_;
};

/// What all of a language's spellings have a part in, textures aside.
NamedStack volumes() {
  return parsed("volumes", R"({ "surfgrad": 1, "back_faces": "flip", "layers": [
    { "type": "noise", "function": "worley", "frequency": 2.1, "scale": 0.1, "space": "world" },
    { "type": "noise", "function": "ridged", "frequency": 1.53, "scale": 0.05, "offset": [1.1, 2.2, 3.3] },
    { "type": "noise", "method": "perlin1985", "blend": "mix", "opacity": 0.4, "scale": 0.3 },
    { "type": "resolve" },
    { "type": "noise", "function": "fractal_sum", "basis": "simplex", "octaves": 6, "frequency": 1.1, "scale": 0.06 },
    { "type": "noise", "function": "turbulence", "octaves": 3, "power": 1.5, "blend": "mix", "opacity": 0.7 } ] })");
}

NamedStack maps() {
  return parsed("maps", R"({ "surfgrad": 1, "back_faces": "mirror", "layers": [
    { "type": "normal_map", "map": "normals", "filter": "normal", "tile": [3, -2], "rotate": 30 },
    { "type": "normal_map", "map": "normals", "filter": "normal", "scale": 0.5 },
    { "type": "derivative_map", "map": "slopes", "uv": 1, "basis": "derived", "blend": "mix", "range": 0.7, "green": "down",
      "mask": { "map": "mask", "channel": "g", "offset": [0.3, 0.1] } },
    { "type": "resolve" },
    { "type": "derivative_map", "map": "slopes", "range": 0.5, "tiling": "hex" },
    { "type": "height_map", "map": "heights", "height": 0.02, "channel": "b", "uv": 1 },
    { "type": "height_map", "map": "heights", "height": 0.02, "taps": "bicubic", "units": "object" } ] })");
}

NamedStack projections() {
  return parsed("projections", R"({ "surfgrad": 1, "back_faces": "same", "layers": [
    { "type": "planar", "map": "slopes", "content": "derivative", "range": 0.4, "axis": "y", "tile": 0.2 },
    { "type": "triplanar", "map": ["slopes", "heights", "mask"], "content": "derivative", "range": 0.3, "tile": 0.1,
      "space": "world", "blend": "mix", "opacity": 0.6, "convention": { "planes": "golubev" } } ] })");
}

NamedStack decals() {
  return parsed("decals", R"({ "surfgrad": 1, "back_faces": "flip", "layers": [
    { "type": "noise", "frequency": 2, "scale": 0.1, "space": "world" },
    { "type": "decal", "map": "slopes", "content": "derivative", "range": 0.5, "size": 2, "direction": [0.3, 0.2, -1],
      "wrap": "repeat", "space": "object", "mask": { "map": "mask" },
      "instances": [ {}, { "position": [0.4, 0.2, 0.1], "roll": 40, "blend": "mix", "opacity": 0.7 },
                     { "position": [-0.3, 0.1, 0.2], "blend": "replace", "opacity": 0.6 } ] },
    { "type": "decal", "shape": "cone", "map": "mask", "content": "derivative", "range": 0.2, "wrap": "repeat",
      "position": [0, 0, 2], "direction": [0, 0, -1], "depth": 4, "angle": 70 } ] })");
}

TEST_F(Languages, AllGiveTheEnginesNormals) {
  // Some hundred operations in float instead of double, on slopes of about 1: 100 * 2^-23 radians make 0.0007
  // degrees; coordinates of noise and of maps, of magnitude up to 10, bring as much again.
  constexpr double bound = 0.003;
  for (const NamedStack& stack : {volumes(), maps(), projections(), decals()})
    for (const Language language : {Language::glsl, Language::hlsl, Language::wgsl}) {
      // A language of each origin; GLSL has both.
      const TextureOrigin usual =
          language == Language::hlsl ? TextureOrigin::upper_left : TextureOrigin::lower_left;
      const double worst = worst_angle(stack, language, usual);
      std::printf("%s in language %d: worst %.5f degrees, bound %g\n", stack.name.c_str(),
                  static_cast<int>(language), worst, bound);
      EXPECT_LE(worst, bound) << stack.name;
    }
  EXPECT_LE(worst_angle(maps(), Language::glsl, TextureOrigin::upper_left), bound);
}

} // namespace
} // namespace surfgrad::shadergen::test
