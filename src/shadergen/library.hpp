#pragma once

#include "shadergen/shadergen.hpp"

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::shadergen {

/// A shader file cut into its declarations: functions, structs, constants.
///
/// Comments that stand directly before a declaration belong to it. Directives, and what stands under a
/// condition other than the file's guard, are left out.
class Library {
 public:
  /// text must outlive the library.
  Library(std::string_view text, Language language);

  /// The declarations that `code` needs, directly and by others, in the order of the file. Of overloads those
  /// that take as many arguments as a call has, and a first one of as many components where that can be seen.
  ///
  /// guarded  each stands under a condition of the preprocessor, SURFGRAD_HAVE_ with its name and the types
  /// of
  ///          its parameters: texts made so can be joined
  [[nodiscard]] std::string used_by(std::string_view code, bool guarded = false) const;

 private:
  struct Declaration {
    std::string_view name;
    int arguments = -1;       ///< of a function, else -1
    int components = 0;       ///< of its first parameter, if that is a vector
    std::string types{};      ///< of its parameters, each after a `_`
    std::string_view text{};  ///< without comment
    std::string_view comment; ///< with the line feed at its end
  };
  /// Whether another has the same name and number of arguments.
  [[nodiscard]] bool is_overloaded(const Declaration& declaration) const;
  /// What a declaration is guarded by. Its name keeps its case, which tells types from functions.
  [[nodiscard]] static std::string guard_of(const Declaration& declaration);
  [[nodiscard]] std::vector<const Declaration*> named_in(std::string_view code) const;

  std::vector<Declaration> declarations_;
};

/// The library of a language, as shaders/ has it. Godot's is that of GLSL.
[[nodiscard]] std::string_view library_text(Language language);

/// The parts of the generator's own: support.glsl and exact.glsl.
[[nodiscard]] std::string_view support_text();
[[nodiscard]] std::string_view exact_text();

} // namespace surfgrad::shadergen
