#include "shadergen/spelling.hpp"

#include "shadergen/tokens.hpp"

#include <fmt/format.h>

#include <array>
#include <set>

namespace surfgrad::shadergen {
namespace {

using Kind = Token::Kind;

/// A word of common code in HLSL and WGSL; GLSL and Godot share the common one.
struct Spelling {
  std::string_view common, hlsl, wgsl;
};

constexpr auto types = std::to_array<Spelling>({{"float", "float", "f32"},
                                                {"int", "int", "i32"},
                                                {"uint", "uint", "u32"},
                                                {"bool", "bool", "bool"},
                                                {"vec2", "float2", "vec2f"},
                                                {"vec3", "float3", "vec3f"},
                                                {"vec4", "float4", "vec4f"},
                                                {"mat3", "float3x3", "mat3x3f"},
                                                {"mat4", "float4x4", "mat4x4f"}});

constexpr auto functions = std::to_array<Spelling>({{"SURFGRAD_DDX", "ddx_fine", "dpdxFine"},
                                                    {"SURFGRAD_DDY", "ddy_fine", "dpdyFine"},
                                                    {"mix", "lerp", "mix"},
                                                    {"fract", "frac", "fract"},
                                                    {"inversesqrt", "rsqrt", "inverseSqrt"}});

template <std::size_t N>
std::string_view look_up(const std::array<Spelling, N>& table, std::string_view word, Language language) {
  for (const Spelling& s : table) {
    if (s.common != word) continue;
    if (language == Language::hlsl) return s.hlsl;
    if (language == Language::wgsl) return s.wgsl;
  }
  return word;
}

/// Suffixes by which WGSL tells overloads apart: what stands after `__` in common code.
std::string without_overload(std::string_view word, Language language) {
  const std::size_t mark = word.find("__");
  if (mark == std::string_view::npos) return std::string(word);
  const std::string name(word.substr(0, mark));
  return language == Language::wgsl ? fmt::format("{}_{}", name, word.substr(mark + 2)) : name;
}

std::string trimmed(std::string text) {
  const char* blanks = " \n\t";
  text.erase(0, std::min(text.find_first_not_of(blanks), text.size()));
  text.erase(text.find_last_not_of(blanks) + 1);
  return text;
}

class Speller {
 public:
  Speller(Tokens tokens, Language language, const SamplerOf& sampler_of)
      : tokens_(tokens), language_(language), sampler_of_(sampler_of) {}

  std::string text() {
    return language_ == Language::wgsl ? statements(0, tokens_.size()) : expression(0, tokens_.size());
  }

 private:
  /// Everything but declarations is spelled word by word and call by call.
  std::string expression(std::size_t from, std::size_t to) {
    std::string out;
    for (std::size_t i = from; i < to; ++i) {
      const Token& t = tokens_[i];
      if (t.kind != Kind::word) {
        out += t.text;
        continue;
      }
      const bool is_call = i + 1 < to && tokens_[i + 1].text == "(";
      if (is_call && is_special(t.text)) {
        const std::size_t end = closing(tokens_, i + 1);
        const std::string made = special(t.text, arguments(i + 2, end));
        const bool operates = t.text == "product" || (t.text == "select" && language_ != Language::wgsl);
        out += operates && !stands_alone(out, end + 1, to) ? fmt::format("({})", made) : made;
        i = end;
      } else if (t.text == "stack_parameters" && language_ == Language::godot && tokens_[i + 1].text == ".") {
        out += "stack_"; // uniforms of Godot are members of nothing
        ++i;
      } else {
        out += word(t.text);
      }
    }
    return out;
  }

  std::string word(std::string_view text) const {
    const std::string_view type = look_up(types, text, language_);
    return without_overload(type != text ? type : look_up(functions, text, language_), language_);
  }

  std::vector<std::string> arguments(std::size_t from, std::size_t end) {
    std::vector<std::string> result;
    std::size_t first = from;
    for (std::size_t i = from; i <= end; ++i) {
      if (i < end && (tokens_[i].text == "(" || tokens_[i].text == "[")) i = closing(tokens_, i);
      if (i < end && tokens_[i].text != ",") continue;
      result.push_back(trimmed(expression(first, i)));
      first = i + 1;
    }
    return result;
  }

  /// Whether an expression between what is written and the token at `i` needs no brackets: it is a whole
  /// argument or the right side of a statement.
  bool stands_alone(const std::string& before, std::size_t i, std::size_t to) const {
    const std::size_t last = before.find_last_not_of(" \n");
    const bool begins = last == std::string::npos || before[last] == '(' || before[last] == ',' ||
                        (before[last] == '=' && last > 0 && before[last - 1] == ' ') ||
                        before.ends_with("return ");
    i = significant(tokens_, i);
    return begins && (i >= to || tokens_[i].text == ")" || tokens_[i].text == "," || tokens_[i].text == ";");
  }

  static bool is_special(std::string_view name) {
    static const std::set<std::string_view> names{"select",     "product",          "matrix_of_rows",
                                                  "sample_lod", "sample_cube_grad", "sample_grad",
                                                  "fetch",      "texture_size"};
    return names.contains(name);
  }

  std::string special(std::string_view name, const std::vector<std::string>& a) const {
    if (name == "select")
      return language_ == Language::wgsl ? fmt::format("select({}, {}, {})", a[2], a[1], a[0])
                                         : fmt::format("{} ? {} : {}", a[0], a[1], a[2]);
    if (name == "product")
      return language_ == Language::hlsl ? fmt::format("mul({}, {})", a[0], a[1])
                                         : fmt::format("{} * {}", factor(a[0]), factor(a[1]));
    if (name == "matrix_of_rows") {
      const std::string made = fmt::format("{}({}, {}, {}, {})", word("mat4"), a[0], a[1], a[2], a[3]);
      return language_ == Language::hlsl ? made : fmt::format("transpose({})", made); // columns elsewhere
    }
    switch (language_) {
    case Language::hlsl:
      return sampled_in_hlsl(name, a);
    case Language::wgsl:
      return sampled_in_wgsl(name, a);
    case Language::glsl:
    case Language::godot:
      break;
    }
    return sampled_in_glsl(name, a);
  }

  /// An expression that can be multiplied: in brackets where it holds an operator outside of any.
  static std::string factor(const std::string& expression) {
    int depth = 0;
    for (const char c : expression) {
      depth += c == '(' ? 1 : c == ')' ? -1 : 0;
      if (c == ' ' && depth == 0) return fmt::format("({})", expression);
    }
    return expression;
  }

  static std::string sampled_in_glsl(std::string_view name, const std::vector<std::string>& a) {
    if (name == "sample_lod") return fmt::format("textureLod({}, {}, {})", a[0], a[1], a[2]);
    if (name == "fetch") return fmt::format("texelFetch({}, ivec2({}, {}), 0)", a[0], a[1], a[2]);
    if (name == "texture_size") return fmt::format("vec2(textureSize({}, 0))", a[0]);
    return fmt::format("textureGrad({}, {}, {}, {})", a[0], a[1], a[2], a[3]);
  }

  std::string sampled_in_hlsl(std::string_view name, const std::vector<std::string>& a) const {
    if (name == "fetch") return fmt::format("{}.Load(int3({}, {}, 0))", a[0], a[1], a[2]);
    if (name == "texture_size") return fmt::format("stack_texture_size({})", a[0]);
    const std::string sampler = sampler_of_(a[0]);
    if (name == "sample_lod") return fmt::format("{}.SampleLevel({}, {}, {})", a[0], sampler, a[1], a[2]);
    return fmt::format("{}.SampleGrad({}, {}, {}, {})", a[0], sampler, a[1], a[2], a[3]);
  }

  std::string sampled_in_wgsl(std::string_view name, const std::vector<std::string>& a) const {
    if (name == "fetch") return fmt::format("textureLoad({}, vec2i({}, {}), 0)", a[0], a[1], a[2]);
    if (name == "texture_size") return fmt::format("vec2f(textureDimensions({}))", a[0]);
    const std::string sampler = sampler_of_(a[0]);
    if (name == "sample_lod")
      return fmt::format("textureSampleLevel({}, {}, {}, {})", a[0], sampler, a[1], a[2]);
    return fmt::format("textureSampleGrad({}, {}, {}, {}, {})", a[0], sampler, a[1], a[2], a[3]);
  }

  // WGSL declares otherwise than C: what follows reads the forms of common code.

  std::size_t next(std::size_t i) const { return significant(tokens_, i + 1); }
  bool is(std::size_t i, std::string_view text) const {
    return i < tokens_.size() && tokens_[i].text == text;
  }
  bool is_word(std::size_t i) const { return i < tokens_.size() && tokens_[i].kind == Kind::word; }

  std::string statements(std::size_t from, std::size_t to) {
    std::string out;
    for (std::size_t i = from; i < to;) {
      const Token& t = tokens_[i];
      if (t.kind == Kind::space || t.kind == Kind::comment || t.text == "{" || t.text == "}") {
        out += t.text;
        ++i;
      } else if (t.text == "struct") {
        i = structure(i, out);
      } else if (t.text == "for") {
        i = loop(i, out);
      } else if (declares(i)) {
        i = is(next(next(i)), "(") ? function(i, out) : variable(i, out);
      } else {
        i = other(i, out);
      }
    }
    return out;
  }

  bool declares(std::size_t i) const {
    return is_word(i) && tokens_[i].text != "return" && tokens_[i].text != "else" && is_word(next(i));
  }

  std::size_t structure(std::size_t i, std::string& out) {
    const std::size_t open = next(next(i));
    const std::size_t end = closing(tokens_, open);
    out += fmt::format("struct {} {{", tokens_[next(i)].text);
    for (i = open + 1; i < end;) {
      if (!is_word(i)) {
        out += tokens_[i++].text;
        continue;
      }
      const std::size_t name = next(i);
      const bool array = is(next(name), "[");
      const std::string type = word(tokens_[i].text);
      out += fmt::format("{}: {},", tokens_[name].text,
                         array ? fmt::format("array<{}, {}>", type, tokens_[next(next(name))].text) : type);
      while (!is(i, ";")) ++i;
      ++i;
    }
    out += "}";
    return is(next(end), ";") ? next(end) + 1 : end + 1;
  }

  std::size_t function(std::size_t i, std::string& out) {
    const std::size_t name = next(i);
    const std::size_t open = next(name);
    const std::size_t end = closing(tokens_, open);
    out += fmt::format("fn {}(", tokens_[name].text);
    for (std::size_t p = open + 1; p < end; ++p) {
      if (is_word(p)) {
        const std::size_t parameter = next(p);
        out += fmt::format("{}: {}", tokens_[parameter].text, word(tokens_[p].text));
        p = parameter;
      } else {
        out += tokens_[p].text;
      }
    }
    out += fmt::format(") -> {} ", word(tokens_[i].text));
    const std::size_t body = next(end);
    find_assigned(body, closing(tokens_, body));
    return body;
  }

  /// Names that a function gives a value more than once: WGSL calls only those variables.
  void find_assigned(std::size_t from, std::size_t to) {
    assigned_.clear();
    for (std::size_t i = from; i < to; i = next(i)) {
      if (!is(i, "{") && !is(i, "}") && !is(i, ";")) continue;
      std::size_t place = next(i);
      if (!is_word(place)) continue;
      const std::string_view name = tokens_[place].text;
      place = next(place);
      while (is(place, ".") || is(place, "["))
        place = is(place, ".") ? next(next(place)) : next(closing(tokens_, place));
      if (is(place, "=") || is(place, "+=") || is(place, "-=") || is(place, "*=")) assigned_.insert(name);
    }
  }

  std::size_t variable(std::size_t i, std::string& out) {
    const bool constant = is(i, "const");
    if (constant) i = next(i);
    const std::string type = word(tokens_[i].text);
    const std::size_t name = next(i);
    const std::size_t after = next(name);
    const std::string_view kind = constant                                                    ? "const"
                                  : is(after, "=") && !assigned_.contains(tokens_[name].text) ? "let"
                                                                                              : "var";
    const std::string array = is(after, "[") ? std::string(tokens_[next(after)].text) : "";
    out += fmt::format("{} {}: {}", kind, tokens_[name].text,
                       array.empty() ? type : fmt::format("array<{}, {}>", type, array));
    std::size_t end = after;
    while (end < tokens_.size() && !is(end, ";")) ++end;
    if (is(after, "=")) out += fmt::format(" {}", expression(after, end));
    out += ";";
    return end + 1;
  }

  /// for (int i = 0; i < n; ++i)
  std::size_t loop(std::size_t i, std::string& out) {
    const std::size_t open = next(i);
    const std::size_t end = closing(tokens_, open);
    std::size_t first = open + 1;
    while (!is(first, ";")) ++first;
    std::size_t second = first + 1;
    while (!is(second, ";")) ++second;
    const std::size_t name = next(next(open));
    out += fmt::format("for (var {}: i32 {};{}; {}++)", tokens_[name].text, expression(next(name), first),
                       expression(first + 1, second), tokens_[name].text);
    return end + 1;
  }

  /// A statement up to its end, or the head of a block.
  std::size_t other(std::size_t i, std::string& out) {
    std::size_t end = i;
    while (end < tokens_.size() && !is(end, ";") && !is(end, "{") && !is(end, "}"))
      end = is(end, "(") ? closing(tokens_, end) + 1 : end + 1;
    if (is(end, ";")) ++end;
    out += expression(i, end);
    return end;
  }

  Tokens tokens_;
  Language language_;
  const SamplerOf& sampler_of_;
  std::set<std::string_view> assigned_;
};

} // namespace

std::string spelled(std::string_view common, Language language, const SamplerOf& sampler_of) {
  const std::vector<Token> tokens = tokens_of(common);
  return Speller(tokens, language, sampler_of).text();
}

std::string_view type_in(Language language, std::string_view type) { return look_up(types, type, language); }

std::string renamed(std::string_view code, std::string_view name, std::string_view type_name) {
  constexpr std::string_view common = "stack", common_type = "Stack";
  std::string out;
  const std::vector<Token> tokens = tokens_of(code);
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const std::string_view t = tokens[i].text;
    if (tokens[i].kind != Kind::word) {
      out += t;
    } else if (t.starts_with("stack_")) {
      out += std::string(name) + std::string(t.substr(common.size()));
    } else if (t.starts_with(common_type)) {
      out += std::string(type_name) + std::string(t.substr(common_type.size()));
    } else {
      out += t;
    }
  }
  return out;
}

} // namespace surfgrad::shadergen
