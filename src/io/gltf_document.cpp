#include "io/gltf_document.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace surfgrad::io::gltf {
namespace {

using nlohmann::json;

// Bytes are copied into numbers as they lie; glTF is little-endian.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t glb_magic = 0x46546C67;         // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;        // "JSON"
constexpr std::uint32_t binary_chunk_type = 0x004E4942; // "BIN"
constexpr std::size_t glb_header_size = 12;
constexpr std::size_t chunk_header_size = 8;

// The largest range in which every whole number is also a double.
constexpr double largest_whole = 9007199254740992.0;

// Quoted text in a message: enough to recognise it, short enough for one line.
constexpr std::size_t longest_quote = 120;

std::string shortened(std::string text) {
  if (text.size() > longest_quote) text = text.substr(0, longest_quote) + "...";
  return text;
}

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// Extensions that may be required: read here, or about shading that is not read at all.
bool is_supported(const std::string& extension) {
  return extension == "KHR_texture_transform" || extension == "KHR_mesh_quantization" ||
         extension == "KHR_lights_punctual" || extension.starts_with("KHR_materials_");
}

} // namespace

void Element::fail(std::string problem, std::string remedy) const {
  throw InputError{{.file = document_->file(),
                    .place = place_,
                    .problem = std::move(problem),
                    .remedy = std::move(remedy)}};
}

std::string Element::shown() const {
  if (value_->is_object()) return "an object";
  if (value_->is_array()) return "an array";
  return shortened(value_->dump());
}

std::optional<Element> Element::find(std::string_view key) const {
  if (!value_->is_object()) fail("is " + shown(), "expected an object");
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return Element(*document_, *member, place_.empty() ? std::string(key) : fmt::format("{}.{}", place_, key));
}

Element Element::at(std::string_view key) const {
  if (auto member = find(key)) return *std::move(member);
  fail(fmt::format("\"{}\" is missing", key), fmt::format("expected the key \"{}\" here", key));
}

std::vector<std::string> Element::keys() const {
  if (!value_->is_object()) fail("is " + shown(), "expected an object");
  std::vector<std::string> result;
  for (const auto& member : value_->items()) result.push_back(member.key());
  return result;
}

std::size_t Element::size() const {
  if (!value_->is_array()) fail("is " + shown(), "expected an array");
  return value_->size();
}

Element Element::operator[](std::size_t index) const {
  return Element(*document_, value_->at(index), fmt::format("{}[{}]", place_, index));
}

std::size_t Element::whole() const {
  const double value = value_->is_number() ? value_->get<double>() : -1.0;
  if (!(value >= 0.0 && value <= largest_whole && value == std::floor(value)))
    fail("is " + shown(), "expected a whole number, 0 or more");
  return static_cast<std::size_t>(value);
}

double Element::number() const {
  if (!value_->is_number()) fail("is " + shown(), "expected a number");
  return value_->get<double>();
}

bool Element::boolean() const {
  if (!value_->is_boolean()) fail("is " + shown(), "expected true or false");
  return value_->get<bool>();
}

const std::string& Element::text() const {
  if (!value_->is_string()) fail("is " + shown(), "expected a string");
  return value_->get_ref<const std::string&>();
}

std::size_t Element::whole_or(std::string_view key, std::size_t fallback) const {
  const auto member = find(key);
  return member ? member->whole() : fallback;
}

double Element::number_or(std::string_view key, double fallback) const {
  const auto member = find(key);
  return member ? member->number() : fallback;
}

bool Element::boolean_or(std::string_view key, bool fallback) const {
  const auto member = find(key);
  return member ? member->boolean() : fallback;
}

std::string Element::text_or(std::string_view key, std::string fallback) const {
  const auto member = find(key);
  return member ? member->text() : std::move(fallback);
}

bool Element::numbers(std::string_view key, std::span<double> result) const {
  const auto member = find(key);
  if (!member) return false;
  if (member->size() != result.size())
    member->fail(fmt::format("has {} entries", member->size()),
                 fmt::format("expected {} numbers", result.size()));
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (*member)[i].number();
  return true;
}

std::size_t Element::index_into(std::string_view array) const {
  const std::size_t index = whole();
  const std::size_t count = document_->count(array);
  if (index >= count)
    fail(fmt::format("{}[{}] does not exist", array, index),
         fmt::format("{} has {} {}", array, count, count == 1 ? "entry" : "entries"));
  return index;
}

Element Element::entry_of(std::string_view array) const { return document_->entry(array, index_into(array)); }

Document::Document(std::filesystem::path file, std::vector<std::byte> bytes)
    : file_(std::move(file)), bytes_(std::move(bytes)) {
  const bool is_glb = bytes_.size() >= sizeof glb_magic && read_u32(bytes_, 0) == glb_magic;
  parse(is_glb ? split_glb() : bytes_);
  check_version_and_extensions();
}

Document::~Document() = default;

std::span<const std::byte> Document::split_glb() {
  const auto fail = [&](std::string place, std::string problem, std::string remedy) {
    throw InputError{{.file = file_,
                      .place = std::move(place),
                      .problem = std::move(problem),
                      .remedy = std::move(remedy)}};
  };
  std::span<const std::byte> rest = bytes_;
  if (rest.size() < glb_header_size)
    fail("GLB header", fmt::format("the file ends after {} bytes", rest.size()),
         "expected a complete GLB file");
  if (const std::uint32_t version = read_u32(rest, 4); version != 2)
    fail("GLB header", fmt::format("version {} is not supported", version), "expected version 2");
  const std::size_t length = read_u32(rest, 8);
  if (length < glb_header_size || length > rest.size())
    fail("GLB header", fmt::format("the length is {} but the file has {} bytes", length, rest.size()),
         "expected a complete GLB file");
  rest = rest.subspan(glb_header_size, length - glb_header_size);

  std::optional<std::span<const std::byte>> text;
  for (int chunk = 0; !rest.empty(); ++chunk) {
    const std::string place = fmt::format("GLB chunk {}", chunk);
    if (rest.size() < chunk_header_size)
      fail(place, fmt::format("only {} bytes are left for its header", rest.size()), "expected 8 bytes");
    const std::size_t size = read_u32(rest, 0);
    const std::uint32_t type = read_u32(rest, 4);
    rest = rest.subspan(chunk_header_size);
    if (size > rest.size())
      fail(place, fmt::format("its length is {} but only {} bytes are left", size, rest.size()),
           "expected a complete GLB file");
    // The format fixes the order: JSON first, then at most one binary chunk; others are extensions.
    if (chunk == 0 && type != json_chunk) fail(place, "is not the JSON chunk", "expected JSON first");
    if (chunk == 0) text = rest.first(size);
    if (chunk == 1 && type == binary_chunk_type) binary_chunk_ = rest.first(size);
    rest = rest.subspan(size);
  }
  if (!text) fail("GLB header", "the file has no chunks", "expected a JSON chunk");
  return *text;
}

void Document::parse(std::span<const std::byte> text) {
  const char* begin = reinterpret_cast<const char*>(text.data());
  try {
    json_ = std::make_unique<json>(json::parse(begin, begin + text.size()));
  } catch (const json::parse_error& error) {
    const std::size_t read = std::min(error.byte, text.size());
    const auto line =
        std::min<std::ptrdiff_t>(1 + std::count(begin, begin + read, '\n'), std::numeric_limits<int>::max());
    // The library's message starts with its own tag and place; ours has the line.
    std::string_view reason = error.what();
    if (const auto colon = reason.find(": "); colon != reason.npos) reason.remove_prefix(colon + 2);
    throw InputError{{.file = file_,
                      .line = static_cast<int>(line),
                      .problem = "is not JSON: " + shortened(std::string(reason)),
                      .remedy = "expected a glTF 2.0 document"}};
  } catch (const json::exception& error) {
    std::string_view reason = error.what();
    if (const auto tag_end = reason.find("] "); tag_end != reason.npos) reason.remove_prefix(tag_end + 2);
    throw InputError{{.file = file_,
                      .problem = "cannot be read as JSON: " + shortened(std::string(reason)),
                      .remedy = "expected a glTF 2.0 document"}};
  }
}

void Document::check_version_and_extensions() const {
  const Element version = root().at("asset").at("version");
  if (!version.text().starts_with("2."))
    version.fail(fmt::format("glTF {} is not supported", shortened(version.text())), "expected 2.0");
  const auto required = root().find("extensionsRequired");
  if (!required) return;
  for (std::size_t i = 0; i < required->size(); ++i) {
    const Element extension = (*required)[i];
    if (!is_supported(extension.text()))
      extension.fail(fmt::format("extension \"{}\" is not supported", shortened(extension.text())),
                     "expected a model exported without it");
  }
}

Element Document::root() const { return Element(*this, *json_, ""); }

std::size_t Document::count(std::string_view array) const {
  const auto entries = root().find(array);
  return entries ? entries->size() : 0;
}

Element Document::entry(std::string_view array, std::size_t index) const { return root().at(array)[index]; }

bool Document::uses(std::string_view extension) const {
  const auto used = root().find("extensionsUsed");
  if (!used) return false;
  for (std::size_t i = 0; i < used->size(); ++i)
    if ((*used)[i].text() == extension) return true;
  return false;
}

} // namespace surfgrad::io::gltf
