#pragma once

/// The public functions of the core, read from its headers.

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace surfgrad::test {

/// One declaration: overloads are several.
struct Function {
  std::string place;                ///< header:name
  std::vector<std::string> comment; ///< its lines, without the slashes
  std::string parameters;           ///< what stands between its parentheses
};

/// scalar.hpp and vec.hpp hold the arithmetic that the functions are written in (operators, selection,
/// products), whose rounding is that of the operations a line shows.
inline bool is_arithmetic(const std::string& header) { return header == "scalar.hpp" || header == "vec.hpp"; }

/// Of the parenthesis at `open`; none where either is missing.
inline std::size_t closing_parenthesis(const std::string& text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i;
  }
  return std::string::npos;
}

/// Functions declared at the start of a line, outside namespace detail: members and helpers are not.
inline std::vector<Function> public_functions(const std::filesystem::path& header) {
  const std::string declaration = "[[nodiscard]] SURFGRAD_HOST_DEVICE";
  std::vector<Function> result;
  std::vector<std::string> comment;
  std::string declared; // from the declaration on, up to the end of its parameters
  bool in_detail = false;
  std::ifstream file(header);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("namespace detail {")) in_detail = true;
    if (line.starts_with("} // namespace detail")) in_detail = false;
    if (in_detail) continue;
    if (line.starts_with("///")) {
      comment.push_back(line.size() > 4 ? line.substr(4) : "");
      continue;
    }
    if (line.starts_with("template")) continue;
    if (line.starts_with(declaration) || !declared.empty()) declared += line + " ";
    const std::size_t open = declared.find('(');
    const std::size_t close = closing_parenthesis(declared, open);
    if (close != std::string::npos) {
      const std::size_t space = declared.find_last_of(' ', open);
      const std::string name = declared.substr(space + 1, open - space - 1);
      result.push_back(
          {header.filename().string() + ":" + name, comment, declared.substr(open + 1, close - open - 1)});
      declared.clear();
    }
    if (declared.empty()) comment.clear();
  }
  return result;
}

} // namespace surfgrad::test
