#include "io/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace surfgrad::io::gltf {
namespace {

// No byte of the file stands behind the zeros of an accessor without a bufferView, so only this
// bounds them: more vertices than any mesh that is edited by hand, 256 MB as vec4.
constexpr std::size_t most_unbacked_elements = std::size_t{1} << 24;

constexpr int i8 = TINYGLTF_COMPONENT_TYPE_BYTE;
constexpr int u8 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
constexpr int i16 = TINYGLTF_COMPONENT_TYPE_SHORT;
constexpr int u16 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
constexpr int u32 = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
constexpr int f32 = TINYGLTF_COMPONENT_TYPE_FLOAT;

template <class T>
T load(const std::byte* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// An integer as it is, or scaled to [0, 1] or [-1, 1].
template <class T>
float load_scaled(const std::byte* bytes, bool normalized) {
  const auto value = static_cast<float>(load<T>(bytes));
  return normalized ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f) : value;
}

float load_float(const std::byte* bytes, int component, bool normalized) {
  if (component == i8) return load_scaled<std::int8_t>(bytes, normalized);
  if (component == u8) return load_scaled<std::uint8_t>(bytes, normalized);
  if (component == i16) return load_scaled<std::int16_t>(bytes, normalized);
  if (component == u16) return load_scaled<std::uint16_t>(bytes, normalized);
  return load<float>(bytes);
}

std::uint32_t load_index(const std::byte* bytes, int component) {
  if (component == u8) return load<std::uint8_t>(bytes);
  if (component == u16) return load<std::uint16_t>(bytes);
  return load<std::uint32_t>(bytes);
}

std::uint32_t load_bits(const std::byte* bytes, int component) {
  if (component == i8 || component == u8) return load<std::uint8_t>(bytes);
  if (component == i16 || component == u16) return load<std::uint16_t>(bytes);
  return load<std::uint32_t>(bytes);
}

/// Elements in a bufferView, all within it.
struct Elements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
};

/// `count` elements of `element_size` bytes that the object at `place` describes.
Elements elements_of(const Document& document, int view_index, std::size_t offset, std::size_t count,
                     std::size_t element_size, const std::string& place) {
  const std::span<const std::byte> bytes = document.bytes_of_view(view_index);
  const std::size_t given = document.model.bufferViews[static_cast<std::size_t>(view_index)].byteStride;
  const std::size_t stride = given == 0 ? element_size : given;
  if (stride < element_size)
    document.fail(place,
                  fmt::format("byteStride {} is less than the element's {} bytes", stride, element_size),
                  "expected elements that do not overlap");
  // Ordered so that no sum or product can overflow.
  const bool fits = count > 0 && offset <= bytes.size() && element_size <= bytes.size() - offset &&
                    count - 1 <= (bytes.size() - offset - element_size) / stride;
  if (!fits)
    document.fail(place,
                  fmt::format("{} elements of {} bytes from byte {} do not fit a bufferView of {} bytes",
                              count, element_size, offset, bytes.size()),
                  "expected elements within the bufferView");
  return {bytes.data() + offset, stride};
}

void require_index_component(const Document& document, int component, const std::string& place) {
  if (component != u8 && component != u16 && component != u32)
    document.fail(place + ".componentType", fmt::format("is {}", component),
                  "expected 5121, 5123 or 5125 (unsigned integers)");
}

std::string name_of(int type) {
  if (type == TINYGLTF_TYPE_SCALAR) return "SCALAR";
  constexpr int matrix_bit = TINYGLTF_TYPE_MAT2 - TINYGLTF_TYPE_VEC2;
  return fmt::format("{}{}", (type & matrix_bit) != 0 ? "MAT" : "VEC", type & ~matrix_bit);
}

void require_type(const Document& document, const tinygltf::Accessor& accessor, int type,
                  const std::string& place) {
  if (accessor.type != type)
    document.fail(place + ".type", fmt::format("is \"{}\"", name_of(accessor.type)),
                  fmt::format("expected \"{}\"", name_of(type)));
}

bool is_permitted(Attribute attribute, int component, bool normalized, bool quantized) {
  const bool is_unsigned = component == u8 || component == u16;
  const bool is_signed = component == i8 || component == i16;
  if (component == f32) return !normalized;
  if (attribute == Attribute::texcoord && is_unsigned && normalized) return true;
  if (!quantized) return false;
  if (attribute == Attribute::position || attribute == Attribute::texcoord) return is_unsigned || is_signed;
  return is_signed && normalized;
}

std::string_view permitted_text(Attribute attribute, bool quantized) {
  const bool direction = attribute == Attribute::normal || attribute == Attribute::tangent;
  if (quantized && direction) return "5126 (float), or 5120 or 5122 normalized";
  if (quantized) return "5126 (float), or 5120 to 5123";
  if (attribute == Attribute::texcoord) return "5126 (float), or 5121 or 5123 normalized";
  return "5126 (float)";
}

/// All components of an accessor in order, each made by `load(bytes, component type)`; zeros where
/// neither a bufferView nor sparse values give one.
template <class T, class Load>
std::vector<T> components_of(const Document& document, const tinygltf::Accessor& accessor,
                             const std::string& place, const Load& load_component) {
  const auto components =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const std::size_t one_component = component_size(accessor.componentType);
  const std::size_t element_size = one_component * components;
  std::optional<Elements> elements;
  if (accessor.bufferView >= 0)
    elements =
        elements_of(document, accessor.bufferView, accessor.byteOffset, accessor.count, element_size, place);
  else if (!accessor.sparse.isSparse)
    document.fail(place, "has no bufferView and no sparse values", "expected data that is not compressed");
  else if (accessor.count > most_unbacked_elements)
    document.fail(place, fmt::format("has {} elements and no bufferView", accessor.count),
                  fmt::format("expected a bufferView, or at most {} elements", most_unbacked_elements));

  std::vector<T> values(accessor.count * components, T{});
  const auto store = [&](std::size_t element, const std::byte* bytes) {
    for (std::size_t c = 0; c < components; ++c)
      values[element * components + c] = load_component(bytes + c * one_component, accessor.componentType);
  };
  if (elements)
    for (std::size_t i = 0; i < accessor.count; ++i) store(i, elements->first + i * elements->stride);
  if (!accessor.sparse.isSparse) return values;

  const auto& indices = accessor.sparse.indices;
  const auto& replacements = accessor.sparse.values;
  const auto replaced = static_cast<std::size_t>(accessor.sparse.count);
  const std::string indices_place = place + ".sparse.indices";
  require_index_component(document, indices.componentType, indices_place);
  const Elements targets =
      elements_of(document, indices.bufferView, static_cast<std::size_t>(indices.byteOffset), replaced,
                  component_size(indices.componentType), indices_place);
  const Elements sources =
      elements_of(document, replacements.bufferView, static_cast<std::size_t>(replacements.byteOffset),
                  replaced, element_size, place + ".sparse.values");
  for (std::size_t i = 0; i < replaced; ++i) {
    const std::uint32_t target = load_index(targets.first + i * targets.stride, indices.componentType);
    if (target >= accessor.count)
      document.fail(indices_place,
                    fmt::format("entry {} is {} but the accessor has {} elements", i, target, accessor.count),
                    "expected indices of its elements");
    store(target, sources.first + i * sources.stride);
  }
  return values;
}

} // namespace

std::size_t component_size(int component_type) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

std::size_t component_count(Attribute attribute) {
  if (attribute == Attribute::texcoord) return 2;
  return attribute == Attribute::tangent ? 4 : 3;
}

std::vector<float> read_attribute(const Document& document, int index, Attribute attribute,
                                  const std::string& place) {
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  const std::string accessor_place = fmt::format("accessors[{}]", index);
  const std::size_t components = component_count(attribute);
  require_type(document, accessor, static_cast<int>(components), accessor_place); // VECn is the number n
  const bool quantized = document.uses("KHR_mesh_quantization");
  if (!is_permitted(attribute, accessor.componentType, accessor.normalized, quantized))
    document.fail(accessor_place + ".componentType",
                  fmt::format("is {}{}", accessor.componentType, accessor.normalized ? " normalized" : ""),
                  fmt::format("expected {}", permitted_text(attribute, quantized)));
  std::vector<float> values =
      components_of<float>(document, accessor, accessor_place, [&](const std::byte* bytes, int component) {
        return load_float(bytes, component, accessor.normalized);
      });
  const auto bad = std::ranges::find_if_not(values, [](float value) { return std::isfinite(value); });
  if (bad != values.end())
    document.fail(
        place,
        fmt::format("vertex {} is {}", static_cast<std::size_t>(bad - values.begin()) / components, *bad),
        "expected finite numbers");
  return values;
}

std::vector<std::uint32_t> read_indices(const Document& document, int index, std::size_t vertex_count,
                                        const std::string& place) {
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  const std::string accessor_place = fmt::format("accessors[{}]", index);
  require_type(document, accessor, TINYGLTF_TYPE_SCALAR, accessor_place);
  require_index_component(document, accessor.componentType, accessor_place);
  std::vector<std::uint32_t> indices =
      components_of<std::uint32_t>(document, accessor, accessor_place, load_index);
  const auto bad = std::ranges::find_if(indices, [&](std::uint32_t i) { return i >= vertex_count; });
  if (bad != indices.end())
    document.fail(place,
                  fmt::format("index {} is {} but the primitive has {} vertices", bad - indices.begin(), *bad,
                              vertex_count),
                  "expected indices of its vertices");
  return indices;
}

std::vector<std::uint32_t> read_bits(const Document& document, int index) {
  const tinygltf::Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  const std::string place = fmt::format("accessors[{}]", index);
  const int component = accessor.componentType;
  if (component != f32 && component != u32 && component != i8 && component != u8 && component != i16 &&
      component != u16)
    document.fail(place + ".componentType", fmt::format("is {}", component),
                  "expected 5120 to 5123, 5125 or 5126");
  // Their columns begin at multiples of four bytes.
  if (accessor.type > TINYGLTF_TYPE_VEC4 && accessor.type != TINYGLTF_TYPE_SCALAR &&
      component_size(component) < sizeof(std::uint32_t))
    document.fail(place, "is a matrix of bytes or shorts", "expected floats");
  return components_of<std::uint32_t>(document, accessor, place, load_bits);
}

} // namespace surfgrad::io::gltf
