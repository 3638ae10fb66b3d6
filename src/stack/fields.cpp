#include "stack/fields.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace surfgrad::stack {
namespace {

std::string description(const Node& node) {
  struct Visitor {
    std::string operator()(std::nullptr_t) const { return "null"; }
    std::string operator()(bool b) const { return b ? "true" : "false"; }
    std::string operator()(double number) const { return fmt::format("{}", number); }
    std::string operator()(const std::string&) const { return "a string"; }
    std::string operator()(const std::vector<Node>& elements) const {
      return fmt::format("an array of {}", elements.size());
    }
    std::string operator()(const std::vector<Member>&) const { return "an object"; }
  };
  return std::visit(Visitor{}, node.value);
}

bool contains(const Range& range, double number) {
  // No NaN comes out of JSON text.
  if (number < range.least || number > range.most) return false;
  return !(range.excludes_least && number == range.least) && !(range.excludes_most && number == range.most);
}

/// Levenshtein's distance: insertions, deletions and replacements of one byte.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (a[i] != b[j] ? 1 : 0)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

std::string suggestion(std::string_view word, const std::vector<std::string_view>& words) {
  const std::string_view near = nearest(word, words);
  return near.empty() ? "" : fmt::format("did you mean {}? ", quote(near));
}

} // namespace

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& words) {
  // A long word is no slip of a short one, and its distance would take long to find.
  if (word.size() > 32) return {};
  std::string_view best;
  // A third of the letters wrong is still a slip; more is another word.
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string_view candidate : words) {
    const std::size_t distance = edit_distance(word, candidate);
    // Replacing every letter of a short word resembles nothing.
    if (distance < least && distance < candidate.size()) {
      best = candidate;
      least = distance;
    }
  }
  return best;
}

const std::vector<Member>& Value::members() const {
  const auto* members = std::get_if<std::vector<Member>>(&node.value);
  if (members == nullptr) reject("an object");
  return *members;
}

const std::vector<Node>& Value::elements() const {
  const auto* elements = std::get_if<std::vector<Node>>(&node.value);
  if (elements == nullptr) reject("an array");
  return *elements;
}

const Member* Value::find(std::string_view name) const {
  for (const Member& member : members())
    if (member.key == name) return &member;
  return nullptr;
}

Value Value::member(const Member& member) const { return {member.node, member_path(key, member.key), file}; }

Value Value::element(std::size_t index) const { return {elements()[index], element_path(key, index), file}; }

void Value::fail(std::string problem, std::string remedy) const {
  throw InputError({.file = file,
                    .line = node.line,
                    .place = key,
                    .problem = std::move(problem),
                    .remedy = std::move(remedy)});
}

void Value::reject(std::string_view expected) const {
  fail("is " + description(node), fmt::format("expected {}", expected));
}

void Value::unknown_key(const Member& member, const std::vector<std::string_view>& allowed) const {
  throw InputError({.file = file,
                    .line = member.key_line,
                    .place = key,
                    .problem = "unknown key " + quote(member.key),
                    .remedy = fmt::format("{}expected one of: {}", suggestion(member.key, allowed),
                                          fmt::join(allowed, ", "))});
}

double read_number(const Value& value, const Shape& shape) {
  const double* number = std::get_if<double>(&value.node.value);
  if (number != nullptr && std::abs(*number) > largest_number)
    value.fail(fmt::format("is {}", *number),
               fmt::format("expected a number of magnitude {} or less", largest_number));
  if (number == nullptr || !contains(shape.range, *number)) value.reject(expectation(shape));
  return *number;
}

int read_integer(const Value& value, const Shape& shape) {
  const double number = read_number(value, shape);
  // The ranges of whole numbers lie within int.
  if (number != std::floor(number)) value.reject(expectation(shape));
  return static_cast<int>(number);
}

bool read_truth(const Value& value, const Shape& shape) {
  const auto* truth = std::get_if<bool>(&value.node.value);
  if (truth == nullptr) value.reject(expectation(shape));
  return *truth;
}

std::size_t read_word(const Value& value, const Shape& shape) {
  const std::string* text = std::get_if<std::string>(&value.node.value);
  if (text == nullptr) value.reject(expectation(shape));
  const auto word = std::find(shape.words.begin(), shape.words.end(), *text);
  if (word == shape.words.end())
    value.fail("is " + quote(*text), suggestion(*text, shape.words) + "expected " + expectation(shape));
  return static_cast<std::size_t>(word - shape.words.begin());
}

std::string read_text(const Value& value, const Shape& shape) {
  const std::string* text = std::get_if<std::string>(&value.node.value);
  if (text == nullptr) value.reject(expectation(shape));
  return *text;
}

FileName read_file(const Value& value, const Shape& shape) {
  const std::string text = read_text(value, shape);
  if (text.empty()) value.fail("is empty", "expected " + expectation(shape));
  if (text.find('\0') != text.npos) value.fail("holds a zero character", "expected " + expectation(shape));
  // Strings of the document are UTF-8; char8_t is how a path learns that.
  return {.path = std::filesystem::path(std::u8string(text.begin(), text.end())),
          .line = value.node.line,
          .key = value.key};
}

std::vector<FileName> read_files(const Value& value, const Shape& shape) {
  const Shape one{.kind = Shape::Kind::file};
  if (std::holds_alternative<std::string>(value.node.value)) return {read_file(value, one)};
  const auto* elements = std::get_if<std::vector<Node>>(&value.node.value);
  if (elements == nullptr || std::find(shape.counts.begin(), shape.counts.end(),
                                       static_cast<int>(elements->size())) == shape.counts.end())
    value.reject(expectation(shape));
  std::vector<FileName> files;
  for (std::size_t i = 0; i < elements->size(); ++i) files.push_back(read_file(value.element(i), one));
  return files;
}

std::vector<double> read_vector(const Value& value, const Shape& shape) {
  const auto* elements = std::get_if<std::vector<Node>>(&value.node.value);
  if (elements == nullptr || elements->size() != static_cast<std::size_t>(shape.components))
    value.reject(expectation(shape));
  return read_numbers(value, shape);
}

std::vector<double> read_numbers(const Value& value, const Shape& shape) {
  const auto* elements = std::get_if<std::vector<Node>>(&value.node.value);
  if (elements == nullptr) value.reject(expectation(shape));
  std::vector<double> numbers;
  for (std::size_t i = 0; i < elements->size(); ++i)
    numbers.push_back(read_number(value.element(i), {.kind = Shape::Kind::number}));
  return numbers;
}

} // namespace surfgrad::stack
