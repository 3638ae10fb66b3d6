#pragma once

/// The document's format as data: the tables the parser reads by, for messages and for whoever checks
/// a schema against them.

#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::stack {

/// The library keeps every result finite for magnitudes up to this one, in single precision too.
inline constexpr double largest_number = 1e12;

struct Range {
  double least = -largest_number;
  double most = largest_number;
  bool excludes_least = false;
  bool excludes_most = false;
};

/// What a key accepts.
struct Shape {
  enum class Kind {
    number,    ///< one number within `range`
    integer,   ///< the same, whole
    truth,     ///< true or false
    word,      ///< one of `words`
    text,      ///< any string
    file,      ///< a file name
    files,     ///< a file name, or an array of as many as one of `counts`
    vector,    ///< an array of `components` numbers
    numbers,   ///< an array of any number of numbers
    tile,      ///< one number or an array of two, none of them zero
    size,      ///< one number or an array of three, each greater than 0
    object,    ///< an object of the format named `object`
    objects,   ///< an array of such objects
    layers,    ///< an array of layers
    materials, ///< an object whose every value is an array of layers
  };
  Kind kind = Kind::number;
  Range range{};
  std::vector<std::string_view> words{};
  int components = 0;
  std::vector<int> counts{};
  std::string_view object{};
};

/// `a number from 0 to 1`, `one of: add, mix` ...: what follows "expected" in a message.
[[nodiscard]] std::string expectation(const Shape& shape);

struct KeyFormat {
  std::string_view key;
  bool required = false;
  Shape shape{};
};

/// An object of the document and all its keys.
struct ObjectFormat {
  std::string_view name; ///< for a layer kind the word of its `type`
  bool is_layer = false;
  std::vector<KeyFormat> keys{};
};

/// Every object the parser knows; the whole document first.
[[nodiscard]] std::vector<ObjectFormat> document_format();

} // namespace surfgrad::stack
