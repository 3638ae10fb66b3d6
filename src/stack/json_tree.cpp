#include "stack/json_tree.hpp"

#include "diagnostic/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <limits>

namespace surfgrad::stack {
namespace {

// Far deeper than any real document, shallow enough for recursion over the tree.
constexpr std::size_t deepest_level = 64;
// Bounds what a hostile document can make of memory: about 100 bytes a value.
constexpr std::size_t most_values = 1'000'000;
constexpr std::size_t longest_quote = 60;

/// Reading position. A line end belongs to the line it ends, so that the one character a number's
/// scanner reads too far does not move the number to the next line.
struct Cursor {
  const char* begin;
  const char* end;
  const char* at = begin;
  std::size_t line = 1;
  bool line_ended = false;

  void advance() {
    if (line_ended) ++line;
    line_ended = *at == '\n';
    ++at;
  }
  [[nodiscard]] int current_line() const {
    return static_cast<int>(std::min<std::size_t>(line, std::numeric_limits<int>::max()));
  }
  /// The word the last character read belongs to or ends, else that character.
  [[nodiscard]] std::string_view current_word() const;
};

bool is_word_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string_view Cursor::current_word() const {
  if (at == begin) return {};
  const char* first = at - 1;
  const char* last = at;
  if (std::string_view(" \t\r\n,]}").find(*first) != std::string_view::npos)
    last = first;
  else if (!is_word_character(*first))
    return {first, 1};
  while (last != end && is_word_character(*last)) ++last;
  while (first != begin && is_word_character(first[-1])) --first;
  return {first, static_cast<std::size_t>(last - first)};
}

/// The iterator nlohmann_json reads through. Copies share the cursor; the end has none.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  explicit CountingIterator(Cursor* cursor = nullptr) : cursor_(cursor) {}
  reference operator*() const { return *cursor_->at; }
  CountingIterator& operator++() {
    cursor_->advance();
    return *this;
  }
  CountingIterator operator++(int) { return ++*this; }
  bool operator==(const CountingIterator& other) const { return at_end() == other.at_end(); }
  bool operator!=(const CountingIterator& other) const { return !(*this == other); }

 private:
  [[nodiscard]] bool at_end() const { return cursor_ == nullptr || cursor_->at == cursor_->end; }
  Cursor* cursor_;
};

/// Builds the tree from the parser's events. Every event throws on what a document may not hold, so
/// all of them return true, which tells the parser to go on.
class TreeBuilder {
 public:
  using json = nlohmann::json;

  TreeBuilder(const Cursor& cursor, const std::filesystem::path& file) : cursor_(cursor), file_(file) {}

  [[nodiscard]] Node take() { return std::move(root_); }

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(json::number_integer_t value) { return add(static_cast<double>(value)); }
  bool number_unsigned(json::number_unsigned_t value) { return add(static_cast<double>(value)); }
  bool number_float(json::number_float_t, const std::string& scanned) {
    // The scanner writes the C locale's decimal sign into the token: put the document's back, and
    // read it without a locale. A value too small for a double leaves the zero.
    std::string token = scanned;
    for (char& c : token)
      if (std::string_view("0123456789+-eE").find(c) == std::string_view::npos) c = '.';
    double value = 0;
    std::from_chars(token.data(), token.data() + token.size(), value);
    return add(value);
  }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return false; } // not in JSON text

  bool start_object(std::size_t) { return open(std::vector<Member>{}); }
  bool start_array(std::size_t) { return open(std::vector<Node>{}); }
  bool end_array() {
    open_.pop_back();
    return true;
  }
  bool end_object();
  bool key(std::string& name) {
    std::get<std::vector<Member>>(open_.back()->value)
        .push_back({std::move(name), cursor_.current_line(), {}});
    awaits_value_ = true;
    return true;
  }

  template <class Error>
  bool parse_error(std::size_t, const std::string&, const Error& error);

 private:
  /// Key path of the value being read or, where none is, of the container it would join.
  [[nodiscard]] std::string path() const;
  [[noreturn]] void fail(std::string problem, std::string remedy, int line, std::string place) const {
    throw InputError({.file = file_,
                      .line = line,
                      .place = std::move(place),
                      .problem = std::move(problem),
                      .remedy = std::move(remedy)});
  }
  Node& append();
  template <class V>
  bool add(V&& value) {
    append().value = std::forward<V>(value);
    return true;
  }
  template <class Container>
  bool open(Container container) {
    if (open_.size() == deepest_level)
      fail(fmt::format("is nested deeper than {} levels", deepest_level), "a stack needs fewer than 10",
           cursor_.current_line(), "");
    Node& node = append();
    node.value = std::move(container);
    open_.push_back(&node);
    return true;
  }

  const Cursor& cursor_;
  const std::filesystem::path& file_;
  Node root_{};
  // The containers from the root to the current one. Only the last of them grows, so all stay put.
  std::vector<Node*> open_{};
  bool awaits_value_ = false; ///< a key was read and its value was not
  std::size_t values_ = 0;
};

std::string TreeBuilder::path() const {
  std::string text;
  for (const Node* node : open_) {
    if (const auto* elements = std::get_if<std::vector<Node>>(&node->value)) {
      const bool inner = node != open_.back();
      text = element_path(text, elements->size() - (inner ? 1 : 0));
    } else {
      const auto& members = std::get<std::vector<Member>>(node->value);
      if (node != open_.back() || awaits_value_) text = member_path(text, members.back().key);
    }
  }
  return text;
}

Node& TreeBuilder::append() {
  if (++values_ > most_values)
    fail(fmt::format("holds more than {} values", most_values), "split the document", cursor_.current_line(),
         path());
  Node* node = &root_;
  if (!open_.empty()) {
    if (auto* elements = std::get_if<std::vector<Node>>(&open_.back()->value))
      node = &elements->emplace_back();
    else
      node = &std::get<std::vector<Member>>(open_.back()->value).back().node;
  }
  awaits_value_ = false;
  node->line = cursor_.current_line();
  return *node;
}

bool TreeBuilder::end_object() {
  const auto& members = std::get<std::vector<Member>>(open_.back()->value);
  std::vector<const Member*> sorted;
  sorted.reserve(members.size());
  for (const Member& member : members) sorted.push_back(&member);
  // Equal keys stay in document order, so the second of a pair is the repeated one.
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Member* a, const Member* b) { return a->key < b->key; });
  const auto pair = std::adjacent_find(sorted.begin(), sorted.end(),
                                       [](const Member* a, const Member* b) { return a->key == b->key; });
  if (pair != sorted.end())
    fail("repeats the key " + quote(pair[0]->key),
         fmt::format("keep one; the first is on line {}", pair[0]->key_line), pair[1]->key_line, path());
  open_.pop_back();
  return true;
}

/// The library's complaint, taken apart: what is wrong, and what would be right if it says so.
struct Complaint {
  std::string problem, remedy;
};

/// word     what to show of an unknown literal: the library's token then holds text before it too
/// message  "[..] parse error at line 1, column 2: syntax error while parsing W - PROBLEM; expected X",
///          where the PROBLEM of a malformed token ends in "; last read: 'TOKEN'".
Complaint take_apart(std::string_view message, std::string_view token, std::string_view word) {
  constexpr std::string_view last_read = "; last read: '";
  constexpr std::string_view expected = "; expected ";
  if (const auto dash = message.find(" - "); dash != message.npos) message.remove_prefix(dash + 3);
  std::string_view problem = message;
  std::string_view rest;
  const auto token_at = message.find(last_read);
  if (token_at != message.npos) {
    problem = message.substr(0, token_at);
    // The token holds any bytes: step over it by its length, and over the closing quote.
    rest = message.substr(std::min(message.size(), token_at + last_read.size() + token.size() + 1));
  }
  Complaint complaint;
  if (const auto at = problem.find(expected); at != problem.npos) {
    rest = problem.substr(at);
    problem = problem.substr(0, at);
  }
  complaint.problem = problem;
  const bool is_literal = problem == "invalid literal";
  if (rest.starts_with(expected)) complaint.remedy = rest.substr(2);
  if (problem.find("UTF-8") != problem.npos || problem.find("BOM") != problem.npos)
    complaint.remedy = "expected UTF-8";
  else if (is_literal && word == "/")
    complaint.remedy = "JSON has no comments: remove it";
  else if (is_literal && complaint.remedy.empty())
    complaint.remedy = "expected a value: a string in double quotes, a number, true, false, {...} or [...]";
  // The library names only the end of a container that is not yet closed.
  else if (complaint.remedy == "expected '}'" || complaint.remedy == "expected ']'")
    complaint.remedy = "expected ',' or" + complaint.remedy.substr(std::string_view("expected").size());
  if (token_at != message.npos) {
    std::string shown(is_literal ? word : token);
    for (char& c : shown)
      if (static_cast<unsigned char>(c) >= 0x80) c = '?'; // what failed to parse may not be UTF-8
    complaint.problem += ": " + quote(shown);
  }
  return complaint;
}

template <class Error>
bool TreeBuilder::parse_error(std::size_t, const std::string& token, const Error& error) {
  if constexpr (std::is_same_v<Error, json::out_of_range>) {
    fail("is too large: " + quote(token), "expected a number of magnitude 1e12 or less",
         cursor_.current_line(), path());
  } else {
    Complaint complaint = take_apart(error.what(), token, cursor_.current_word());
    fail("is not valid JSON: " + complaint.problem, std::move(complaint.remedy), cursor_.current_line(),
         path());
  }
}

bool is_plain(std::string_view key) {
  return !key.empty() && key.size() <= longest_quote && std::all_of(key.begin(), key.end(), [](char c) {
    return is_word_character(c) || c == '-' || c == '$';
  });
}

} // namespace

std::string member_path(std::string_view parent, std::string_view key) {
  if (!is_plain(key)) return fmt::format("{}[{}]", parent, quote(key));
  return parent.empty() ? std::string(key) : fmt::format("{}.{}", parent, key);
}

std::string element_path(std::string_view parent, std::size_t index) {
  return fmt::format("{}[{}]", parent, index);
}

std::string quote(std::string_view text) {
  if (text.size() <= longest_quote) return fmt::format("\"{}\"", text);
  std::size_t cut = longest_quote;
  while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80) --cut; // not inside a character
  return fmt::format("\"{}...\"", text.substr(0, cut));
}

Node parse_json(std::string_view text, const std::filesystem::path& file) {
  Cursor cursor{text.data(), text.data() + text.size()};
  TreeBuilder builder(cursor, file);
  // The parser takes a zero byte for the end of the text and would ignore what follows.
  if (const auto zero = text.find('\0'); zero != text.npos) {
    while (cursor.at <= text.data() + zero) cursor.advance();
    throw InputError({.file = file,
                      .line = cursor.current_line(),
                      .problem = "is not text: it holds a zero byte",
                      .remedy = "expected a JSON document in UTF-8"});
  }
  nlohmann::json::sax_parse(CountingIterator(&cursor), CountingIterator(), &builder);
  return builder.take();
}

} // namespace surfgrad::stack
