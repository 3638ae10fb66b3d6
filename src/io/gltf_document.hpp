#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::io::gltf {

class Document;

/// A value of the document that knows its place in it, e.g. `accessors[5].sparse`. Its getters
/// throw an InputError with that place unless the value is what they return. Valid as long as the
/// document is.
class Element {
 public:
  Element(const Document& document, const nlohmann::json& value, std::string place)
      : document_(&document), value_(&value), place_(std::move(place)) {}

  [[nodiscard]] const Document& document() const { return *document_; }
  [[nodiscard]] const std::string& place() const { return place_; }
  [[noreturn]] void fail(std::string problem, std::string remedy) const;

  /// Members of an object.
  [[nodiscard]] std::optional<Element> find(std::string_view key) const;
  [[nodiscard]] Element at(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Entries of an array.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Element operator[](std::size_t index) const;

  /// A whole number from 0 to 2^53.
  [[nodiscard]] std::size_t whole() const;
  [[nodiscard]] double number() const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] const std::string& text() const;

  [[nodiscard]] std::size_t whole_or(std::string_view key, std::size_t fallback) const;
  [[nodiscard]] double number_or(std::string_view key, double fallback) const;
  [[nodiscard]] bool boolean_or(std::string_view key, bool fallback) const;
  [[nodiscard]] std::string text_or(std::string_view key, std::string fallback) const;
  /// An array of exactly `result.size()` numbers, if the key is there.
  bool numbers(std::string_view key, std::span<double> result) const;

  /// This value as an index into a top-level array, in range.
  [[nodiscard]] std::size_t index_into(std::string_view array) const;
  /// The entry of a top-level array that this value is the index of.
  [[nodiscard]] Element entry_of(std::string_view array) const;

 private:
  [[nodiscard]] std::string shown() const;

  const Document* document_;
  const nlohmann::json* value_;
  std::string place_;
};

/// A glTF 2.0 file taken apart: its JSON and, for a GLB, its binary chunk. Refuses other versions
/// and files that require an extension which would change what is read here.
class Document {
 public:
  /// `file` as the user named it, for messages and as the base of URIs; `bytes` its contents.
  Document(std::filesystem::path file, std::vector<std::byte> bytes);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] Element root() const;
  /// Length of a top-level array; 0 if there is none.
  [[nodiscard]] std::size_t count(std::string_view array) const;
  /// Entry of a top-level array, in range.
  [[nodiscard]] Element entry(std::string_view array, std::size_t index) const;
  [[nodiscard]] bool uses(std::string_view extension) const;
  /// The binary chunk of a GLB, if it has one.
  [[nodiscard]] std::optional<std::span<const std::byte>> binary_chunk() const { return binary_chunk_; }

 private:
  void parse(std::span<const std::byte> text);
  [[nodiscard]] std::span<const std::byte> split_glb();
  void check_version_and_extensions() const;

  std::filesystem::path file_;
  std::vector<std::byte> bytes_;
  std::optional<std::span<const std::byte>> binary_chunk_{};
  std::unique_ptr<nlohmann::json> json_;
};

} // namespace surfgrad::io::gltf
