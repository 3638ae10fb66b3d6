#include "io/gltf_document.hpp"

#include "diagnostic/error.hpp"
#include "io/gltf_check.hpp"
#include "io/gltf_uri.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <utility>

namespace surfgrad::io::gltf {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

// Bytes are copied into numbers as they lie; glTF is little-endian.
static_assert(std::endian::native == std::endian::little);

constexpr std::uint32_t glb_magic = 0x46546C67;    // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;   // "JSON"
constexpr std::uint32_t binary_chunk = 0x004E4942; // "BIN"
constexpr std::size_t glb_header_size = 12;
constexpr std::size_t chunk_header_size = 8;

// tinygltf counts bytes of JSON in 32 bits. The text it gets may be a little longer than the file's.
constexpr std::size_t most_json_bytes = std::size_t{1} << 30;

// Writers of JSON call themselves once a level; no document of sense has a tenth of this.
constexpr int deepest_nesting = 1000;

// A parser's own words in a message: enough to understand, short enough for one line.
constexpr std::size_t longest_reason = 120;

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

struct Chunks {
  std::span<const std::byte> text{};
  std::optional<std::span<const std::byte>> binary{};
};

/// The chunks of a GLB, or the whole file as JSON. tinygltf does not check all lengths of a GLB.
Chunks split(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  if (bytes.size() < sizeof glb_magic || read_u32(bytes, 0) != glb_magic) return {.text = bytes};
  const auto require = [&](bool is_right, const std::string& place, const std::string& problem) {
    if (!is_right) fail(file, place, problem, "expected a complete GLB file of version 2");
  };
  require(bytes.size() >= glb_header_size, "GLB header",
          fmt::format("the file ends after {} bytes", bytes.size()));
  const std::uint32_t version = read_u32(bytes, 4);
  require(version == 2, "GLB header", fmt::format("version {} is not supported", version));
  const std::size_t length = read_u32(bytes, 8);
  require(length > glb_header_size && length <= bytes.size(), "GLB header",
          fmt::format("the length is {} but the file has {} bytes", length, bytes.size()));
  std::span<const std::byte> rest = bytes.subspan(glb_header_size, length - glb_header_size);

  Chunks chunks;
  for (int chunk = 0; !rest.empty(); ++chunk) {
    const std::string place = fmt::format("GLB chunk {}", chunk);
    require(rest.size() >= chunk_header_size, place,
            fmt::format("only {} bytes are left for its header", rest.size()));
    const std::size_t size = read_u32(rest, 0);
    const std::uint32_t type = read_u32(rest, 4);
    rest = rest.subspan(chunk_header_size);
    require(size <= rest.size(), place,
            fmt::format("its length is {} but only {} bytes are left", size, rest.size()));
    // The format fixes the order: JSON first, then at most one binary chunk; others are extensions.
    require(chunk > 0 || type == json_chunk, place, "is not the JSON chunk");
    if (chunk == 0) chunks.text = rest.first(size);
    if (chunk == 1 && type == binary_chunk) chunks.binary = rest.first(size);
    rest = rest.subspan(size);
  }
  return chunks;
}

template <class Json>
Json parse(const std::filesystem::path& file, std::span<const std::byte> text,
           const typename Json::parser_callback_t& on_value = nullptr) {
  if (text.size() > most_json_bytes)
    fail(file, "", fmt::format("has {} bytes of JSON", text.size()),
         fmt::format("expected at most {}", most_json_bytes));
  const char* begin = reinterpret_cast<const char*>(text.data());
  try {
    return Json::parse(begin, begin + text.size(), on_value);
  } catch (const json::exception& error) { // of ordered_json too
    Fault fault{.file = file, .remedy = "expected a glTF 2.0 document"};
    if (const auto* parse_error = dynamic_cast<const json::parse_error*>(&error))
      fault.line =
          static_cast<int>(1 + std::count(begin, begin + std::min(parse_error->byte, text.size()), '\n'));
    // The library's message starts with its own tag and place.
    std::string_view reason = error.what();
    const std::string_view end_of_prefix = fault.line > 0 ? ": " : "] ";
    if (const auto prefix = reason.find(end_of_prefix); prefix != reason.npos)
      reason.remove_prefix(prefix + end_of_prefix.size());
    fault.problem = fmt::format("is not JSON: {}", reason.substr(0, longest_reason));
    throw InputError(fault);
  }
}

std::vector<unsigned char> read_buffer(const std::filesystem::path& file, const json& buffer,
                                       const std::string& place, const Chunks& chunks) {
  std::vector<std::byte> read;
  std::span<const std::byte> bytes;
  if (buffer.contains("uri"))
    bytes = read = read_uri(file, place, buffer["uri"]).bytes;
  else if (place == "buffers[0]" && chunks.binary)
    bytes = *chunks.binary;
  else
    fail(file, place, "has no \"uri\" and no binary chunk",
         "expected a \"uri\", or the first buffer of a GLB");
  const auto length = buffer["byteLength"].get<std::size_t>();
  if (length > bytes.size())
    fail(file, place + ".byteLength", fmt::format("is {} but the data has {} bytes", length, bytes.size()),
         "expected the whole buffer");
  const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
  return {first, first + length};
}

using Files = std::map<std::string, std::vector<unsigned char>>;

/// Fills document.model from a checked document whose buffers' URIs are names of `buffers`.
void load(Document& document, const std::string& text, Files& buffers) {
  tinygltf::TinyGLTF loader;
  const auto take_file = [](std::vector<unsigned char>* bytes, std::string*, const std::string& name,
                            void* files) {
    *bytes = std::move((*static_cast<Files*>(files))[name]);
    return true;
  };
  loader.SetFsCallbacks({.FileExists = [](const std::string&, void*) { return true; },
                         .ExpandFilePath = [](const std::string& name, void*) { return name; },
                         .ReadWholeFile = take_file,
                         .WriteWholeFile = nullptr,
                         .user_data = &buffers});
  std::string error;
  std::string warning;
  const bool is_loaded = loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                                    static_cast<unsigned int>(text.size()), "");
  if (!is_loaded || !error.empty())
    document.fail("", "cannot be read: " + error.substr(0, longest_reason), "expected a glTF 2.0 document");
}

} // namespace

void Document::fail(std::string place, std::string problem, std::string remedy) const {
  gltf::fail(file, std::move(place), std::move(problem), std::move(remedy));
}

bool Document::uses(std::string_view extension) const {
  return std::ranges::find(model.extensionsUsed, extension) != model.extensionsUsed.end();
}

std::span<const std::byte> Document::bytes_of_view(int index) const {
  const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
  const auto bytes = std::as_bytes(std::span(model.buffers[static_cast<std::size_t>(view.buffer)].data));
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    fail(fmt::format("bufferViews[{}]", index),
         fmt::format("needs bytes {} to {} of a buffer of {}", view.byteOffset,
                     view.byteOffset + view.byteLength, bytes.size()),
         "expected byteOffset + byteLength within the buffer");
  return bytes.subspan(view.byteOffset, view.byteLength);
}

Document read_document(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  const Chunks chunks = split(file, bytes);
  json checked = checked_document(file, parse<json>(file, chunks.text));
  Document document{.file = file};
  // Images are read when a material uses them.
  for (const json& image : checked["images"]) {
    document.images.push_back({.view = image.value("bufferView", -1)});
    if (image.contains("uri")) document.images.back().uri = image["uri"];
  }
  checked.erase("images");
  // tinygltf decodes URIs otherwise than the format says: it gets names of buffers that are there.
  Files buffers;
  for (json& buffer : checked["buffers"]) {
    const std::string place = fmt::format("buffers[{}]", buffers.size());
    buffers[place] = read_buffer(file, buffer, place, chunks);
    buffer["uri"] = place;
  }
  load(document, checked.dump(), buffers);
  return document;
}

ordered_json read_json(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  return parse<ordered_json>(file, split(file, bytes).text,
                             [&](int depth, ordered_json::parse_event_t, const ordered_json&) {
                               if (depth > deepest_nesting)
                                 fail(file, "", fmt::format("is nested deeper than {}", deepest_nesting),
                                      "expected a glTF 2.0 document");
                               return true;
                             });
}

} // namespace surfgrad::io::gltf
