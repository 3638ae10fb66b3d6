#include "shadergen/library.hpp"

#include "shadergen/tokens.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

namespace surfgrad::shadergen {
namespace {

using Kind = Token::Kind;

/// Number of arguments between brackets at `open` and `close`.
int argument_count(Tokens tokens, std::size_t open, std::size_t close) {
  if (significant(tokens, open + 1) == close) return 0;
  int count = 1;
  for (std::size_t i = open + 1; i < close; ++i) {
    if (tokens[i].text == "(" || tokens[i].text == "[" || tokens[i].text == "{") i = closing(tokens, i);
    if (i < close && tokens[i].text == ",") ++count;
  }
  return count;
}

/// Where the first argument after `from` ends, before `close` at the latest.
std::size_t first_argument_end(Tokens tokens, std::size_t from, std::size_t close) {
  for (std::size_t i = from; i < close; ++i) {
    if (tokens[i].text == "(" || tokens[i].text == "[") i = closing(tokens, i);
    if (i < close && tokens[i].text == ",") return i;
  }
  return close;
}

/// Number of components that swizzles and the types of names say an expression has; 0 where they say nothing.
///
/// scope  what stands before the expression in its function, parameters included
int components_of(Tokens expression, Tokens scope) {
  const auto of_type = [](std::string_view type) {
    return type == "vec2" || type == "float2" ? 2 : type == "vec3" || type == "float3" ? 3 : 0;
  };
  int components = 0;
  for (std::size_t i = 0; i < expression.size(); ++i) {
    const Token& t = expression[i];
    if (t.kind != Kind::word) continue;
    const bool is_member = i > 0 && expression[i - 1].text == ".";
    const bool has_member = i + 1 < expression.size() && expression[i + 1].text == ".";
    if (is_member && t.text.find_first_not_of("xyzrgb") == std::string_view::npos && t.text.size() > 1)
      components = static_cast<int>(t.text.size());
    if (i + 1 < expression.size() && expression[i + 1].text == "(") {
      i = closing(expression, i + 1); // what a call gives is not seen here
      continue;
    }
    if (is_member || has_member) continue;
    for (std::size_t k = scope.size(); k-- > 2;)
      if (scope[k].text == t.text && scope[k - 1].kind == Kind::space && of_type(scope[k - 2].text) > 0) {
        components = of_type(scope[k - 2].text);
        break;
      }
  }
  return components;
}

/// Types of parameters between brackets at `open` and `close`, each after a `_`.
std::string parameter_types(Tokens tokens, std::size_t open, std::size_t close) {
  std::string types;
  for (std::size_t i = open; i < close; ++i)
    if (tokens[i].text == "(" || tokens[i].text == ",")
      if (const std::size_t type = significant(tokens, i + 1); type < close)
        types.append("_").append(tokens[type].text);
  return types;
}

std::string_view between(Tokens tokens, std::size_t from, std::size_t to) {
  if (from >= to) return {};
  const char* first = tokens[from].text.data();
  const Token& last = tokens[to - 1];
  return {first, static_cast<std::size_t>(last.text.data() + last.text.size() - first)};
}

/// What a comment says before its first empty line: what the declaration is. The rest is the library's
/// manual.
std::string_view summary(std::string_view comment) {
  const std::size_t end = comment.find("\n//\n");
  return end == std::string_view::npos ? comment : comment.substr(0, end + 1);
}

} // namespace

Library::Library(std::string_view text, Language language) {
  const std::vector<Token> tokens = tokens_of(text);
  std::size_t comment = tokens.size(); // where that of the next declaration begins
  for (std::size_t i = 0; i < tokens.size();) {
    const Token& t = tokens[i];
    if (t.kind == Kind::space) {
      if (t.text.find("\n\n") != std::string_view::npos) comment = tokens.size();
      ++i;
      continue;
    }
    if (t.kind == Kind::comment) {
      comment = std::min(comment, i++);
      continue;
    }
    if (t.kind == Kind::line) {
      // The guard surrounds everything, the one #ifndef; any other condition is left out with what it holds.
      int depth = t.text.starts_with("#if") && !t.text.starts_with("#ifndef") ? 1 : 0;
      for (++i; depth > 0 && i < tokens.size(); ++i) {
        if (tokens[i].text.starts_with("#if")) ++depth;
        if (tokens[i].text.starts_with("#endif")) --depth;
      }
      comment = tokens.size();
      continue;
    }
    // A declaration: up to its block's end, or to a semicolon.
    Declaration d;
    std::size_t end = i, last_word = i;
    bool initialised = false;
    for (; end < tokens.size() && tokens[end].text != ";"; ++end) {
      const std::string_view mark = tokens[end].text;
      if (mark == "{" && !initialised) break;
      if (mark == "=" || (mark == ":" && t.text != "fn")) {
        if (d.name.empty()) d.name = tokens[last_word].text;
        initialised = initialised || mark == "=";
      }
      if (mark == "(" && !initialised && d.name.empty()) {
        d.name = tokens[last_word].text;
        const std::size_t close = closing(tokens, end);
        if (language != Language::wgsl) {
          d.arguments = argument_count(tokens, end, close);
          d.types = parameter_types(tokens, end, close);
          const std::string_view first = tokens[significant(tokens, end + 1)].text;
          d.components = first == "vec2" || first == "float2"   ? 2
                         : first == "vec3" || first == "float3" ? 3
                                                                : 0;
        }
        end = close;
      } else if (mark == "(" || mark == "{" || mark == "[") {
        end = closing(tokens, end);
      } else if (tokens[end].kind == Kind::word) {
        last_word = end;
      }
    }
    if (d.name.empty()) d.name = tokens[last_word].text;
    if (end < tokens.size() && tokens[end].text == "{") {
      end = closing(tokens, end);
      if (end + 1 < tokens.size() && tokens[end + 1].text == ";") ++end;
    }
    ++end;
    // A remark on the same line.
    if (end + 1 < tokens.size() && tokens[end + 1].kind == Kind::comment &&
        tokens[end].text.find('\n') == std::string_view::npos)
      end += 2;
    d.text = between(tokens, i, std::min(end, tokens.size()));
    if (comment < i)
      d.comment = summary(between(tokens, comment, i));
    else if (!declarations_.empty() && declarations_.back().name == d.name)
      d.comment = declarations_.back().comment; // an overload's, which stands above the first
    declarations_.push_back(d);
    comment = tokens.size();
    i = end;
  }
}

bool Library::is_overloaded(const Declaration& d) const {
  return std::count_if(declarations_.begin(), declarations_.end(), [&](const Declaration& other) {
           return other.name == d.name && other.arguments == d.arguments;
         }) > 1;
}

std::vector<const Library::Declaration*> Library::named_in(std::string_view code) const {
  const std::vector<Token> tokens = tokens_of(code);
  std::vector<const Declaration*> result;
  std::size_t scope = 0; // where the function that holds the token begins
  int depth = 0;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].text == "{") ++depth;
    if (tokens[i].text == "}" && --depth == 0) scope = i + 1;
    if (tokens[i].kind != Kind::word) continue;
    // A declaration's own name is no call.
    if (i >= 2 && tokens[i - 1].kind == Kind::space && tokens[i - 2].kind == Kind::word &&
        tokens[i - 2].text != "return" && tokens[i - 2].text != "else")
      continue;
    int arguments = -1, components = 0;
    if (i + 1 < tokens.size() && tokens[i + 1].text == "(") {
      const std::size_t close = closing(tokens, i + 1);
      arguments = argument_count(tokens, i + 1, close);
      const Tokens all(tokens);
      components = components_of(all.subspan(i + 2, first_argument_end(all, i + 2, close) - (i + 2)),
                                 all.subspan(scope, i - scope));
    }
    for (const Declaration& d : declarations_) {
      if (d.name != tokens[i].text) continue;
      const bool other = d.components > 0 && components > 0 && d.components != components && is_overloaded(d);
      if (d.arguments < 0 || (d.arguments == arguments && !other)) result.push_back(&d);
    }
  }
  return result;
}

std::string Library::guard_of(const Declaration& declaration) {
  std::string_view name = declaration.name;
  for (const std::string_view beginning : {"surfgrad_", "Surfgrad", "SURFGRAD_"})
    if (name.starts_with(beginning)) {
      name.remove_prefix(beginning.size());
      break;
    }
  return fmt::format("SURFGRAD_HAVE_{}{}", name, declaration.types);
}

std::string Library::used_by(std::string_view code, bool guarded) const {
  std::set<const Declaration*> used;
  const auto from_code = named_in(code);
  std::deque<const Declaration*> waiting(from_code.begin(), from_code.end());
  for (; !waiting.empty(); waiting.pop_front()) {
    if (!used.insert(waiting.front()).second) continue;
    const auto further = named_in(waiting.front()->text);
    waiting.insert(waiting.end(), further.begin(), further.end());
  }
  std::string result;
  std::string_view comment;
  for (const Declaration& d : declarations_) {
    if (!used.contains(&d)) continue;
    if (d.comment.data() != comment.data()) result += d.comment;
    comment = d.comment;
    if (guarded)
      result += fmt::format("#ifndef {0}\n#define {0}\n{1}\n#endif\n\n", guard_of(d), d.text);
    else
      result.append(d.text).append("\n\n");
  }
  return result;
}

} // namespace surfgrad::shadergen
