#include "io/gltf_buffer.hpp"

#include "io/file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <system_error>

namespace surfgrad::io::gltf {
namespace {

constexpr std::size_t largest_stride = 252; // the format's own limit

// URIs may be megabytes of data: a message shows their beginning.
constexpr std::size_t longest_quote = 60;

std::string quoted(const std::string& uri) {
  return uri.size() > longest_quote ? fmt::format("\"{}...\"", uri.substr(0, longest_quote))
                                    : fmt::format("\"{}\"", uri);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// RFC 3986: a letter, then letters, digits, + - . up to the colon.
bool has_scheme(std::string_view uri) {
  if (uri.empty() || !is_letter(uri.front())) return false;
  const auto end = std::ranges::find_if_not(
      uri, [](char c) { return is_letter(c) || is_digit(c) || c == '+' || c == '-' || c == '.'; });
  return end != uri.end() && *end == ':';
}

/// Value of a hexadecimal digit, or -1.
int hex_value(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string percent_decoded(const Element& uri) {
  const std::string& text = uri.text();
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hex_value(text[i + 2]) : -1;
    if (high < 0 || low < 0)
      uri.fail(fmt::format("{} has a broken percent code", quoted(text)),
               "expected % and two hexadecimal digits");
    result += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return result;
}

bool has_parent_segment(std::string_view path) {
  while (true) {
    const auto slash = path.find('/');
    if (path.substr(0, slash) == "..") return true;
    if (slash == path.npos) return false;
    path.remove_prefix(slash + 1);
  }
}

/// Value of a base64 digit, or 64.
constexpr std::array<std::uint8_t, 256> base64_values = [] {
  std::array<std::uint8_t, 256> values{};
  values.fill(64);
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < digits.size(); ++i)
    values[static_cast<unsigned char>(digits[i])] = static_cast<std::uint8_t>(i);
  return values;
}();

} // namespace

std::filesystem::path resolve_uri(const Element& uri) {
  const std::string& text = uri.text();
  const char* remedy = "expected the name of a file in the model's folder or below, or a data: URI";
  if (has_scheme(text)) uri.fail(fmt::format("{} names a scheme", quoted(text)), remedy);
  const std::string decoded = percent_decoded(uri);
  if (decoded.empty()) uri.fail("is empty", remedy);
  if (decoded.front() == '/') uri.fail(fmt::format("{} is an absolute path", quoted(text)), remedy);
  if (has_parent_segment(decoded))
    uri.fail(fmt::format("{} leaves the model's folder", quoted(text)), remedy);
  // A backslash separates folders on some systems only; a control character has no place in a name.
  for (const char c : decoded)
    if (c == '\\' || static_cast<unsigned char>(c) < 0x20)
      uri.fail(fmt::format("{} has a backslash or control character", quoted(text)), remedy);
  const std::filesystem::path name(std::u8string(decoded.begin(), decoded.end()));
  std::filesystem::path file = uri.document().file().parent_path() / name;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    uri.fail(fmt::format("{} does not exist", file.string()), "expected a file that the model comes with");
  return file;
}

std::optional<std::vector<std::byte>> decode_data_uri(const Element& uri) {
  std::string_view text = uri.text();
  if (!text.starts_with("data:")) return std::nullopt;
  const auto comma = text.find(',');
  if (comma == text.npos || !text.substr(0, comma).ends_with(";base64"))
    uri.fail(fmt::format("{} is not base64", quoted(uri.text())), "expected data:<type>;base64,<data>");
  text.remove_prefix(comma + 1);
  while (text.ends_with('=')) text.remove_suffix(1);

  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::uint32_t value = base64_values[static_cast<unsigned char>(text[i])];
    if (value == 64)
      uri.fail(fmt::format("has a wrong base64 digit at data character {}", i), "expected A-Z a-z 0-9 + /");
    bits = (bits << 6 | value) & 0xFFFF;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xFF));
  }
  return bytes;
}

std::span<const std::byte> Buffers::buffer(const Element& reference) {
  const std::size_t index = reference.index_into("buffers");
  const Element element = document_->entry("buffers", index);
  std::span<const std::byte> bytes;
  if (const auto uri = element.find("uri")) {
    auto& loaded = loaded_[index];
    if (!loaded) {
      loaded = decode_data_uri(*uri);
      if (!loaded) loaded = read_file(resolve_uri(*uri));
    }
    bytes = *loaded;
  } else if (const auto chunk = document_->binary_chunk(); chunk && index == 0) {
    bytes = *chunk;
  } else {
    element.fail("has no \"uri\" and no binary chunk", "expected a \"uri\", or the first buffer of a GLB");
  }
  const Element length = element.at("byteLength");
  if (length.whole() > bytes.size())
    length.fail(fmt::format("is {} but the data has {} bytes", length.whole(), bytes.size()),
                "expected the whole buffer");
  return bytes.first(length.whole());
}

BufferView Buffers::view(const Element& reference) {
  const Element element = reference.entry_of("bufferViews");
  const std::span<const std::byte> bytes = buffer(element.at("buffer"));
  const std::size_t offset = element.whole_or("byteOffset", 0);
  const std::size_t length = element.at("byteLength").whole();
  if (offset > bytes.size() || length > bytes.size() - offset)
    element.fail(fmt::format("needs bytes {} to {} of a buffer of {}", offset, offset + length, bytes.size()),
                 "expected byteOffset + byteLength within the buffer");
  std::size_t stride = 0;
  if (const auto given = element.find("byteStride")) {
    stride = given->whole();
    if (stride == 0 || stride > largest_stride)
      given->fail(fmt::format("is {}", stride), fmt::format("expected 4 to {}", largest_stride));
  }
  return {bytes.subspan(offset, length), stride};
}

} // namespace surfgrad::io::gltf
