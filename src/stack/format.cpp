#include "stack/format.hpp"

#include <fmt/format.h>

namespace surfgrad::stack {
namespace {

std::string limits(const Range& range) {
  const bool bounded_below = range.least > -largest_number;
  const bool bounded_above = range.most < largest_number;
  const char* above = range.excludes_least ? "greater than" : "at least";
  const char* below = range.excludes_most ? "less than" : "at most";
  if (!bounded_below && !bounded_above) return "";
  if (!bounded_above) return fmt::format(" {} {}", above, range.least);
  if (!bounded_below) return fmt::format(" {} {}", below, range.most);
  if (!range.excludes_least && !range.excludes_most)
    return fmt::format(" from {} to {}", range.least, range.most);
  return fmt::format(" {} {} and {} {}", above, range.least, below, range.most);
}

} // namespace

std::string expectation(const Shape& shape) {
  switch (shape.kind) {
  case Shape::Kind::number:
    return "a number" + limits(shape.range);
  case Shape::Kind::integer:
    return "a whole number" + limits(shape.range);
  case Shape::Kind::truth:
    return "true or false";
  case Shape::Kind::word:
    return fmt::format("{}{}", shape.words.size() > 1 ? "one of: " : "", fmt::join(shape.words, ", "));
  case Shape::Kind::text:
    return "a string";
  case Shape::Kind::file:
    return "a file name";
  case Shape::Kind::files:
    return fmt::format("a file name or an array of {} file names", fmt::join(shape.counts, " or "));
  case Shape::Kind::vector:
    return fmt::format("an array of {} numbers", shape.components);
  case Shape::Kind::numbers:
    return "an array of numbers";
  case Shape::Kind::tile:
    return "a number or an array of 2 numbers, none of them zero";
  case Shape::Kind::size:
    return "a number or an array of 3 numbers, all of them greater than 0";
  case Shape::Kind::object:
    return "an object";
  case Shape::Kind::objects:
    return "an array of objects";
  case Shape::Kind::layers:
    return "an array of layers";
  case Shape::Kind::materials:
    return "an object with an array of layers for each material";
  }
  return {};
}

} // namespace surfgrad::stack
