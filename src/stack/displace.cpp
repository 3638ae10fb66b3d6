#include "stack/displace.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

/// Exactly one of a function and a map says how high the surface is.
void check_source(Displace& displace, const Value& value) {
  const Member* function = value.find("function");
  const Member* map = value.find("map");
  if (function == nullptr && map == nullptr)
    value.fail(R"(lacks "function" or "map")", R"(expected "function": ")" +
                                                   std::string(words_of<NoiseKind>[0].text) +
                                                   R"(" or another one, or "map": { "map": a height map })");
  if (function != nullptr && map != nullptr)
    value.fail(R"(has a "function" and a "map")", "keep one: a mesh is displaced once");
  if (map != nullptr)
    for (const Field<NoiseFunction>& field : NoiseFunction::fields().fields())
      if (const Member* odd = value.find(field.format.key))
        value.member(*odd).fail("does not apply to a map", R"(leave it out, or give a "function")");
  displace.line = value.node.line;
  const Member* subdivide = value.find("subdivide");
  displace.subdivide_line = subdivide != nullptr ? subdivide->node.line : value.node.line;
}

} // namespace

const Fields<DisplacementMap>& DisplacementMap::fields() {
  static const auto table = Fields<DisplacementMap>()
                                .base<Texture>()
                                .without("filter")
                                .without("anisotropy")
                                .without("tiling")
                                .without("hex_turn")
                                .word("channel", &DisplacementMap::channel);
  return table;
}

const Fields<Displace>& Displace::fields() {
  static const auto table = Fields<Displace>()
                                .finally(check_source) // before the function looks at its keys
                                .part(&Displace::noise)
                                .object("map", &Displace::map)
                                .number("height", &Displace::height)
                                .required()
                                .number("level", &Displace::level)
                                .integer("subdivide", &Displace::subdivide, {.least = 0, .most = most_levels})
                                .word("edges", &Displace::edges);
  return table;
}

} // namespace surfgrad::stack
