#include "stack/layers/decal.hpp"

#include "stack/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surfgrad::stack {
namespace {

using enum DecalShape;

/// A key that says nothing about some shapes.
struct ShapeKey {
  std::string_view key;
  std::vector<DecalShape> shapes;
};

const std::vector<ShapeKey>& shape_keys() {
  static const std::vector<ShapeKey> keys = {
      {"size", {box}},
      {"angle", {cone, wedge}},
      {"depth", {cone, wedge}},
      {"gradient", {cone, wedge}},
      {"radius", {sphere, capsule}},
      {"length", {capsule, wedge}},
  };
  return keys;
}

/// Every key of a map is one of an image: a cube map of normals lies over all directions.
std::vector<ShapeKey> with_map_keys(std::vector<ShapeKey> keys) {
  for (const Field<BumpMap>& field : BumpMap::fields().fields())
    keys.push_back({field.format.key, {box, cone, wedge}});
  return keys;
}

std::string_view word_of(DecalShape shape) {
  for (const auto& word : words_of<DecalShape>)
    if (word.value == shape) return word.text;
  return {};
}

void require_shape(DecalShape shape, const Value& value, const std::vector<ShapeKey>& keys) {
  for (const ShapeKey& rule : keys) {
    const Member* member = value.find(rule.key);
    if (member == nullptr || std::find(rule.shapes.begin(), rule.shapes.end(), shape) != rule.shapes.end())
      continue;
    std::vector<std::string> shapes;
    for (const DecalShape s : rule.shapes) shapes.push_back(quote(word_of(s)));
    value.member(*member).fail(fmt::format("does not apply to a {}", word_of(shape)),
                               fmt::format("leave it out, or give \"shape\": {}", fmt::join(shapes, " or ")));
  }
}

void read_size(DecalPlacement& placement, const Value& value, const Shape& shape) {
  const auto* elements = std::get_if<std::vector<Node>>(&value.node.value);
  if (elements == nullptr && !std::holds_alternative<double>(value.node.value))
    value.reject(expectation(shape));
  if (elements != nullptr && elements->size() != 3) value.reject(expectation(shape));
  const auto edge = [&](std::size_t i) {
    return read_number(elements == nullptr ? value : value.element(i),
                       {.kind = Shape::Kind::number, .range = {.least = 0, .excludes_least = true}});
  };
  placement.size = {edge(0), edge(1), edge(2)};
}

/// Columns that span no space, that lean, or a last row of another kind of transform.
void check_transform(const std::array<double, 16>& m, const Value& value) {
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    value.fail("is not affine: its last row is not 0 0 0 1",
               "expected 16 numbers, column by column, each fourth of them 0, 0, 0 and 1");
  const auto column = [&](std::size_t i) {
    return normalize_or_zero(vec3<double>{m[4 * i], m[4 * i + 1], m[4 * i + 2]});
  };
  const vec3<double> x = column(0), y = column(1), z = column(2);
  // Exporters round to float: some 1e-7.
  constexpr double rounding = 1e-5;
  if (std::abs(dot(x, cross(y, z))) < rounding)
    value.fail("is singular: its columns span no space",
               "expected three columns that are perpendicular and not zero");
  if (std::max({std::abs(dot(x, y)), std::abs(dot(y, z)), std::abs(dot(z, x))}) > rounding)
    value.fail("shears: its columns are not perpendicular", "expected a rotation, a translation and a scale");
}

void read_transform(DecalPlacement& placement, const Value& value, const Shape& shape) {
  const std::vector<double> numbers = read_vector(value, shape);
  placement.transform.emplace();
  std::copy(numbers.begin(), numbers.end(), placement.transform->begin());
  check_transform(*placement.transform, value);
}

void check_placement(DecalPlacement& placement, const Value& value) {
  const Member* transform = value.find("transform");
  for (const std::string_view key : {"position", "direction", "roll"}) {
    const Member* member = value.find(key);
    if (member == nullptr) continue;
    if (transform != nullptr)
      value.member(*member).fail("is given beside a \"transform\"", "give one of them");
    if (placement.transform) // that of the layer, which would lose its other parts
      value.member(*member).fail(
          "is given beside the layer's \"transform\"",
          "give the instance a \"transform\" of its own, or place the layer without one");
  }
  if (max_abs(normalize_or_zero(placement.direction)) == 0)
    value.member(*value.find("direction"))
        .fail("is the zero vector", "expected the direction in which the decal projects");
}

/// Only a box may have three scales.
void require_even_scale(const DecalPlacement& placement, DecalShape shape, const Value& value) {
  const Member* transform = value.find("transform");
  if (transform == nullptr || shape == box) return;
  const std::array<double, 16>& m = *placement.transform;
  const auto size = [&](std::size_t i) { return length(vec3<double>{m[4 * i], m[4 * i + 1], m[4 * i + 2]}); };
  // Exporters round to float: some 1e-7.
  if (std::max({size(0), size(1), size(2)}) > (1 + 1e-5) * std::min({size(0), size(1), size(2)}))
    value.member(*transform)
        .fail(fmt::format("scales a {} unevenly", word_of(shape)),
              "expected columns of one length, or \"shape\": \"box\"");
}

void check_files(const DecalLayer& layer, const Value& value) {
  if (layer.files.size() == 1 || layer.shape == sphere || layer.shape == capsule) return;
  value.member(*value.find("map"))
      .fail(fmt::format("is an array of {} files", layer.files.size()),
            fmt::format("a {} takes one image; the faces of a cube are for a sphere or capsule",
                        word_of(layer.shape)));
}

/// After all other keys: instances begin as the layer's own placement.
void read_instances(DecalLayer& layer, const Value& value) {
  require_even_scale(layer.instances[0], layer.shape, value);
  const Member* member = value.find("instances");
  if (member == nullptr) return;
  const DecalInstance start = layer.instances[0];
  const Value list = value.member(*member);
  const std::size_t count = list.elements().size();
  layer.instances.assign(count, start);
  for (std::size_t i = 0; i < count; ++i) {
    const Value element = list.element(i);
    read_object(element, layer.instances[i]);
    require_shape(layer.shape, element, shape_keys());
    require_even_scale(layer.instances[i], layer.shape, element);
  }
}

} // namespace

const Fields<DecalPlacement>& DecalPlacement::fields() {
  constexpr Range positive{.least = 0, .excludes_least = true};
  static const auto table =
      Fields<DecalPlacement>()
          .vector("position", &DecalPlacement::position)
          .vector("direction", &DecalPlacement::direction)
          .number("roll", &DecalPlacement::roll_deg)
          .add("transform", {.kind = Shape::Kind::vector, .components = 16}, read_transform)
          .add("size", {.kind = Shape::Kind::size}, read_size)
          .number("angle", &DecalPlacement::angle_deg,
                  {.least = 0, .most = 180, .excludes_least = true, .excludes_most = true})
          .number("depth", &DecalPlacement::depth, positive)
          .number("radius", &DecalPlacement::radius, positive)
          .number("length", &DecalPlacement::length, {.least = 0})
          .finally(check_placement);
  return table;
}

const Fields<DecalInstance>& DecalInstance::fields() {
  static const auto table = Fields<DecalInstance>()
                                .base<DecalPlacement>()
                                .number("scale", &DecalInstance::scale)
                                .number("opacity", &DecalInstance::opacity, {.least = 0, .most = 1})
                                .word("blend", &DecalInstance::blend);
  return table;
}

const Fields<DecalLayer>& DecalLayer::fields() {
  static const auto table =
      Fields<DecalLayer>()
          .type(type)
          .word("shape", &DecalLayer::shape)
          .files("map", &DecalLayer::files, {6})
          .required()
          .part(&DecalLayer::map)
          .word("space", &DecalLayer::space)
          .number("falloff", &DecalLayer::falloff, {.least = 0, .most = 1})
          .word("gradient", &DecalLayer::gradient)
          .part<DecalPlacement>([](DecalLayer& layer) -> DecalPlacement& { return layer.instances[0]; })
          .add("instances", {.kind = Shape::Kind::objects, .object = DecalInstance::format_name},
               [](DecalLayer&, const Value& value, const Shape&) {
                 static_cast<void>(value.elements());
               }) // read_instances does
          .part(&DecalLayer::common)
          .word("blend", &DecalLayer::blend)
          .finally([](DecalLayer& layer, const Value& value) {
            static const std::vector<ShapeKey> keys = with_map_keys(shape_keys());
            require_shape(layer.shape, value, keys);
            check_files(layer, value);
            read_instances(layer, value);
          });
  return table;
}

} // namespace surfgrad::stack
