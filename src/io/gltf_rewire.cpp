#include "io/gltf_rewire.hpp"

#include "io/gltf_material.hpp"
#include "io/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

using Json = nlohmann::ordered_json;

/// The member, an object, which is made where there is none.
Json& object_in(const Document& document, Json& value, const char* key, const std::string& place) {
  Json& member = value[key];
  if (member.is_null()) member = Json::object();
  if (!member.is_object()) document.fail(place + "." + key, "is no object", "expected a glTF 2.0 document");
  return member;
}

/// A number that is there and whole, from 0 on; else -1.
int index_in(const Json& value, const char* key) {
  const auto found = value.find(key);
  return found != value.end() && found->is_number_unsigned() && *found <= 0x7FFFFFFFu ? found->get<int>()
                                                                                      : -1;
}

/// The two texels of a row of `source_count` that lie beside the centre of texel i of `count`.
struct Neighbours {
  int low, high;
  float weight; ///< of the higher one
};
Neighbours neighbours(int i, int count, int source_count) {
  const double position = (i + 0.5) / count * source_count - 0.5;
  const double below = std::floor(position);
  const auto bounded = [&](double j) { return static_cast<int>(std::clamp(j, 0.0, source_count - 1.0)); };
  return {bounded(below), bounded(below + 1), static_cast<float>(position - below)};
}

/// The metallic at the centre of a texel of another image over the same UV set: the nearest texels, weighted.
float metallic_at(const image::Image& source, int x, int y, const image::Image& target) {
  const int channel = source.source_of(2);
  const Neighbours across = neighbours(x, target.width, source.width);
  const Neighbours up = neighbours(y, target.height, source.height);
  const auto row = [&](int v) {
    return (1 - across.weight) * source.at(across.low, v, channel) +
           across.weight * source.at(across.high, v, channel);
  };
  return (1 - up.weight) * row(up.low) + up.weight * row(up.high);
}

/// Roughness in G and metallic in B, as the format has them; R is nobody's, or occlusion, of which there is
/// none.
std::vector<std::byte> packed(const image::Image& roughness, const image::Image* metallic) {
  image::Image result = image::make_image(roughness.width, roughness.height, 3);
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      result.at(x, y, 0) = 1;
      result.at(x, y, 1) = roughness.at(x, y, 0);
      result.at(x, y, 2) = metallic ? metallic_at(*metallic, x, y, result) : 1;
    }
  return encode_image(result, image::Depth::unorm8, ImageFormat::png, Compression::small);
}

} // namespace

int Rewiring::add_texture(std::vector<std::byte> png, const std::string& name) {
  Json& json = edit_->json();
  if (!sampler_) {
    const int wrap = maps_->is_repeated ? TINYGLTF_TEXTURE_WRAP_REPEAT : TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    sampler_ = static_cast<int>(json["samplers"].size());
    json["samplers"].push_back({{"magFilter", TINYGLTF_TEXTURE_FILTER_LINEAR},
                                {"minFilter", TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR},
                                {"wrapS", wrap},
                                {"wrapT", wrap}});
  }
  const int image = edit_->add_image(std::move(png), "image/png", name);
  json["textures"].push_back({{"sampler", *sampler_}, {"source", image}});
  return static_cast<int>(json["textures"].size()) - 1;
}

void Rewiring::point(Json& info, int texture) const {
  info["index"] = texture;
  if (maps_->uv_set == 0)
    info.erase("texCoord");
  else
    info["texCoord"] = maps_->uv_set;
  erase_extension(info, "KHR_texture_transform");
}

void Rewiring::rewire(std::size_t index, const std::string& place) {
  const Document& document = edit_->document();
  // New textures may move the whole document in memory: no reference into it lives through their making.
  const auto material = [&]() -> Json& { return edit_->json()["materials"][index]; };
  if (!normal_) normal_ = add_texture(maps_->normal_png, "baked normals");
  Json& info = object_in(document, material(), "normalTexture", place);
  point(info, *normal_);
  info.erase("scale");
  if (!maps_->roughness) return;

  const int roughness = roughness_texture(object_in(document, material(), "pbrMetallicRoughness", place),
                                          place + ".pbrMetallicRoughness");
  Json& shading = material()["pbrMetallicRoughness"];
  point(shading["metallicRoughnessTexture"], roughness);
  shading.erase("roughnessFactor"); // 1
}

int Rewiring::roughness_texture(const Json& shading, const std::string& place) {
  const auto info = shading.find("metallicRoughnessTexture");
  const auto factor = shading.find("metallicFactor");
  const bool is_metal = factor == shading.end() || !factor->is_number() || factor->get<double>() != 0;
  if (info == shading.end() || !is_metal) {
    if (!roughness_) roughness_ = add_texture(packed(*maps_->roughness, nullptr), "baked roughness");
    return *roughness_;
  }
  const Document& document = edit_->document();
  const std::string info_place = place + ".metallicRoughnessTexture";
  if (!info->is_object()) document.fail(info_place, "is no object", "expected a glTF 2.0 document");
  const auto extensions = info->find("extensions");
  const bool is_transformed =
      extensions != info->end() && extensions->is_object() && extensions->contains("KHR_texture_transform");
  const int set = info->contains("texCoord") ? index_in(*info, "texCoord") : 0;
  if (is_transformed || set < 0 || static_cast<std::size_t>(set) != maps_->uv_set)
    document.fail(
        info_place,
        fmt::format("does not lie over UV set {} as it is: its metallic cannot be kept", maps_->uv_set),
        "bake over its UV set, or without a roughness");
  const image::Image old = read_texture(document, index_in(*info, "index"), info_place);
  return add_texture(packed(*maps_->roughness, &old), "baked roughness");
}

} // namespace surfgrad::io::gltf
