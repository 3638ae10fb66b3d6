#pragma once

/// JSON text as a tree of values that know their lines.

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace surfgrad::stack {

struct Member;

struct Node {
  int line = 0; ///< 1-based line on which the value begins
  std::variant<std::nullptr_t, bool, double, std::string, std::vector<Node>, std::vector<Member>> value;
};

struct Member {
  std::string key{};
  int key_line = 0;
  Node node{};
};

/// The key path of an object's member: `lights.sun`; a key that is not a plain word is quoted:
/// `materials["Material.001"]`. The document itself has the empty path.
[[nodiscard]] std::string member_path(std::string_view parent, std::string_view key);
/// The key path of an array's element: `layers[2]`.
[[nodiscard]] std::string element_path(std::string_view parent, std::size_t index);

/// A string of the document as a message shows it: in quotes, cut where it is long.
[[nodiscard]] std::string quote(std::string_view text);

/// Parses a whole document. Numbers are finite, strings are valid UTF-8, no object repeats a key.
/// throws  InputError for anything else, nesting past 64 levels and more than a million values.
[[nodiscard]] Node parse_json(std::string_view text, const std::filesystem::path& file);

} // namespace surfgrad::stack
