#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace surfgrad::shadergen {

/// A piece of shader code; all of them one after the other are the code.
struct Token {
  enum class Kind {
    word, ///< identifier or keyword
    number,
    space,   ///< blanks and line feeds
    comment, ///< from // to the end of the line, without the line feed
    line,    ///< from # to the end of the line, continued lines included
    mark,    ///< operator or bracket
  };
  Kind kind = Kind::mark;
  std::string_view text{};
};

using Tokens = std::span<const Token>;

/// code must outlive the tokens.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view code);

/// Index of the bracket that closes the one at `open`, or the end.
[[nodiscard]] std::size_t closing(Tokens tokens, std::size_t open);

/// First index from `i` on that is neither space nor comment.
[[nodiscard]] std::size_t significant(Tokens tokens, std::size_t i);

} // namespace surfgrad::shadergen
