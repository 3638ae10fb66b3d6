#pragma once

#include "support/temporary_folder.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::io::test {

using surfgrad::test::TemporaryFolder;

inline std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A glTF document under construction with one buffer.
struct Gltf {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::string buffer{};

  /// Appends to the buffer, 4-byte aligned, as a bufferView; its index.
  std::size_t view(std::string_view bytes, std::size_t stride = 0) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    nlohmann::json entry = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) entry["byteStride"] = stride;
    buffer += bytes;
    json["bufferViews"].push_back(entry);
    return json["bufferViews"].size() - 1;
  }

  template <class T>
  std::size_t view(const std::vector<T>& values) {
    return view(std::string_view(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
  }

  /// An accessor over its own bufferView; its index. The component type follows from T.
  template <class T>
  std::size_t accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
    nlohmann::json entry = {{"bufferView", view(values)},
                            {"componentType", component_type<T>()},
                            {"count", values.size() / components},
                            {"type", type}};
    if (normalized) entry["normalized"] = true;
    json["accessors"].push_back(entry);
    return json["accessors"].size() - 1;
  }

  /// A node that shows a new mesh of these primitives.
  void mesh(const nlohmann::json& primitives) {
    json["meshes"].push_back({{"primitives", primitives}});
    json["nodes"].push_back({{"mesh", json["meshes"].size() - 1}});
  }

  [[nodiscard]] std::string gltf() const {
    nlohmann::json document = json;
    if (!document.contains("buffers"))
      document["buffers"] = {
          {{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
    return document.dump(1);
  }

  [[nodiscard]] std::string glb() const {
    nlohmann::json document = json;
    document["buffers"] = {{{"byteLength", buffer.size()}}};
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string binary = buffer;
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto word = [](std::size_t value) {
      const auto word32 = static_cast<std::uint32_t>(value);
      std::string bytes(4, '\0');
      std::memcpy(bytes.data(), &word32, 4);
      return bytes;
    };
    return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + binary.size()) + word(text.size()) + "JSON" +
           text + word(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  template <class T>
  static int component_type() {
    if (std::is_same_v<T, std::int8_t>) return 5120;
    if (std::is_same_v<T, std::uint8_t>) return 5121;
    if (std::is_same_v<T, std::int16_t>) return 5122;
    if (std::is_same_v<T, std::uint16_t>) return 5123;
    if (std::is_same_v<T, std::uint32_t>) return 5125;
    return 5126;
  }
};

/// Accessors 0 POSITION, 1 NORMAL, 2 TEXCOORD_0, 3 indices of one triangle in the plane z = 0, and
/// a node that shows it.
inline Gltf triangle() {
  Gltf document;
  document.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  document.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  document.accessor<float>({0, 0, 1, 0.25f, 0, 1}, "VEC2");
  document.accessor<std::uint16_t>({0, 1, 2}, "SCALAR");
  document.mesh({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}}});
  return document;
}

} // namespace surfgrad::io::test
