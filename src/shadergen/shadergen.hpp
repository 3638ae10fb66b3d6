#pragma once

/// A stack as shader code: readable functions that call the shader library (shaders/surfgrad.*).
///
/// The code has one function for the fragments of a material,
///
///   StackResult stack_normal(StackSurface s)
///
/// StackSurface holds what the stack reads of a surface and nothing else (Shader::surface lists its
/// members), StackResult the normal and, after a parallax, what has moved. `stack` and `Stack` are
/// Options::name. The numbers of the layers are members of a uniform block, the maps textures.

#include "stack/stack.hpp"

#include <surfgrad/frame.hpp>
#include <surfgrad/triplanar.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::shadergen {

enum class Language {
  glsl, ///< 450 and ES 3.00 alike
  hlsl, ///< shader model 5.0
  wgsl,
  godot, ///< Godot 4.5 and newer; always standalone
};

/// How maps are read.
enum class TextureAccess {
  /// Ordinary textures, as their files hold them, through the hardware's filters.
  hardware,
  /// The engine's own texels and pyramids out of a buffer, filtered as the CPU engine filters them. GLSL 450
  /// only: see ExactLayout.
  exact,
};

/// Which of a layer's maps is meant.
struct MapSite {
  std::size_t layer = 0; ///< place in the list of layers
  bool mask = false;     ///< its mask, else a map of its bumps
};

struct TextureBinding;

/// What integer codes of a file mean, where a layer's decoding depends on their number.
enum class Codes { unorm8, unorm16, floats };

/// What the generator wants to know of a file that it never opens.
struct FileFacts {
  stack::Channels channels = stack::Channels::xyz; ///< what Channels::automatic comes to
  Codes codes = Codes::unorm8;
};

struct Options {
  Language language = Language::glsl;
  bool es = false; ///< glsl: what ES 3.00 cannot express is refused, too; else Shader::beyond_es names it
  TextureAccess access = TextureAccess::hardware;
  std::string name = "stack"; ///< begins every identifier: a lower-case letter, then letters and digits
  bool standalone = false;    ///< the library functions that are used stand in the text itself
  stack::BackFaces back_faces = stack::BackFaces::flip; ///< cull: as same
  /// Where texture coordinates and textures begin. lower_left: t runs up and textures are uploaded bottom row
  /// first, as OpenGL does and this project; upper_left: both the other way round. hardware only.
  TextureOrigin origin = TextureOrigin::lower_left;
  /// StackResult has base_normal and degenerate, too: what engine::Composition has.
  bool diagnostics = false;
  /// exact: which maps hardware filters all the same, out of textures with the engine's own texels; absent:
  /// none. Asked only of maps that it can filter as the engine does (TextureBinding::sampled), several times.
  std::function<bool(const MapSite&, const TextureBinding&)> samples{};
  /// hardware: StackSurface has the roughness of the surface between the bumps, StackResult what minification
  /// makes of it. Maps of three channels and of filters with mip levels contribute, by how much shorter their
  /// filtered normals are; of all others nothing is known.
  bool roughness = false;
  int march_steps = 64;  ///< hardware: of the linear search of a parallax
  int first_binding = 0; ///< hardware: the first number of every kind of binding that the language counts
  int group = 0;         ///< hardware: WGSL's group, HLSL's space (from 1 on: shader model 5.1), Vulkan's set
  /// Absent: every file is as FileFacts says.
  std::function<FileFacts(const stack::FileName&)> facts_of{};
  const stack::Displace* displace = nullptr; ///< adds the vertex stage where there is one
  /// For messages.
  std::filesystem::path document{};
};

/// What the texels that a layer reads mean: one for each kind of map that the engine makes of a file.
enum class MapKind {
  slopes,        ///< tangent-space normal map; exact: image::make_slope_map
  normals,       ///< the same, filtered as it is encoded; exact: image::make_encoded_map
  derivatives,   ///< image::make_derivative_map
  heights,       ///< image::make_height_map
  height_slopes, ///< hardware: the heights themselves; exact: image::make_height_slopes
  directions,    ///< image::make_direction_map
  weights,       ///< image::make_channel_map
  relief,        ///< heights in [0, 1]; exact: image::make_two_sided_field of make_channel_map
  cube,          ///< image::make_cube_map
};

/// A map that the code reads.
struct TextureBinding {
  std::string name{};    ///< of the texture in the code
  int binding = 0;       ///< of the texture; in `exact` access the index of its (first) ExactMap
  std::string sampler{}; ///< of its sampler, in languages that have them apart
  int sampler_binding = 0;
  /// exact: the texture `name` holds the map's texels and levels, and hardware filters it: by the engine's
  /// level of detail, at coordinates within one period. Never set of reliefs, cube maps, heights of which
  /// differences are taken, encoded normals, and anisotropic filters.
  bool sampled = false;
  MapKind kind = MapKind::slopes;
  std::vector<stack::FileName> files{}; ///< one; six for a cube map of six files
  std::vector<std::string> layers{};    ///< keys of the layers that read it, e.g. `layers[2].mask`
  int uv = -1;                          ///< texture coordinate set; -1: projected
  stack::Wrap wrap_s = stack::Wrap::repeat, wrap_t = stack::Wrap::repeat;
  stack::Filter filter = stack::Filter::trilinear;
  int anisotropy = 1;                                    ///< most probes
  stack::Channels channels = stack::Channels::automatic; ///< slopes, normals; hardware: never automatic
  stack::Green green = stack::Green::up;                 ///< slopes, normals, derivatives, directions
  stack::DerivativeCode code{};                          ///< derivatives
  stack::MaskChannel channel = stack::MaskChannel::r;    ///< heights, height_slopes, weights, relief
};

/// A member of StackParameters. Offsets are those of std140, which HLSL's packing and WGSL's layout share.
struct Parameter {
  enum class Type { number, vec2, vec4 };
  std::string name{};
  Type type = Type::number;
  int offset = 0;        ///< in bytes
  std::string meaning{}; ///< e.g. `layers[1] normal_map: scale of the bumps`
  std::vector<double> value{};
};

/// A member of StackSurface, named in its lower-case words and, of a texture coordinate, the UV set.
struct SurfaceMember {
  enum class Role {
    position, ///< vec3 position: world space, where the surface lies
    normal,   ///< vec3 normal: world space, interpolated, not normalised
    dp_dx,
    dp_dy,            ///< vec3: change of the position per pixel
    front_facing,     ///< bool
    normal_is_absent, ///< bool, diagnostics only: `normal` stands in for one that interpolation lacks
    st,               ///< vec2 stN: texture coordinate of UV set N
    dst_dx,
    dst_dy,            ///< vec2 dstN_dx, dstN_dy
    tangent,           ///< vec4 tangentN: interpolated vertex tangent, not normalised, and the sign
    object_position,   ///< vec3: in the object's space, before any displacement
    world_position,    ///< vec3: the same in world space, before any displacement and parallax
    world_from_object, ///< mat3: linear part of the object's transform
    object_from_world, ///< mat3: its inverse; zero where there is none
    object_origin,     ///< vec3: where the object's space begins, relative to what `position` is relative to
    world_origin,      ///< vec3: world position that `position` is relative to; zero where it is absolute
    to_viewer,         ///< vec3: unit, towards the eye; zero where nobody looks
    to_sun,            ///< vec3: unit; zero where no sun shines
    raster,            ///< vec2: pixel coordinates, centres at .5, in the directions of the derivatives
    dn_dx,
    dn_dy,                ///< vec3: change of `normal` per pixel
    relative_from_screen, ///< mat4: takes (x, y, depth, 1) in pixels to the space of `position`, before the
                          ///< division by w; zero where the raster is no screen
    roughness, ///< float, Options::roughness only: perceptual, the root of GGX's or Beckmann's alpha
  };
  Role role = Role::normal;
  std::string type{}; ///< in the language's spelling
  std::string name{};
  int uv = -1;            ///< UV set of a texture coordinate
  bool of_object = false; ///< the same for all fragments of an object
};

/// A decal as the code reads it: 5 vec4.
inline constexpr int bytes_a_decal = 80;

/// Most decals of a stack: what the uniform blocks of GLSL ES are sure to hold, and a buffer elsewhere.
inline constexpr int most_decals_es = 64;
inline constexpr int most_decals = 4096;

/// Most textures of a stack: what a fragment stage is sure to have.
[[nodiscard]] int most_textures(Language language);

struct Shader {
  std::string source{};
  Language language = Language::glsl;
  std::string name{};      ///< Options::name: the function is NAME_normal
  std::string type_name{}; ///< the same with a capital: NAMESurface, NAMEResult, NAMEParameters
  std::vector<SurfaceMember> surface{};
  bool moves = false;        ///< StackResult has position and stN: a parallax moves them
  bool has_sunlight = false; ///< StackResult has sunlight
  std::vector<TextureBinding> textures{};
  int group = 0; ///< of all bindings; languages that have none, and OpenGL: 0
  int parameters_binding = 0;
  std::vector<Parameter> parameters{};
  std::vector<std::byte> parameter_data{}; ///< what the stack says, in the block's layout; maybe empty
  int decals_binding = 0;
  int decal_count = 0;
  bool decals_in_block = false;        ///< a uniform block, else a storage buffer
  std::string beyond_es{};             ///< glsl: the layer and why the code compiles as 450 alone; or empty
  std::vector<std::byte> decal_data{}; ///< decal_count times bytes_a_decal
  bool displaces = false;              ///< there is NAME_displaced for the vertex stage
};

/// Where `exact` access finds its maps: descriptor set 0, storage buffers of 32-bit words.
///
///   binding 0  uniform block of the parameters (as Shader::parameters_binding says; absent if empty)
///   binding 1  the decals (absent if there are none)
///   binding 2  NAME_words: texels, level tables and nodes of all maps, one after the other, in any order; an
///              array of buffers where exact_words says so
///   binding 3  NAME_maps: one ExactMap a texture, two for a relief (from above, then from below), in the
///              order of Shader::textures
///   binding 4  and on: at 4 + TextureBinding::binding a combined image and sampler for each sampled texture.
///              Of its ExactMap only the levels count, and the scale: what a fetched component is multiplied
///              by. Its texels need not be among the words.
///
/// The caller puts exact_words before the code, declares nothing else of these and writes his own main, whose
/// bindings are of other sets.
struct ExactLayout {
  static constexpr int parameters = 0, decals = 1, words = 2, maps = 3, textures = 4;
};

/// A map in the buffers of `exact` access, words as image::Map has them; positions count words of
/// its buffer.
struct ExactMap {
  std::uint32_t texels = 0;      ///< where Map::words begins
  std::uint32_t levels = 0;      ///< where Map::level_table begins
  std::uint32_t level_count = 1; ///< Map::level_count
  std::uint32_t format = 0;      ///< image::TexelFormat as a number, + 256 * components, + 65536 if encoded
  float scale = 1;               ///< Map::scale
  std::uint32_t nodes = 0;       ///< relief: where HeightField::maxima begins
  std::uint32_t rows = 0;        ///< relief: where HeightField::node_table begins
  std::uint32_t row_words = 0;   ///< relief: HeightField::row_words
};
static_assert(sizeof(ExactMap) == 32);

/// Whether identifiers may begin so (Options::name): not as the library's do, nor as GLSL's own.
[[nodiscard]] bool is_name(std::string_view text);

/// The code of the layers of one material.
///
/// throws  InputError with the layer's line and key for what a language cannot express: more textures or
///         decals than its limits, registers beyond the last, a volume function of the program's own;
///         std::invalid_argument for options that no language knows: names, negative bindings
[[nodiscard]] Shader generate(const std::vector<stack::Layer>& layers, const Options& options);

/// `exact` access: what stands before the code, the buffers of the words and the functions that read them.
///
/// blocks  in which buffer the words of each map lie, from 0 on; absent: all in one. They are constants of
///         the code, so that no device chooses between buffers at every texel.
[[nodiscard]] std::string exact_words(const Shader& shader, const std::vector<int>& blocks = {});

/// What the file beside the code says: bindings and what their texels mean, parameters with their offsets and
/// values, members of the surface. JSON, ends with a line feed.
[[nodiscard]] std::string manifest(const Shader& shader);

} // namespace surfgrad::shadergen
