#include "io/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace surfgrad::io::gltf {
namespace {

/// The format's numbers for component types.
enum class Component : std::size_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

// No byte of the file stands behind the zeros of an accessor without a bufferView, so only this
// bounds them: more vertices than any mesh that is edited by hand, 256 MB as vec4.
constexpr std::size_t most_unbacked_elements = std::size_t{1} << 24;

struct AttributeFormat {
  std::string_view type;
  std::size_t components;
};

AttributeFormat format_of(Attribute attribute) {
  switch (attribute) {
  case Attribute::position:
  case Attribute::normal:
    return {"VEC3", 3};
  case Attribute::tangent:
    return {"VEC4", 4};
  case Attribute::texcoord:
    break;
  }
  return {"VEC2", 2};
}

std::size_t size_of(Component component) {
  switch (component) {
  case Component::i8:
  case Component::u8:
    return 1;
  case Component::i16:
  case Component::u16:
    return 2;
  case Component::u32:
  case Component::f32:
    break;
  }
  return 4;
}

template <class T>
T load(const std::byte* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// One component as a float: integers as they are, or scaled to [0, 1] or [-1, 1].
float load_float(const std::byte* bytes, Component component, bool normalized) {
  switch (component) {
  case Component::i8: {
    const auto value = static_cast<float>(load<std::int8_t>(bytes));
    return normalized ? std::max(value / 127.0f, -1.0f) : value;
  }
  case Component::u8: {
    const auto value = static_cast<float>(load<std::uint8_t>(bytes));
    return normalized ? value / 255.0f : value;
  }
  case Component::i16: {
    const auto value = static_cast<float>(load<std::int16_t>(bytes));
    return normalized ? std::max(value / 32767.0f, -1.0f) : value;
  }
  case Component::u16: {
    const auto value = static_cast<float>(load<std::uint16_t>(bytes));
    return normalized ? value / 65535.0f : value;
  }
  case Component::u32:
    return static_cast<float>(load<std::uint32_t>(bytes));
  case Component::f32:
    break;
  }
  return load<float>(bytes);
}

std::uint32_t load_index(const std::byte* bytes, Component component) {
  if (component == Component::u8) return load<std::uint8_t>(bytes);
  if (component == Component::u16) return load<std::uint16_t>(bytes);
  return load<std::uint32_t>(bytes);
}

/// Elements in a bufferView, all within it.
struct Elements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
};

/// `count` elements of `element_size` bytes at the bufferView and byteOffset that `holder` names.
Elements elements_of(const Element& holder, std::size_t count, std::size_t element_size, Buffers& buffers) {
  const BufferView view = buffers.view(holder.at("bufferView"));
  const std::size_t offset = holder.whole_or("byteOffset", 0);
  const std::size_t stride = view.stride == 0 ? element_size : view.stride;
  if (stride < element_size)
    holder.fail(fmt::format("byteStride {} is less than the element's {} bytes", stride, element_size),
                "expected elements that do not overlap");
  const std::size_t size = view.bytes.size();
  // Ordered so that no sum or product can overflow.
  const bool fits = count > 0 && offset <= size && element_size <= size - offset &&
                    count - 1 <= (size - offset - element_size) / stride;
  if (!fits)
    holder.fail(fmt::format("{} elements of {} bytes from byte {} do not fit a bufferView of {} bytes", count,
                            element_size, offset, size),
                "expected elements within the bufferView");
  return {view.bytes.data() + offset, stride};
}

Component component_of(const Element& holder, std::string_view expected) {
  const Element type = holder.at("componentType");
  switch (const auto component = static_cast<Component>(type.whole())) {
  case Component::i8:
  case Component::u8:
  case Component::i16:
  case Component::u16:
  case Component::u32:
  case Component::f32:
    return component;
  }
  type.fail(fmt::format("is {}", type.whole()), fmt::format("expected {}", expected));
}

Component index_component(const Element& holder) {
  constexpr std::string_view expected = "5121, 5123 or 5125 (unsigned integers)";
  const Component component = component_of(holder, expected);
  if (component != Component::u8 && component != Component::u16 && component != Component::u32)
    holder.at("componentType")
        .fail(fmt::format("is {}", static_cast<std::size_t>(component)),
              fmt::format("expected {}", expected));
  return component;
}

bool is_permitted(Attribute attribute, Component component, bool normalized, bool quantized) {
  const bool is_unsigned = component == Component::u8 || component == Component::u16;
  const bool is_signed = component == Component::i8 || component == Component::i16;
  if (component == Component::f32) return !normalized;
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

void require_type(const Element& accessor, std::string_view expected) {
  const Element type = accessor.at("type");
  if (type.text() != expected)
    type.fail(fmt::format("is \"{}\"", type.text()), fmt::format("expected \"{}\"", expected));
}

/// Number of elements: at least one, and few enough for 32-bit vertex indices.
std::size_t count_of(const Element& accessor) {
  const Element count = accessor.at("count");
  if (count.whole() == 0 || count.whole() > std::numeric_limits<std::uint32_t>::max())
    count.fail(fmt::format("is {}", count.whole()), "expected 1 to 4294967295");
  return count.whole();
}

/// Calls `store(element, bytes)` for the elements that a sparse accessor replaces.
template <class Store>
void for_each_sparse(const Element& accessor, std::size_t count, std::size_t element_size, Buffers& buffers,
                     const Store& store) {
  const auto sparse = accessor.find("sparse");
  if (!sparse) return;
  const std::size_t replaced = sparse->at("count").whole();
  const Element indices = sparse->at("indices");
  const Component component = index_component(indices);
  const Elements targets = elements_of(indices, replaced, size_of(component), buffers);
  const Elements values = elements_of(sparse->at("values"), replaced, element_size, buffers);
  for (std::size_t i = 0; i < replaced; ++i) {
    const std::uint32_t target = load_index(targets.first + i * targets.stride, component);
    if (target >= count)
      indices.fail(fmt::format("entry {} is {} but the accessor has {} elements", i, target, count),
                   "expected indices of its elements");
    store(target, values.first + i * values.stride);
  }
}

} // namespace

std::size_t component_count(Attribute attribute) { return format_of(attribute).components; }

std::vector<float> read_attribute(const Element& reference, Attribute attribute, Buffers& buffers) {
  const Element accessor = reference.entry_of("accessors");
  const std::size_t components = component_count(attribute);
  require_type(accessor, format_of(attribute).type);
  const bool quantized = reference.document().uses("KHR_mesh_quantization");
  const bool normalized = accessor.boolean_or("normalized", false);
  const Component component = component_of(accessor, permitted_text(attribute, quantized));
  if (!is_permitted(attribute, component, normalized, quantized))
    accessor.at("componentType")
        .fail(fmt::format("is {}{}", static_cast<std::size_t>(component), normalized ? " normalized" : ""),
              fmt::format("expected {}", permitted_text(attribute, quantized)));

  const std::size_t count = count_of(accessor);
  const std::size_t component_size = size_of(component);
  const std::size_t element_size = component_size * components;
  std::optional<Elements> elements;
  if (accessor.find("bufferView"))
    elements = elements_of(accessor, count, element_size, buffers);
  else if (!accessor.find("sparse"))
    accessor.fail("has no bufferView and no sparse values", "expected data that is not compressed");
  else if (count > most_unbacked_elements)
    accessor.fail(fmt::format("has {} elements and no bufferView", count),
                  fmt::format("expected a bufferView, or at most {} elements", most_unbacked_elements));

  std::vector<float> values(count * components, 0.0f);
  const auto store = [&](std::size_t element, const std::byte* bytes) {
    for (std::size_t c = 0; c < components; ++c)
      values[element * components + c] = load_float(bytes + c * component_size, component, normalized);
  };
  if (elements)
    for (std::size_t i = 0; i < count; ++i) store(i, elements->first + i * elements->stride);
  for_each_sparse(accessor, count, element_size, buffers, store);

  const auto bad = std::ranges::find_if_not(values, [](float value) { return std::isfinite(value); });
  if (bad != values.end())
    reference.fail(
        fmt::format("vertex {} is {}", static_cast<std::size_t>(bad - values.begin()) / components, *bad),
        "expected finite numbers");
  return values;
}

std::vector<std::uint32_t> read_indices(const Element& reference, std::size_t vertex_count,
                                        Buffers& buffers) {
  const Element accessor = reference.entry_of("accessors");
  require_type(accessor, "SCALAR");
  const Component component = index_component(accessor);
  const std::size_t count = count_of(accessor);
  const Elements elements = elements_of(accessor, count, size_of(component), buffers);
  std::vector<std::uint32_t> indices(count);
  const auto store = [&](std::size_t element, const std::byte* bytes) {
    indices[element] = load_index(bytes, component);
  };
  for (std::size_t i = 0; i < count; ++i) store(i, elements.first + i * elements.stride);
  for_each_sparse(accessor, count, size_of(component), buffers, store);

  for (std::size_t i = 0; i < count; ++i)
    if (indices[i] >= vertex_count)
      reference.fail(
          fmt::format("index {} is {} but the primitive has {} vertices", i, indices[i], vertex_count),
          "expected indices of its vertices");
  return indices;
}

} // namespace surfgrad::io::gltf
