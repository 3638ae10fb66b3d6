#include "stack/map.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

void read_tile(Tiled& tiled, const Value& value, const Shape& shape) {
  const auto* one = std::get_if<double>(&value.node.value);
  const auto* two = std::get_if<std::vector<Node>>(&value.node.value);
  if (one == nullptr && (two == nullptr || two->size() != 2)) value.reject(expectation(shape));
  const auto component = [&](const Value& part) {
    const double number = read_number(part, {.kind = Shape::Kind::number});
    if (number == 0) part.reject("a number other than zero");
    return number;
  };
  if (one != nullptr) {
    const double both = component(value);
    tiled.tile = {both, both};
  } else {
    tiled.tile = {component(value.element(0)), component(value.element(1))};
  }
}

/// Hex tiles show a map beyond its borders, which must therefore continue across them.
void check_tiling(const Tiled& tiled, const Value& value) {
  const Member* turn = value.find("hex_turn");
  if (tiled.tiling != Tiling::hex) {
    if (turn != nullptr)
      value.member(*turn).fail("does not apply to plain tiling", R"(leave it out, or give "tiling": "hex")");
    return;
  }
  if (tiled.wrap == Wrap::repeat) return;
  const Member* wrap = value.find("wrap");
  value.member(wrap != nullptr ? *wrap : *value.find("tiling"))
      .fail("hex tiling needs a map that repeats", R"(expected "wrap": "repeat", or no "tiling")");
}

/// A number of probes that no filter takes is a slip.
void check_anisotropy(const Tiled& tiled, const Value& value) {
  const Member* anisotropy = value.find("anisotropy");
  if (tiled.filter != Filter::anisotropic && anisotropy != nullptr)
    value.member(*anisotropy)
        .fail("does not apply to this filter", R"(leave it out, or give "filter": "anisotropic")");
}

} // namespace

void refuse_normal_filter(const Tiled& tiled, const Value& value, const char* what) {
  if (tiled.filter == Filter::normal)
    value.member(*value.find("filter"))
        .fail(std::string(R"(is "normal", but this is )") + what,
              "expected one of: nearest, bilinear, trilinear, anisotropic");
}

void refuse_hex_tiling(const Tiled& tiled, const Value& value, const char* why) {
  if (tiled.tiling == Tiling::hex)
    value.member(*value.find("tiling")).fail(std::string(R"(is "hex", but )") + why, "leave it out");
}

const Fields<Tiled>& Tiled::fields() {
  static const auto table = Fields<Tiled>()
                                .add("tile", {.kind = Shape::Kind::tile}, read_tile)
                                .number("rotate", &Tiled::rotate_deg)
                                .vector("offset", &Tiled::offset)
                                .word("wrap", &Tiled::wrap)
                                .word("filter", &Tiled::filter)
                                .integer("anisotropy", &Tiled::anisotropy, {.least = 1, .most = 16})
                                .word("tiling", &Tiled::tiling)
                                .number("hex_turn", &Tiled::hex_turn_deg, {.least = 0, .most = 180})
                                .finally(check_anisotropy)
                                .finally(check_tiling);
  return table;
}

const Fields<Texture>& Texture::fields() {
  static const auto table = Fields<Texture>()
                                .file("map", &Texture::file)
                                .required()
                                .integer("uv", &Texture::uv, {.least = 0, .most = 7})
                                .base<Tiled>()
                                .finally([](Texture& texture, const Value& value) {
                                  const Member* given = value.find("uv");
                                  texture.uv_line = given != nullptr ? given->node.line : value.node.line;
                                });
  return table;
}

const Fields<Map>& Map::fields() {
  static const auto table = Fields<Map>().base<Texture>().word("green", &Map::green);
  return table;
}

const Fields<TangentMap>& TangentMap::fields() {
  static const auto table = Fields<TangentMap>().base<Map>().word("channels", &TangentMap::channels);
  return table;
}

const Fields<Mask>& Mask::fields() {
  static const auto table =
      Fields<Mask>()
          .base<Texture>()
          .word("channel", &Mask::channel)
          .finally([](Mask& mask, const Value& value) { refuse_normal_filter(mask, value, "a mask"); });
  return table;
}

} // namespace surfgrad::stack
