#include "shadergen/tokens.hpp"

#include <algorithm>
#include <array>

namespace surfgrad::shadergen {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// Length of the longest run from the beginning whose characters are all `in`.
template <class In>
std::size_t run(std::string_view code, const In& in) {
  return static_cast<std::size_t>(std::find_if_not(code.begin(), code.end(), in) - code.begin());
}

std::size_t number_length(std::string_view code) {
  std::size_t length = 0;
  while (length < code.size()) {
    const char c = code[length];
    const bool exponent_sign = (c == '+' || c == '-') && length > 0 &&
                               (code[length - 1] == 'e' || code[length - 1] == 'E') &&
                               !code.starts_with("0x");
    if (!is_letter(c) && !is_digit(c) && c != '.' && !exponent_sign) break;
    ++length;
  }
  return length;
}

std::size_t directive_length(std::string_view code) {
  std::size_t end = code.find('\n');
  while (end != std::string_view::npos && end > 0 && code[end - 1] == '\\') end = code.find('\n', end + 1);
  return std::min(end, code.size());
}

std::size_t mark_length(std::string_view code) {
  static constexpr std::array<std::string_view, 15> pairs{
      "==", "<=", ">=", "!=", "+=", "-=", "*=", "/=", "&&", "||", "++", "--", "<<", ">>", "->"};
  return std::any_of(pairs.begin(), pairs.end(), [&](std::string_view p) { return code.starts_with(p); }) ? 2
                                                                                                          : 1;
}

Token first_of(std::string_view code) {
  using Kind = Token::Kind;
  const char c = code.front();
  if (is_space(c)) return {Kind::space, code.substr(0, run(code, is_space))};
  if (code.starts_with("//")) return {Kind::comment, code.substr(0, code.find('\n'))};
  if (c == '#') return {Kind::line, code.substr(0, directive_length(code))};
  if (is_letter(c))
    return {Kind::word, code.substr(0, run(code, [](char d) { return is_letter(d) || is_digit(d); }))};
  if (is_digit(c) || (c == '.' && code.size() > 1 && is_digit(code[1])))
    return {Kind::number, code.substr(0, number_length(code))};
  return {Kind::mark, code.substr(0, mark_length(code))};
}

} // namespace

std::vector<Token> tokens_of(std::string_view code) {
  std::vector<Token> tokens;
  while (!code.empty()) {
    tokens.push_back(first_of(code));
    code.remove_prefix(tokens.back().text.size());
  }
  return tokens;
}

std::size_t closing(Tokens tokens, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < tokens.size(); ++i) {
    const std::string_view t = tokens[i].text;
    if (t == "(" || t == "[" || t == "{") ++depth;
    if ((t == ")" || t == "]" || t == "}") && --depth == 0) return i;
  }
  return tokens.size();
}

std::size_t significant(Tokens tokens, std::size_t i) {
  while (i < tokens.size() &&
         (tokens[i].kind == Token::Kind::space || tokens[i].kind == Token::Kind::comment))
    ++i;
  return i;
}

} // namespace surfgrad::shadergen
