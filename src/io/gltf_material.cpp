#include "io/gltf_material.hpp"

#include "io/gltf_uri.hpp"
#include "io/image_file.hpp"
#include "io/in_parallel.hpp"

#include <surfgrad/trigonometry.hpp>

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

/// An image as it was read, or why it could not be.
struct NamedImage {
  std::filesystem::path name{};
  std::shared_ptr<const image::Image> image{};
  std::exception_ptr error{};
};

NamedImage read_named_image(const Document& document, int index) {
  const auto& [view, uri] = document.images[static_cast<std::size_t>(index)];
  const std::string place = fmt::format("images[{}]", index);
  const auto decoded = [](std::span<const std::byte> bytes, const std::filesystem::path& name) {
    return NamedImage{name, std::make_shared<image::Image>(decode_image(bytes, name)), nullptr};
  };
  if (view >= 0)
    return decoded(document.bytes_of_view(view), fmt::format("{}:{}", document.file.string(), place));
  if (!uri) document.fail(place, "\"uri\" is missing", "expected a \"uri\" or a \"bufferView\"");
  const Resource resource = read_uri(document.file, place, *uri);
  return decoded(resource.bytes, resource.name);
}

/// Reads the materials of a document and each image once.
class Materials {
 public:
  Materials(const Document& document, const Report& report) : document_(&document) {
    std::vector<int> indices;
    std::vector<std::function<void()>> jobs;
    for (const tinygltf::Material& material : document.model.materials) {
      const int index = image_of(material);
      if (index < 0 || images_.contains(index)) continue;
      jobs.emplace_back(
          [&document, index, &image = images_[index]] { image = read_named_image(document, index); });
      indices.push_back(index);
    }
    const std::vector<std::exception_ptr> errors = run_in_parallel(jobs, report);
    for (std::size_t i = 0; i < errors.size(); ++i) images_[indices[i]].error = errors[i];
  }

  ModelMaterial read(std::size_t index) {
    const tinygltf::Material& source = document_->model.materials[index];
    ModelMaterial material;
    material.name = source.name.empty() ? fmt::format("material_{}", index) : source.name;
    material.double_sided = source.doubleSided;
    if (source.normalTexture.index >= 0)
      material.normal =
          read_normal_texture(source.normalTexture, fmt::format("materials[{}].normalTexture", index));
    return material;
  }

 private:
  /// Of the normal texture, or -1.
  int image_of(const tinygltf::Material& material) const {
    const int texture = material.normalTexture.index;
    return texture < 0 ? -1 : document_->model.textures[static_cast<std::size_t>(texture)].source;
  }

  ModelTexture read_normal_texture(const tinygltf::NormalTextureInfo& info, const std::string& place) {
    ModelTexture result;
    result.uv_set = info.texCoord;
    result.scale = info.scale;
    require_float(info.scale, place);
    const tinygltf::Texture& texture = document_->model.textures[static_cast<std::size_t>(info.index)];
    if (texture.sampler >= 0) {
      const tinygltf::Sampler& sampler = document_->model.samplers[static_cast<std::size_t>(texture.sampler)];
      const std::string sampler_place = fmt::format("samplers[{}]", texture.sampler);
      result.wrap_s = wrap_of(sampler.wrapS, sampler_place + ".wrapS");
      result.wrap_t = wrap_of(sampler.wrapT, sampler_place + ".wrapT");
    }
    if (const auto transform = info.extensions.find("KHR_texture_transform");
        transform != info.extensions.end())
      apply_transform(transform->second, place + ".extensions.KHR_texture_transform", result);
    if (texture.source < 0)
      document_->fail(fmt::format("textures[{}]", info.index), "\"source\" is missing",
                      "expected the key \"source\" here");
    const NamedImage& image = images_.at(texture.source);
    if (image.error) std::rethrow_exception(image.error);
    result.name = image.name;
    result.image = image.image;
    return result;
  }

  image::Wrap wrap_of(int code, const std::string& place) const {
    switch (code) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return image::Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return image::Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return image::Wrap::mirror;
    default:
      document_->fail(place, fmt::format("is {}", code),
                      "expected 10497 (repeat), 33071 (clamp) or 33648 (mirror)");
    }
  }

  /// The engine computes in single precision.
  void require_float(double value, const std::string& place) const {
    if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
      document_->fail(place, fmt::format("has the number {}", value), "expected numbers of moderate size");
  }

  /// KHR_texture_transform turns, in coordinates with v down, by u' = ox + cos*sx*u + sin*sy*v and
  /// v' = oy - sin*sx*u + cos*sy*v: counter-clockwise as one looks at the image. (The matrix printed
  /// in the extension's first text turned the other way.) With t = 1 - v and t' = 1 - v' that is a
  /// turn by the same angle and another offset.
  void apply_transform(const tinygltf::Value& transform, const std::string& place,
                       ModelTexture& texture) const {
    const auto pair = [&](const char* key, vec2<double> fallback) {
      if (!transform.Has(key)) return fallback;
      const tinygltf::Value& numbers = transform.Get(key);
      const vec2<double> value{numbers.Get(0).GetNumberAsDouble(), numbers.Get(1).GetNumberAsDouble()};
      require_float(value.x, place);
      require_float(value.y, place);
      return value;
    };
    const vec2<double> offset = pair("offset", {0.0, 0.0});
    const vec2<double> scale = pair("scale", {1.0, 1.0});
    const double angle = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0.0;
    texture.tile = scale;
    texture.rotate_rad = angle;
    const SinCos<double> r = sin_cos_turns(angle / (2 * std::numbers::pi));
    texture.offset = {offset.x + r.sin * scale.y, 1.0 - offset.y - r.cos * scale.y};
    if (transform.Has("texCoord")) texture.uv_set = transform.Get("texCoord").GetNumberAsInt();
  }

  const Document* document_;
  std::map<int, NamedImage> images_{};
};

} // namespace

std::vector<ModelMaterial> read_materials(const Document& document, const Report& report) {
  Materials reader(document, report);
  std::vector<ModelMaterial> materials;
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) materials.push_back(reader.read(i));
  return materials;
}

image::Image read_texture(const Document& document, int texture, const std::string& place) {
  const std::vector<tinygltf::Texture>& textures = document.model.textures;
  if (texture < 0 || static_cast<std::size_t>(texture) >= textures.size())
    document.fail(place + ".index", "names no texture", fmt::format("expected one of {}", textures.size()));
  const int source = textures[static_cast<std::size_t>(texture)].source;
  if (source < 0)
    document.fail(fmt::format("textures[{}]", texture), "\"source\" is missing",
                  "expected the key \"source\" here");
  return *read_named_image(document, source).image;
}

} // namespace surfgrad::io::gltf
