#include "stack/bump_map.hpp"

#include "stack/fields.hpp"

#include <algorithm>
#include <initializer_list>

namespace surfgrad::stack {
namespace {

/// A key that says nothing about this content is a slip.
void require_content(const BumpMap& map, const Value& value, std::string_view key,
                     std::initializer_list<Content> contents) {
  const Member* member = value.find(key);
  if (member == nullptr || std::find(contents.begin(), contents.end(), map.content) != contents.end()) return;
  std::string words;
  for (const auto& word : words_of<Content>)
    if (std::find(contents.begin(), contents.end(), word.value) != contents.end())
      words += (words.empty() ? "" : " or ") + quote(word.text);
  value.member(*member).fail("does not apply to this content", "leave it out, or give \"content\": " + words);
}

} // namespace

const Fields<DerivativeCode>& DerivativeCode::fields() {
  static const auto table = Fields<DerivativeCode>()
                                .number("range", &DerivativeCode::range, {.least = 0, .excludes_least = true})
                                .word("neutral", &DerivativeCode::neutral);
  return table;
}

const Fields<BumpMap>& BumpMap::fields() {
  static const auto table =
      Fields<BumpMap>()
          .word("content", &BumpMap::content)
          .base<Tiled>()
          .word("channels", &BumpMap::channels)
          .word("green", &BumpMap::green)
          .part(&BumpMap::derivative)
          .word("height_channel", &BumpMap::height_channel)
          .number("height", &BumpMap::height)
          .finally([](BumpMap& map, const Value& value) {
            require_content(map, value, "channels", {Content::normal});
            require_content(map, value, "green", {Content::normal, Content::derivative});
            require_content(map, value, "range", {Content::derivative});
            require_content(map, value, "neutral", {Content::derivative});
            require_content(map, value, "height_channel", {Content::height});
            require_content(map, value, "height", {Content::height});
          });
  return table;
}

} // namespace surfgrad::stack
