#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <variant>
#include <vector>

namespace surfgrad::image {

/// The float of an integer code: code / most code, correctly rounded.
[[nodiscard]] inline float from_code(std::uint8_t code) { return static_cast<float>(code) / 255.0f; }
[[nodiscard]] inline float from_code(std::uint16_t code) { return static_cast<float>(code) / 65535.0f; }

/// The values of a picture. Those of integer files stay codes of 8 or 16 bits, a quarter or half of what
/// floats take, until one of them is written to: then all become floats. Readers see floats either way.
class Texels {
 public:
  using Codes8 = std::vector<std::uint8_t>;
  using Codes16 = std::vector<std::uint16_t>;
  using Floats = std::vector<float>;
  using value_type = float;

  Texels() = default;
  Texels(Floats values) : values_(std::move(values)) {}
  Texels(std::initializer_list<float> values) : values_(Floats(values)) {}
  explicit Texels(Codes8 codes) : values_(std::move(codes)) {}
  explicit Texels(Codes16 codes) : values_(std::move(codes)) {}

  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& values) { return values.size(); }, values_);
  }
  [[nodiscard]] bool empty() const { return size() == 0; }
  /// What they take.
  [[nodiscard]] std::size_t bytes() const {
    return std::visit([](const auto& values) { return values.size() * sizeof values[0]; }, values_);
  }

  [[nodiscard]] float operator[](std::size_t i) const {
    if (const auto* codes = std::get_if<Codes8>(&values_)) return from_code((*codes)[i]);
    if (const auto* codes = std::get_if<Codes16>(&values_)) return from_code((*codes)[i]);
    return std::get<Floats>(values_)[i];
  }
  [[nodiscard]] float& operator[](std::size_t i) { return floats()[i]; }

  /// `count` values that begin with this one, for readers of many.
  ///
  /// scratch  room for as many, where they are put unless they lie somewhere already
  [[nodiscard]] const float* read(std::size_t first, std::size_t count, float* scratch) const;

  /// What `reader` makes of the vector they lie in: Codes8, Codes16 or Floats.
  template <class Reader>
  decltype(auto) visit(const Reader& reader) const {
    return std::visit(reader, values_);
  }

  /// Gives back the memory of these, which must not be read again, where the system takes parts of an array
  /// (Linux, whole pages). Others may be read and given back at the same time.
  void give_back(std::size_t first, std::size_t count);

  /// All of them, to be written to.
  [[nodiscard]] Floats& floats();

  friend bool operator==(const Texels& a, const Texels& b);

 private:
  std::variant<Floats, Codes8, Codes16> values_{};
};

} // namespace surfgrad::image
