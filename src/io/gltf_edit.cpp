#include "io/gltf_edit.hpp"

#include "io/gltf_accessor.hpp"
#include "io/gltf_check.hpp"
#include "io/gltf_uri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t glb_magic = 0x46546C67;    // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;   // "JSON"
constexpr std::uint32_t binary_chunk = 0x004E4942; // "BIN"

// Chunks and the numbers in them begin at multiples of this.
constexpr std::size_t alignment = 4;

std::size_t aligned(std::size_t size) { return (size + alignment - 1) / alignment * alignment; }

/// The member, or null where `value` is no object or has none of that name.
const Json* member(const Json& value, const char* key) {
  if (!value.is_object()) return nullptr;
  const auto found = value.find(key);
  return found == value.end() ? nullptr : &*found;
}

/// Every number in it that could be an index.
void collect_indices(const Json& value, std::set<std::size_t>& indices) {
  if (value.is_structured()) {
    for (const Json& part : value) collect_indices(part, indices);
  } else if (value.is_number()) {
    const auto number = value.get<double>();
    if (number >= 0 && number < 0x1p31) indices.insert(static_cast<std::size_t>(number));
  }
}

/// Extensions about shading and lights name no accessors.
bool may_name_accessors(std::string_view extension) {
  return !extension.starts_with("KHR_materials_") && !extension.starts_with("KHR_texture_") &&
         !extension.starts_with("KHR_lights_");
}

void collect_indices_of_extensions(const Json& value, std::set<std::size_t>& indices) {
  if (!value.is_structured()) return;
  if (const Json* extensions = member(value, "extensions"); extensions && extensions->is_object())
    for (const auto& [name, extension] : extensions->items())
      if (may_name_accessors(name)) collect_indices(extension, indices);
  for (const Json& part : value) collect_indices_of_extensions(part, indices);
}

/// Accessors that animations and skins use, and whatever extensions may mean.
std::set<std::size_t> pinned_indices(const Json& document) {
  std::set<std::size_t> indices;
  if (const Json* animations = member(document, "animations"); animations && animations->is_array())
    for (const Json& animation : *animations)
      if (const Json* samplers = member(animation, "samplers")) collect_indices(*samplers, indices);
  if (const Json* skins = member(document, "skins"); skins && skins->is_array())
    for (const Json& skin : *skins)
      if (const Json* matrices = member(skin, "inverseBindMatrices")) collect_indices(*matrices, indices);
  collect_indices_of_extensions(document, indices);
  return indices;
}

std::set<int> accessors_of(const tinygltf::Primitive& primitive) {
  std::set<int> accessors;
  for (const auto& [name, accessor] : primitive.attributes) accessors.insert(accessor);
  for (const auto& target : primitive.targets)
    for (const auto& [name, accessor] : target) accessors.insert(accessor);
  if (primitive.indices >= 0) accessors.insert(primitive.indices);
  return accessors;
}

std::vector<int> views_of(const tinygltf::Accessor& accessor) {
  std::vector<int> views;
  if (accessor.bufferView >= 0) views.push_back(accessor.bufferView);
  if (accessor.sparse.isSparse) {
    views.push_back(accessor.sparse.indices.bufferView);
    views.push_back(accessor.sparse.values.bufferView);
  }
  return views;
}

std::size_t components_of(int type) {
  return static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
}

const char* name_of(int type) {
  switch (type) {
  case TINYGLTF_TYPE_SCALAR:
    return "SCALAR";
  case TINYGLTF_TYPE_VEC2:
    return "VEC2";
  case TINYGLTF_TYPE_VEC3:
    return "VEC3";
  case TINYGLTF_TYPE_VEC4:
    return "VEC4";
  case TINYGLTF_TYPE_MAT2:
    return "MAT2";
  case TINYGLTF_TYPE_MAT3:
    return "MAT3";
  default:
    return "MAT4";
  }
}

/// The number that these bits store; every component is a double.
double number_of(std::uint32_t bits, int component_type) {
  switch (component_type) {
  case TINYGLTF_COMPONENT_TYPE_BYTE:
    return static_cast<std::int8_t>(bits);
  case TINYGLTF_COMPONENT_TYPE_SHORT:
    return static_cast<std::int16_t>(bits);
  case TINYGLTF_COMPONENT_TYPE_FLOAT:
    return static_cast<double>(std::bit_cast<float>(bits));
  default:
    return bits;
  }
}

/// As a document spells it: integers without a point.
Json spelled(double number, int component_type) {
  if (component_type == TINYGLTF_COMPONENT_TYPE_FLOAT) return number;
  return static_cast<std::int64_t>(number);
}

/// min and max, of each component over all elements; none where one is not finite.
void bound(Json& accessor, const AccessorData& data) {
  const std::size_t n = components_of(data.type);
  std::vector<double> low(n, std::numeric_limits<double>::infinity());
  std::vector<double> high(n, -std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < data.bits.size(); ++i) {
    const double number = number_of(data.bits[i], data.component_type);
    if (!std::isfinite(number)) return;
    low[i % n] = std::min(low[i % n], number);
    high[i % n] = std::max(high[i % n], number);
  }
  for (std::size_t c = 0; c < n; ++c) {
    accessor["min"].push_back(spelled(low[c], data.component_type));
    accessor["max"].push_back(spelled(high[c], data.component_type));
  }
}

/// The elements one after the other, those of vertices at multiples of four bytes.
std::vector<std::byte> packed(const AccessorData& data, std::size_t stride) {
  const std::size_t n = components_of(data.type);
  const std::size_t size = component_size(data.component_type);
  std::vector<std::byte> bytes(data.bits.size() / n * stride);
  for (std::size_t i = 0; i < data.bits.size(); ++i)
    std::memcpy(bytes.data() + i / n * stride + i % n * size, &data.bits[i], size); // little-endian
  return bytes;
}

/// The media type of what the bytes begin like; nothing for what is not known.
std::string media_type_of(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\x89PNG\r\n")) return "image/png";
  if (text.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  if (text.starts_with("RIFF") && text.substr(std::min<std::size_t>(8, text.size())).starts_with("WEBP"))
    return "image/webp";
  if (text.starts_with("\xABKTX 20\xBB")) return "image/ktx2";
  if (text.starts_with("DDS ")) return "image/vnd-ms.dds";
  return {};
}

void append_u32(std::vector<std::byte>& bytes, std::size_t value) {
  const auto bits = std::bit_cast<std::array<std::byte, 4>>(static_cast<std::uint32_t>(value));
  bytes.insert(bytes.end(), bits.begin(), bits.end());
}

} // namespace

void erase_extension(nlohmann::ordered_json& value, const char* name) {
  const auto extensions = value.find("extensions");
  if (extensions == value.end()) return;
  extensions->erase(name);
  if (extensions->empty()) value.erase("extensions");
}

Edit::Edit(const std::filesystem::path& file, std::span<const std::byte> bytes)
    : document_(read_document(file, bytes)), json_(read_json(file, bytes)), originals_(json_["accessors"]),
      pinned_(pinned_indices(json_)) {}

Json& Edit::primitive(PrimitivePlace place) {
  return json_["meshes"][place.mesh]["primitives"][place.primitive];
}

void Edit::give_up(const std::vector<PrimitivePlace>& primitives) {
  std::set<std::pair<std::size_t, std::size_t>> given_up;
  for (const PrimitivePlace& place : primitives) given_up.insert({place.mesh, place.primitive});
  std::set<int> kept;
  const std::vector<tinygltf::Mesh>& meshes = document_.model.meshes;
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (std::size_t p = 0; p < meshes[m].primitives.size(); ++p)
      (given_up.contains({m, p}) ? free_ : kept).merge(accessors_of(meshes[m].primitives[p]));
  std::erase_if(free_, [&](int accessor) {
    return kept.contains(accessor) || pinned_.contains(static_cast<std::size_t>(accessor));
  });
}

int Edit::add(const AccessorData& data, int like) {
  Json accessor = like >= 0 ? originals_[static_cast<std::size_t>(like)] : Json::object();
  for (const char* key : {"bufferView", "byteOffset", "sparse", "min", "max"}) accessor.erase(key);
  const std::size_t n = components_of(data.type);
  const std::size_t element = n * component_size(data.component_type);
  const std::size_t stride = data.is_index ? element : aligned(element);
  accessor["componentType"] = data.component_type;
  accessor["count"] = data.bits.size() / n;
  accessor["type"] = name_of(data.type);
  if (data.is_bounded) bound(accessor, data);

  int index = static_cast<int>(json_["accessors"].size());
  if (!free_.empty()) {
    index = *free_.begin();
    free_.erase(free_.begin());
    replaced_.insert(index);
    json_["accessors"][static_cast<std::size_t>(index)] = std::move(accessor);
  } else {
    json_["accessors"].push_back(std::move(accessor));
  }
  View& view = views_[index];
  view.bytes = packed(data, stride);
  if (stride != element) view.json["byteStride"] = stride;
  view.json["target"] = data.is_index ? TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER : TINYGLTF_TARGET_ARRAY_BUFFER;
  return index;
}

int Edit::add_image(std::vector<std::byte> bytes, const std::string& media_type, const std::string& name) {
  Json& images = json_["images"];
  const auto index = static_cast<int>(images.size());
  images.push_back({{"name", name}, {"mimeType", media_type}});
  views_[-1 - index].bytes = std::move(bytes);
  return index;
}

void Edit::embed_images(const Report& report) {
  for (std::size_t i = 0; i < document_.images.size(); ++i) {
    const ImageSource& source = document_.images[i];
    if (source.view >= 0 || !source.uri) continue;
    const std::string place = fmt::format("images[{}]", i);
    Resource resource = read_uri(document_.file, place, *source.uri);
    Json& image = json_["images"][i];
    const std::string type = media_type_of(resource.bytes);
    if (type.empty()) {
      report.warn(fmt::format("{}: {} stays outside of the file: what it is cannot be told",
                              document_.file.string(), place));
      continue;
    }
    image.erase("uri");
    image["mimeType"] = type;
    views_[-1 - static_cast<int>(i)].bytes = std::move(resource.bytes);
  }
}

std::set<int> Edit::views_to_write_over() const {
  std::set<int> written_over;
  std::set<int> kept;
  for (std::size_t i = 0; i < document_.model.accessors.size(); ++i)
    for (const int view : views_of(document_.model.accessors[i]))
      (replaced_.contains(static_cast<int>(i)) ? written_over : kept).insert(view);
  for (const ImageSource& image : document_.images) kept.insert(image.view);
  std::erase_if(written_over, [&](int view) {
    return kept.contains(view) || pinned_.contains(static_cast<std::size_t>(view));
  });
  return written_over;
}

void Edit::place_views() {
  Json& all = json_["bufferViews"];
  std::set<int> free = views_to_write_over();
  std::vector<std::vector<std::byte>> bytes(all.size());
  std::vector<bool> is_new(all.size(), false);
  for (auto& [owner, view] : views_) {
    auto index = static_cast<int>(all.size());
    if (!free.empty()) {
      index = *free.begin();
      free.erase(free.begin());
    } else {
      all.push_back(Json::object());
      bytes.emplace_back();
      is_new.push_back(false);
    }
    const auto i = static_cast<std::size_t>(index);
    all[i] = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", view.bytes.size()}};
    all[i].update(view.json);
    bytes[i] = std::move(view.bytes);
    is_new[i] = true;
    if (owner >= 0)
      json_["accessors"][static_cast<std::size_t>(owner)]["bufferView"] = index;
    else
      json_["images"][static_cast<std::size_t>(-1 - owner)]["bufferView"] = index;
  }

  // A GLB counts its bytes in 32 bits, those of the JSON among them.
  constexpr std::size_t most_bytes = std::numeric_limits<std::uint32_t>::max();
  std::size_t total = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i]["buffer"] = 0;
    all[i]["byteOffset"] = total;
    erase_extension(all[i], "EXT_meshopt_compression"); // its bytes lay in a buffer that is no more
    total += aligned(is_new[i] ? bytes[i].size() : document_.bytes_of_view(static_cast<int>(i)).size());
    if (total > most_bytes)
      document_.fail("", fmt::format("would have more than {} bytes as .glb", most_bytes),
                     "expected a smaller model");
  }
  binary_.reserve(total);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::span<const std::byte> from =
        is_new[i] ? std::span<const std::byte>(bytes[i]) : document_.bytes_of_view(static_cast<int>(i));
    binary_.insert(binary_.end(), from.begin(), from.end());
    binary_.resize(aligned(binary_.size()));
    bytes[i] = {};
  }
}

std::vector<std::byte> Edit::glb(const Report& report) {
  embed_images(report);
  place_views();
  Json buffer = json_["buffers"].empty() ? Json::object() : json_["buffers"][0];
  buffer.erase("uri");
  erase_extension(buffer, "EXT_meshopt_compression");
  buffer["byteLength"] = binary_.size();
  json_["buffers"] = Json::array({std::move(buffer)});

  std::string text = json_.dump();
  text.resize(aligned(text.size()), ' ');
  constexpr std::size_t headers = 12 + 2 * 8;
  const std::size_t size = headers + text.size() + binary_.size();
  if (size > std::numeric_limits<std::uint32_t>::max())
    document_.fail("", fmt::format("would have {} bytes as .glb", size), "expected a smaller model");
  std::vector<std::byte> file;
  file.reserve(size);
  append_u32(file, glb_magic);
  append_u32(file, 2);
  append_u32(file, size);
  append_u32(file, text.size());
  append_u32(file, json_chunk);
  const auto characters = std::as_bytes(std::span(text));
  file.insert(file.end(), characters.begin(), characters.end());
  append_u32(file, binary_.size());
  append_u32(file, binary_chunk);
  file.insert(file.end(), binary_.begin(), binary_.end());
  return file;
}

} // namespace surfgrad::io::gltf
