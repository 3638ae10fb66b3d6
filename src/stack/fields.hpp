#pragma once

/// Tables that read the document's objects. One table an object: it finds the reader of each key, it
/// lists the keys in messages and it describes itself for the schema, so the three cannot disagree.

#include "stack/format.hpp"
#include "stack/json_tree.hpp"
#include "stack/map.hpp"

#include <functional>
#include <optional>
#include <utility>

namespace surfgrad::stack {

/// A value of the document, with the path that leads to it.
struct Value {
  const Node& node;
  std::string key;
  const std::filesystem::path& file;

  [[nodiscard]] const std::vector<Member>& members() const;      ///< throws unless it is an object
  [[nodiscard]] const std::vector<Node>& elements() const;       ///< throws unless it is an array
  [[nodiscard]] const Member* find(std::string_view name) const; ///< a member of an object, or null
  [[nodiscard]] Value member(const Member& member) const;
  [[nodiscard]] Value element(std::size_t index) const;

  /// Throws InputError at this value.
  [[noreturn]] void fail(std::string problem, std::string remedy) const;
  /// `is a string; expected a number`: the value's type or content is not what the shape accepts.
  [[noreturn]] void reject(std::string_view expected) const;
  [[noreturn]] void unknown_key(const Member& member, const std::vector<std::string_view>& allowed) const;
};

// Readers of one value; each throws InputError at it unless it fits the shape.
[[nodiscard]] double read_number(const Value& value, const Shape& shape);
[[nodiscard]] int read_integer(const Value& value, const Shape& shape);
[[nodiscard]] bool read_truth(const Value& value, const Shape& shape);
[[nodiscard]] std::size_t read_word(const Value& value, const Shape& shape); ///< index into shape.words
[[nodiscard]] std::string read_text(const Value& value, const Shape& shape);
[[nodiscard]] FileName read_file(const Value& value, const Shape& shape);
[[nodiscard]] std::vector<FileName> read_files(const Value& value, const Shape& shape); ///< one or all
[[nodiscard]] std::vector<double> read_vector(const Value& value, const Shape& shape);

[[nodiscard]] std::vector<double> read_numbers(const Value& value, const Shape& shape);

/// The word of `words` that a mistyped one most resembles; empty if none is near.
[[nodiscard]] std::string_view nearest(std::string_view word, const std::vector<std::string_view>& words);

template <class T>
struct Field {
  KeyFormat format{};
  std::function<void(T&, const Value&)> read{}; ///< fits the value into the struct or throws
};

/// Reads an object by its struct's table. Members the document leaves out keep their defaults.
template <class T>
void read_object(const Value& value, T& target);

/// The table of a struct that an object of the document fills.
template <class T>
class Fields {
 public:
  /// Member: double, or an optional one.
  template <class Member>
  Fields&& number(std::string_view key, Member T::*member, Range range = {}) && {
    return std::move(*this).add(
        key, {.kind = Shape::Kind::number, .range = range},
        [=](T& t, const Value& value, const Shape& shape) { t.*member = read_number(value, shape); });
  }
  Fields&& integer(std::string_view key, int T::*member, Range range) && {
    return std::move(*this).add(
        key, {.kind = Shape::Kind::integer, .range = range},
        [=](T& t, const Value& value, const Shape& shape) { t.*member = read_integer(value, shape); });
  }
  Fields&& truth(std::string_view key, bool T::*member) && {
    return std::move(*this).add(
        key, {.kind = Shape::Kind::truth},
        [=](T& t, const Value& value, const Shape& shape) { t.*member = read_truth(value, shape); });
  }
  /// Member: an enumeration with words, or an optional one.
  template <class Member>
  Fields&& word(std::string_view key, Member T::*member) && {
    using Enum = std::remove_cvref_t<decltype(choice_of(std::declval<Member>()))>;
    Shape shape{.kind = Shape::Kind::word};
    for (const auto& word : words_of<Enum>) shape.words.push_back(word.text);
    return std::move(*this).add(key, std::move(shape), [=](T& t, const Value& value, const Shape& s) {
      t.*member = words_of<Enum>[read_word(value, s)].value;
    });
  }
  /// Member: FileName, or an optional one.
  template <class Member>
  Fields&& file(std::string_view key, Member T::*member) && {
    return std::move(*this).add(
        key, {.kind = Shape::Kind::file},
        [=](T& t, const Value& value, const Shape& shape) { t.*member = read_file(value, shape); });
  }
  /// One file, or as many as one of `counts`.
  Fields&& files(std::string_view key, std::vector<FileName> T::*member, std::vector<int> counts) && {
    return std::move(*this).add(
        key, {.kind = Shape::Kind::files, .counts = std::move(counts)},
        [=](T& t, const Value& value, const Shape& shape) { t.*member = read_files(value, shape); });
  }
  Fields&& vector(std::string_view key, vec2<double> T::*member) && {
    return std::move(*this).add(key, {.kind = Shape::Kind::vector, .components = 2},
                                [=](T& t, const Value& value, const Shape& shape) {
                                  const std::vector<double> v = read_vector(value, shape);
                                  t.*member = vec2<double>{v[0], v[1]};
                                });
  }
  /// Member: vec3<double>, or an optional one.
  template <class Member>
  Fields&& vector(std::string_view key, Member T::*member) && {
    return std::move(*this).add(key, {.kind = Shape::Kind::vector, .components = 3},
                                [=](T& t, const Value& value, const Shape& shape) {
                                  const std::vector<double> v = read_vector(value, shape);
                                  t.*member = vec3<double>{v[0], v[1], v[2]};
                                });
  }
  /// Member: a struct with a table, or an optional one.
  template <class Member>
  Fields&& object(std::string_view key, Member T::*member) && {
    using Object = std::remove_cvref_t<decltype(choice_of(std::declval<Member>()))>;
    return std::move(*this).add(key, {.kind = Shape::Kind::object, .object = Object::format_name},
                                [=](T& t, const Value& value, const Shape&) {
                                  Object object;
                                  read_object(value, object);
                                  t.*member = std::move(object);
                                });
  }
  /// The key that names a layer's kind. Whoever chose this table has read it.
  Fields&& type(std::string_view name) && {
    return std::move(*this)
        .add("type", {.kind = Shape::Kind::word, .words = {name}}, [](T&, const Value&, const Shape&) {})
        .required();
  }
  /// read  void(T&, const Value&, const Shape&)
  template <class Read>
  Fields&& add(std::string_view key, Shape shape, Read read) && {
    Field<T>& field = fields_.emplace_back();
    field.format.key = key;
    field.format.shape = shape;
    field.read = [=](T& t, const Value& value) { read(t, value, shape); };
    return std::move(*this);
  }
  /// The last key may not be left out.
  Fields&& required() && {
    fields_.back().format.required = true;
    return std::move(*this);
  }
  /// The keys of a base class, in the same object.
  template <class Base>
  Fields&& base() && {
    return std::move(*this).template include<Base>([](T& t) -> Base& { return t; });
  }
  /// The keys of a member, in the same object.
  template <class Part>
  Fields&& part(Part T::*member) && {
    return std::move(*this).template include<Part>([=](T& t) -> Part& { return t.*member; });
  }
  /// The keys of whatever `access` gives, in the same object.
  ///
  /// access  Part&(T&)
  template <class Part, class Access>
  Fields&& part(Access access) && {
    return std::move(*this).template include<Part>(access);
  }
  /// Leaves out a key of a base class or a member that means nothing here.
  Fields&& without(std::string_view key) && {
    std::erase_if(fields_, [=](const Field<T>& field) { return field.format.key == key; });
    return std::move(*this);
  }
  /// Runs after all keys, with the object's own value: for lines, and for rules over several keys.
  Fields&& finally(std::function<void(T&, const Value&)> step) && {
    steps_.push_back(std::move(step));
    return std::move(*this);
  }

  [[nodiscard]] const std::vector<Field<T>>& fields() const { return fields_; }
  [[nodiscard]] const std::vector<std::function<void(T&, const Value&)>>& steps() const { return steps_; }
  [[nodiscard]] ObjectFormat format(std::string_view name, bool is_layer = false) const {
    ObjectFormat format{.name = name, .is_layer = is_layer};
    for (const Field<T>& field : fields_) format.keys.push_back(field.format);
    return format;
  }

 private:
  template <class V>
  static V choice_of(const V&);
  template <class V>
  static V choice_of(const std::optional<V>&);

  template <class Part, class Access>
  Fields&& include(Access access) && {
    for (const Field<Part>& part : Part::fields().fields()) {
      Field<T>& field = fields_.emplace_back();
      field.format = part.format;
      field.read = [access, read = part.read](T& t, const Value& value) { read(access(t), value); };
    }
    for (const auto& step : Part::fields().steps())
      steps_.push_back([access, step](T& t, const Value& value) { step(access(t), value); });
    return std::move(*this);
  }

  std::vector<Field<T>> fields_;
  std::vector<std::function<void(T&, const Value&)>> steps_;
};

template <class T>
void read_object(const Value& value, T& target) {
  const std::vector<Field<T>>& fields = T::fields().fields();
  for (const Member& member : value.members()) {
    const Field<T>* known = nullptr;
    for (const Field<T>& field : fields)
      if (field.format.key == member.key) known = &field;
    if (known == nullptr) {
      std::vector<std::string_view> allowed;
      for (const Field<T>& field : fields) allowed.push_back(field.format.key);
      value.unknown_key(member, allowed);
    }
    known->read(target, value.member(member));
  }
  for (const Field<T>& field : fields)
    if (field.format.required && value.find(field.format.key) == nullptr)
      value.fail("lacks " + quote(field.format.key),
                 "expected " + quote(field.format.key) + ": " + expectation(field.format.shape));
  for (const auto& step : T::fields().steps()) step(target, value);
}

} // namespace surfgrad::stack
