#include "io/gltf_material.hpp"

#include "io/image_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

struct NamedImage {
  std::filesystem::path name{};
  std::shared_ptr<const image::Image> image{};
};

/// The images of a document, each decoded when first used.
class Images {
 public:
  Images(const Document& document, Buffers& buffers)
      : document_(&document), buffers_(&buffers), loaded_(document.count("images")) {}

  /// The image that `reference` is the index of.
  const NamedImage& image(const Element& reference) {
    const std::size_t index = reference.index_into("images");
    NamedImage& loaded = loaded_[index];
    if (!loaded.image) loaded = read(document_->entry("images", index));
    return loaded;
  }

 private:
  NamedImage read(const Element& element) {
    const std::filesystem::path embedded_name = document_->file().string() + ":" + element.place();
    const auto decoded = [](std::span<const std::byte> bytes, const std::filesystem::path& name) {
      return NamedImage{name, std::make_shared<const image::Image>(decode_image(bytes, name))};
    };
    if (const auto view = element.find("bufferView"))
      return decoded(buffers_->view(*view).bytes, embedded_name);
    const Element uri = element.at("uri");
    if (const auto bytes = decode_data_uri(uri)) return decoded(*bytes, embedded_name);
    const std::filesystem::path file = resolve_uri(uri);
    return {file, std::make_shared<const image::Image>(read_image(file))};
  }

  const Document* document_;
  Buffers* buffers_;
  std::vector<NamedImage> loaded_;
};

WrapMode read_wrap(const Element& sampler, std::string_view key) {
  constexpr std::size_t repeat = 10497;
  constexpr std::size_t clamp_to_edge = 33071;
  constexpr std::size_t mirrored_repeat = 33648;
  const std::size_t code = sampler.whole_or(key, repeat);
  if (code == repeat) return WrapMode::repeat;
  if (code == clamp_to_edge) return WrapMode::clamp;
  if (code == mirrored_repeat) return WrapMode::mirror;
  sampler.at(key).fail(fmt::format("is {}", code),
                       "expected 10497 (repeat), 33071 (clamp) or 33648 (mirror)");
}

/// A texCoord: the number of a UV set.
int read_uv_set(const Element& element) {
  const std::size_t set = element.whole();
  if (set > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    element.fail(fmt::format("is {}", set), "expected the number of a TEXCOORD attribute");
  return static_cast<int>(set);
}

/// The engine computes in single precision.
void require_float(const Element& element, double value) {
  if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
    element.fail(fmt::format("has the number {}", value), "expected numbers of moderate size");
}

/// KHR_texture_transform turns, in coordinates with v down, by u' = ox + cos*sx*u + sin*sy*v and
/// v' = oy - sin*sx*u + cos*sy*v: counter-clockwise as one looks at the image. (The matrix printed
/// in the extension's first text turned the other way.) With t = 1 - v and t' = 1 - v' that is a
/// turn by the same angle and another offset.
void apply_transform(const Element& transform, ModelTexture& texture) {
  double offset[2] = {0.0, 0.0};
  double scale[2] = {1.0, 1.0};
  transform.numbers("offset", offset);
  transform.numbers("scale", scale);
  const double angle = transform.number_or("rotation", 0.0);
  for (const double value : {offset[0], offset[1], scale[0], scale[1]}) require_float(transform, value);
  texture.tile = {scale[0], scale[1]};
  texture.rotate_rad = angle;
  texture.offset = {offset[0] + std::sin(angle) * scale[1], 1.0 - offset[1] - std::cos(angle) * scale[1]};
  if (const auto set = transform.find("texCoord")) texture.uv_set = read_uv_set(*set);
}

ModelTexture read_normal_texture(const Element& element, Images& images) {
  ModelTexture result;
  if (const auto set = element.find("texCoord")) result.uv_set = read_uv_set(*set);
  result.scale = element.number_or("scale", 1.0);
  require_float(element, result.scale);
  const Element texture = element.at("index").entry_of("textures");
  if (const auto reference = texture.find("sampler")) {
    const Element sampler = reference->entry_of("samplers");
    result.wrap_s = read_wrap(sampler, "wrapS");
    result.wrap_t = read_wrap(sampler, "wrapT");
  }
  if (const auto extensions = element.find("extensions"))
    if (const auto transform = extensions->find("KHR_texture_transform")) apply_transform(*transform, result);
  const NamedImage& image = images.image(texture.at("source"));
  result.name = image.name;
  result.image = image.image;
  return result;
}

} // namespace

std::vector<ModelMaterial> read_materials(const Document& document, Buffers& buffers) {
  Images images(document, buffers);
  std::vector<ModelMaterial> materials;
  for (std::size_t i = 0; i < document.count("materials"); ++i) {
    const Element element = document.entry("materials", i);
    ModelMaterial material;
    material.name = element.text_or("name", "");
    if (material.name.empty()) material.name = fmt::format("material_{}", i);
    material.double_sided = element.boolean_or("doubleSided", false);
    if (const auto normal = element.find("normalTexture"))
      material.normal = read_normal_texture(*normal, images);
    materials.push_back(std::move(material));
  }
  return materials;
}

} // namespace surfgrad::io::gltf
