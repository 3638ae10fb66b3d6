#include "stack/stack.hpp"

#include "diagnostic/error.hpp"
#include "stack/fields.hpp"

#include <fmt/format.h>

namespace surfgrad::stack {
namespace {

/// What the parser needs of a layer kind, whichever it is.
struct Kind {
  std::string_view type;
  bool opens_pass; ///< comes first in a list, or directly after a resolve
  Layer (*read)(const Value&);
  ObjectFormat (*format)();
};

template <class K>
constexpr bool opens_pass() {
  if constexpr (requires { K::opens_pass; }) return true;
  return false;
}

template <class... Kinds>
std::vector<Kind> kinds_of(const std::variant<Kinds...>*) {
  return {Kind{.type = Kinds::type,
               .opens_pass = opens_pass<Kinds>(),
               .read =
                   [](const Value& value) {
                     Kinds layer;
                     read_object(value, layer);
                     return Layer(std::move(layer));
                   },
               .format = [] { return Kinds::fields().format(Kinds::type, true); }}...};
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> table = kinds_of(static_cast<const Layer*>(nullptr));
  return table;
}

const Kind& kind_of(const Value& value) {
  Shape types{.kind = Shape::Kind::word};
  for (const Kind& kind : kinds()) types.words.push_back(kind.type);
  const Member* type = value.find("type");
  if (type == nullptr) value.fail(R"(lacks "type")", "expected \"type\": " + expectation(types));
  return kinds()[read_word(value.member(*type), types)];
}

std::vector<Layer> read_layers(const Value& value) {
  std::vector<Layer> layers;
  const std::size_t count = value.elements().size();
  for (std::size_t i = 0; i < count; ++i) {
    const Value element = value.element(i);
    const Kind& kind = kind_of(element);
    if (kind.opens_pass && i > 0 && !std::holds_alternative<ResolveLayer>(layers.back()))
      element.fail(fmt::format("{} follows another layer in its pass", quote(kind.type)),
                   R"(put it first in the list, or a layer { "type": "resolve" } right before it)");
    layers.push_back(kind.read(element));
  }
  return layers;
}

void read_materials(Stack& stack, const Value& value) {
  for (const Member& member : value.members()) {
    const Value layers = value.member(member);
    stack.materials[member.key] = {
        .line = layers.node.line, .key = layers.key, .layers = read_layers(layers)};
  }
}

/// Comes before all other keys: a newer document may well have keys this program does not know.
void check_version(const Value& document) {
  const std::string one = fmt::format("\"surfgrad\": {}", Stack::format_version);
  const Member* member = document.find("surfgrad");
  if (member == nullptr) document.fail(R"(lacks "surfgrad", the version of the format)", "expected " + one);
  const Value version = document.member(*member);
  const double number = read_number(version, {.kind = Shape::Kind::number});
  if (number > Stack::format_version)
    version.fail(fmt::format("is {}: the document was written by a newer surfgrad", number),
                 fmt::format("this one reads version {}", Stack::format_version));
  if (number != Stack::format_version)
    version.reject(fmt::format("the version of the format, {}", Stack::format_version));
}

} // namespace

const Fields<Stack>& Stack::fields() {
  static const auto table =
      Fields<Stack>()
          .add("surfgrad",
               {.kind = Shape::Kind::integer,
                .range = {.least = Stack::format_version, .most = Stack::format_version}},
               [](Stack&, const Value&, const Shape&) {}) // check_version has read it
          .required()
          .add("$schema", {.kind = Shape::Kind::text},
               [](Stack&, const Value& value, const Shape& shape) {
                 static_cast<void>(read_text(value, shape));
               })
          .file("mesh", &Stack::mesh)
          .add("morph", {.kind = Shape::Kind::numbers},
               [](Stack& stack, const Value& value, const Shape& shape) {
                 stack.morph = {read_numbers(value, shape), value.node.line};
               })
          .object("displace", &Stack::displace)
          .word("back_faces", &Stack::back_faces)
          .add("layers", {.kind = Shape::Kind::layers},
               [](Stack& stack, const Value& value, const Shape&) {
                 stack.has_layers = true;
                 stack.layers = read_layers(value);
               })
          .add("materials", {.kind = Shape::Kind::materials},
               [](Stack& stack, const Value& value, const Shape&) { read_materials(stack, value); })
          .object("camera", &Stack::camera)
          .object("lights", &Stack::lights);
  return table;
}

std::vector<ObjectFormat> document_format() {
  std::vector<ObjectFormat> objects{Stack::fields().format(Stack::format_name),
                                    Mask::fields().format(Mask::format_name),
                                    Displace::fields().format(Displace::format_name),
                                    DisplacementMap::fields().format(DisplacementMap::format_name),
                                    Convention::fields().format(Convention::format_name),
                                    Camera::fields().format(Camera::format_name),
                                    Lights::fields().format(Lights::format_name),
                                    Sun::fields().format(Sun::format_name),
                                    DecalInstance::fields().format(DecalInstance::format_name)};
  for (const Kind& kind : kinds()) objects.push_back(kind.format());
  return objects;
}

Stack parse_stack(std::string_view text, const std::filesystem::path& name) {
  const Node root = parse_json(text, name);
  const Value document{root, "", name};
  check_version(document);
  Stack stack;
  stack.file = name;
  read_object(document, stack);
  return stack;
}

} // namespace surfgrad::stack
