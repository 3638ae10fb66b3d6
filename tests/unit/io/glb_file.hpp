#pragma once

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace surfgrad::io::test {

/// A written file: its JSON and its binary chunk.
struct Glb {
  nlohmann::json document;
  std::string binary;

  explicit Glb(const std::vector<std::byte>& file) {
    const auto word = [&](std::size_t offset) {
      std::uint32_t value = 0;
      std::memcpy(&value, file.data() + offset, sizeof value);
      return value;
    };
    const char* first = reinterpret_cast<const char*>(file.data());
    EXPECT_EQ(word(8), file.size());
    const std::size_t text = word(12);
    document = nlohmann::json::parse(std::string(first + 20, text));
    binary.assign(first + 20 + text + 8, word(20 + text));
    EXPECT_EQ(document["buffers"][0]["byteLength"], binary.size());
  }

  [[nodiscard]] std::string view(std::size_t index) const {
    const nlohmann::json& entry = document["bufferViews"][index];
    return binary.substr(entry["byteOffset"], entry["byteLength"]);
  }
  /// The elements of an accessor that fills its view.
  template <class T>
  [[nodiscard]] std::vector<T> elements(const nlohmann::json& accessor) const {
    const std::string bytes = view(document["accessors"][accessor.get<std::size_t>()]["bufferView"]);
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
  }
};

} // namespace surfgrad::io::test
