#include "stack/bump_map.hpp"

#include "stack/fields.hpp"

#include <algorithm>
#include <initializer_list>

namespace surfgrad::stack {
namespace {

/// A key that says nothing about this content is a slip.
template <class Word>
void require_content(Word content, const Value& value, std::string_view key,
                     std::initializer_list<Word> contents) {
  const Member* member = value.find(key);
  if (member == nullptr || std::find(contents.begin(), contents.end(), content) != contents.end()) return;
  std::string words;
  for (const auto& word : words_of<Word>)
    if (std::find(contents.begin(), contents.end(), word.value) != contents.end())
      words += (words.empty() ? "" : " or ") + quote(word.text);
  value.member(*member).fail("does not apply to this content", "leave it out, or give \"content\": " + words);
}

template <class Word>
void check_keys(Word content, const Tiled& tiled, const Value& value) {
  require_content(content, value, "channels", {Word::normal});
  if constexpr (requires { Word::object_normal; }) {
    require_content(content, value, "green", {Word::normal, Word::derivative, Word::object_normal});
    // Whole normals do not turn with the tiles of a map.
    require_content(content, value, "tiling", {Word::normal, Word::derivative, Word::height});
  } else {
    require_content(content, value, "green", {Word::normal, Word::derivative});
  }
  require_content(content, value, "range", {Word::derivative});
  require_content(content, value, "neutral", {Word::derivative});
  require_content(content, value, "channel", {Word::height});
  require_content(content, value, "height", {Word::height});
  if (content != Word::normal) refuse_normal_filter(tiled, value, "no map of tangent-space normals");
}

/// The table of a map that has a content of its own beside the codes.
template <class Map>
Fields<Map> with_content() {
  return Fields<Map>()
      .word("content", &Map::content)
      .template base<BumpCodes>()
      .finally([](Map& map, const Value& value) { check_keys(map.content, map, value); });
}

} // namespace

const Fields<DerivativeCode>& DerivativeCode::fields() {
  static const auto table = Fields<DerivativeCode>()
                                .number("range", &DerivativeCode::range, {.least = 0, .excludes_least = true})
                                .word("neutral", &DerivativeCode::neutral);
  return table;
}

const Fields<BumpCodes>& BumpCodes::fields() {
  static const auto table = Fields<BumpCodes>()
                                .base<Tiled>()
                                .word("channels", &BumpCodes::channels)
                                .word("green", &BumpCodes::green)
                                .part(&BumpCodes::derivative)
                                .word("channel", &BumpCodes::height_channel)
                                .number("height", &BumpCodes::height);
  return table;
}

const Fields<BumpMap>& BumpMap::fields() {
  static const auto table = with_content<BumpMap>();
  return table;
}

const Fields<TriplanarMap>& TriplanarMap::fields() {
  static const auto table = with_content<TriplanarMap>();
  return table;
}

} // namespace surfgrad::stack
