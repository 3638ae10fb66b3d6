#include "io/gltf_check.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

using nlohmann::json;

constexpr double largest_int = std::numeric_limits<int>::max();
constexpr double largest_u32 = std::numeric_limits<std::uint32_t>::max();
// The largest range in which every whole number is also a double.
constexpr double largest_whole = 9007199254740992.0;

// Quoted text in a message: enough to recognise it, short enough for one line.
constexpr std::size_t longest_quote = 120;

enum class Kind { whole, index, number, flag, text };

/// What stands at the end of a path. In paths * is every entry of an array, % every member of an
/// object, and ! marks what must be there; all else may be missing.
struct Rule {
  std::string_view path;
  Kind kind;
  std::string_view words{}; ///< index: the top-level array that it points into; text: its choices, if limited
  double low = 0.0;         ///< whole: its range
  double high = largest_int;
  double step = 1.0; ///< whole: a multiple of this
};

constexpr Rule whole(std::string_view path, double low = 0.0, double high = largest_int, double step = 1.0) {
  return {.path = path, .kind = Kind::whole, .low = low, .high = high, .step = step};
}

constexpr Rule rules[] = {
    {"asset!/version!", Kind::text},
    {"extensionsUsed/*", Kind::text},
    {"extensionsRequired/*", Kind::text},
    {"buffers/*/uri", Kind::text},
    whole("buffers/*/byteLength!", 1, largest_whole),
    {"bufferViews/*/buffer!", Kind::index, "buffers"},
    whole("bufferViews/*/byteOffset", 0, largest_whole),
    whole("bufferViews/*/byteLength!", 1, largest_whole),
    whole("bufferViews/*/byteStride", 4, 252, 4),
    {"accessors/*/bufferView", Kind::index, "bufferViews"},
    whole("accessors/*/byteOffset", 0, largest_whole),
    whole("accessors/*/componentType!", 5120, 5130), // what tinygltf knows; each use permits fewer
    {"accessors/*/normalized", Kind::flag},
    whole("accessors/*/count!", 1, largest_u32),
    {"accessors/*/type!", Kind::text, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4"},
    whole("accessors/*/sparse/count!", 1),
    {"accessors/*/sparse/indices!/bufferView!", Kind::index, "bufferViews"},
    whole("accessors/*/sparse/indices/byteOffset"),
    whole("accessors/*/sparse/indices/componentType!"),
    {"accessors/*/sparse/values!/bufferView!", Kind::index, "bufferViews"},
    whole("accessors/*/sparse/values/byteOffset"),
    {"meshes/*/name", Kind::text},
    {"meshes/*/primitives!/*/attributes!/%", Kind::index, "accessors"},
    {"meshes/*/primitives/*/indices", Kind::index, "accessors"},
    {"meshes/*/primitives/*/material", Kind::index, "materials"},
    whole("meshes/*/primitives/*/mode", 0, 6),
    {"meshes/*/primitives/*/targets/*/%", Kind::index, "accessors"},
    {"meshes/*/weights/*", Kind::number},
    {"nodes/*/name", Kind::text},
    {"nodes/*/mesh", Kind::index, "meshes"},
    {"nodes/*/weights/*", Kind::number},
    {"nodes/*/children/*", Kind::index, "nodes"},
    {"nodes/*/matrix/*16", Kind::number},
    {"nodes/*/translation/*3", Kind::number},
    {"nodes/*/rotation/*4", Kind::number},
    {"nodes/*/scale/*3", Kind::number},
    {"scenes/*/nodes/*", Kind::index, "nodes"},
    {"scene", Kind::index, "scenes"},
    {"images/*/uri", Kind::text},
    {"images/*/bufferView", Kind::index, "bufferViews"},
    whole("samplers/*/wrapS"),
    whole("samplers/*/wrapT"),
    {"textures/*/source", Kind::index, "images"},
    {"textures/*/sampler", Kind::index, "samplers"},
    {"materials/*/name", Kind::text},
    {"materials/*/doubleSided", Kind::flag},
    {"materials/*/normalTexture/index!", Kind::index, "textures"},
    whole("materials/*/normalTexture/texCoord"),
    {"materials/*/normalTexture/scale", Kind::number},
    {"materials/*/normalTexture/extensions/KHR_texture_transform/offset/*2", Kind::number},
    {"materials/*/normalTexture/extensions/KHR_texture_transform/scale/*2", Kind::number},
    {"materials/*/normalTexture/extensions/KHR_texture_transform/rotation", Kind::number},
    whole("materials/*/normalTexture/extensions/KHR_texture_transform/texCoord"),
};

/// Extensions that may be required: read here, or about shading that is not read at all.
bool is_supported(std::string_view extension) {
  return extension == "KHR_texture_transform" || extension == "KHR_mesh_quantization" ||
         extension == "KHR_lights_punctual" || extension.starts_with("KHR_materials_");
}

std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array";
  const std::string text = value.dump();
  return text.size() > longest_quote ? text.substr(0, longest_quote) + "..." : text;
}

bool is_word_of(std::string_view text, std::string_view words) {
  return fmt::format(" {} ", words).find(fmt::format(" {} ", text)) != words.npos;
}

/// Copies what the rules name and checks it on the way.
class Checker {
 public:
  Checker(const std::filesystem::path& file, const json& document) : file_(&file), document_(&document) {}

  json check() const {
    json result;
    for (const Rule& rule : rules) follow(rule, rule.path, *document_, "", result);
    check_version_and_extensions(result);
    check_transforms(result);
    return result;
  }

 private:
  [[noreturn]] void fail(std::string place, std::string problem, std::string remedy) const {
    gltf::fail(*file_, std::move(place), std::move(problem), std::move(remedy));
  }

  /// Copies to `result` what `value` at `place` has along the rest of a rule's path.
  void follow(const Rule& rule, std::string_view path, const json& value, const std::string& place,
              json& result) const {
    if (path.empty()) {
      result = checked(rule, value, place);
      return;
    }
    std::string_view key = path.substr(0, path.find('/'));
    const std::string_view rest = path.substr(std::min(key.size() + 1, path.size()));
    if (key.starts_with('*')) {
      if (!value.is_array()) fail(place, "is " + shown(value), "expected an array");
      if (key.size() > 1 && fmt::format("*{}", value.size()) != key)
        fail(place, fmt::format("has {} entries", value.size()),
             fmt::format("expected {} numbers", key.substr(1)));
      if (result.is_null()) result = json::array();
      for (std::size_t i = 0; i < value.size(); ++i)
        follow(rule, rest, value[i], fmt::format("{}[{}]", place, i), result[i]);
      return;
    }
    if (!value.is_object()) fail(place, "is " + shown(value), "expected an object");
    if (result.is_null()) result = json::object();
    const bool is_required = key.ends_with('!');
    if (is_required) key.remove_suffix(1);
    const auto enter = [&](const std::string& name, const json& member) {
      follow(rule, rest, member, place.empty() ? name : fmt::format("{}.{}", place, name), result[name]);
    };
    if (key == "%")
      for (const auto& [name, member] : value.items()) enter(name, member);
    else if (const auto member = value.find(key); member != value.end())
      enter(std::string(key), *member);
    else if (is_required)
      fail(place, fmt::format("\"{}\" is missing", key), fmt::format("expected the key \"{}\" here", key));
  }

  json checked(const Rule& rule, const json& value, const std::string& place) const {
    const auto require = [&](bool is_right, const std::string& remedy) {
      if (!is_right) fail(place, "is " + shown(value), "expected " + remedy);
    };
    switch (rule.kind) {
    case Kind::whole:
    case Kind::index: {
      const double number = value.is_number() ? value.get<double>() : -1.0;
      const bool is_index = rule.kind == Kind::index;
      require(number >= rule.low && number <= (is_index ? largest_whole : rule.high) &&
                  std::fmod(number, rule.step) == 0.0,
              is_index || rule.high == largest_whole
                  ? fmt::format("a whole number, {} or more", rule.low)
                  : fmt::format("a {} from {} to {}",
                                rule.step > 1.0 ? fmt::format("multiple of {}", rule.step) : "whole number",
                                rule.low, rule.high));
      const auto whole = static_cast<std::uint64_t>(number);
      if (is_index) require_entry(rule.words, whole, place);
      return whole;
    }
    case Kind::number:
      require(value.is_number(), "a number");
      return value.get<double>();
    case Kind::flag:
      require(value.is_boolean(), "true or false");
      return value;
    case Kind::text:
      require(value.is_string(), "a string");
      require(rule.words.empty() || is_word_of(value.get_ref<const std::string&>(), rule.words),
              fmt::format("one of: {}", rule.words));
    }
    return value;
  }

  void require_entry(std::string_view array, std::uint64_t index, const std::string& place) const {
    const auto entries = document_->find(array);
    const std::size_t count = entries != document_->end() ? entries->size() : 0;
    if (index >= count)
      fail(place, fmt::format("{}[{}] does not exist", array, index),
           fmt::format("{} has {} {}", array, count, count == 1 ? "entry" : "entries"));
  }

  void check_version_and_extensions(const json& document) const {
    const json& version = document["asset"]["version"];
    if (!version.get_ref<const std::string&>().starts_with("2."))
      fail("asset.version", fmt::format("glTF {} is not supported", shown(version)), "expected 2.0");
    const json required = document.value("extensionsRequired", json::array());
    for (std::size_t i = 0; i < required.size(); ++i)
      if (const auto& name = required[i].get_ref<const std::string&>(); !is_supported(name))
        fail(fmt::format("extensionsRequired[{}]", i),
             fmt::format("extension \"{}\" is not supported", name.substr(0, longest_quote)),
             "expected a model exported without it");
  }

  void check_transforms(const json& document) const {
    const json nodes = document.value("nodes", json::array());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].contains("matrix"))
        for (const char* other : {"translation", "rotation", "scale"})
          if (nodes[i].contains(other))
            fail(fmt::format("nodes[{}]", i), fmt::format("has a matrix beside \"{}\"", other),
                 "expected one or the other");
  }

  const std::filesystem::path* file_;
  const json* document_;
};

} // namespace

void fail(const std::filesystem::path& file, std::string place, std::string problem, std::string remedy) {
  throw InputError{
      {.file = file, .place = std::move(place), .problem = std::move(problem), .remedy = std::move(remedy)}};
}

json checked_document(const std::filesystem::path& file, const json& document) {
  return Checker(file, document).check();
}

} // namespace surfgrad::io::gltf
