#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

namespace surfgrad::io {

/// 32 hexadecimal digits that tell contents apart: XXH3's 128 bits, the same on every machine. No proof
/// against whoever wants two contents to look the same.
[[nodiscard]] std::string digest(std::span<const std::byte> bytes);

/// The same of a content that comes piece by piece.
class Digest {
 public:
  Digest();
  ~Digest();
  void add(std::span<const std::byte> piece);
  [[nodiscard]] std::string text() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace surfgrad::io
