#include "diagnostic/error.hpp"
#include "stack/stack.hpp"

#include <gtest/gtest.h>

#include <random>

namespace surfgrad::stack {
namespace {

constexpr std::string_view valid = R"({ "surfgrad": 1, "mesh": "m.glb", "back_faces": "flip",
  "layers": [
    { "type": "normal_map", "map": "\u00e9.png", "uv": 3, "tile": [8, -2.5], "rotate": 3e1, "scale": -1.5,
      "mask": { "map": "ü.png", "channel": "a", "tile": 2 } },
    { "type": "resolve" },
    { "type": "object_normal_map", "map": "b.exr", "space": "world", "opacity": 0 } ],
  "materials": { "skin": [ { "type": "resolve" } ], "Cloth.001": [] },
  "camera": { "position": [0, 1, 2], "target": [3, 4, 5], "fov": 20 },
  "lights": { "sun": { "direction": [1, -2, 3], "strength": 0 }, "sky": 0.25, "environment": "e.hdr" } })";

/// Whether it parses. Anything but InputError escapes and fails the test.
bool parses(std::string_view text) {
  try {
    static_cast<void>(parse_stack(text, "stack.json"));
    return true;
  } catch (const InputError& error) {
    // A message without a place to look at helps nobody.
    EXPECT_GE(error.fault().line, 1) << error.what();
    EXPECT_FALSE(error.fault().problem.empty());
    EXPECT_LT(std::string_view(error.what()).size(), 1000u);
    return false;
  }
}

TEST(StackHostile, no_proper_prefix_is_a_document) {
  ASSERT_TRUE(parses(valid));
  for (std::size_t size = 0; size < valid.size(); ++size)
    // A copy of exactly that size, so that a sanitizer sees a read past its end.
    EXPECT_FALSE(
        parses(std::string_view(std::vector<char>(valid.begin(), valid.begin() + size).data(), size)))
        << size;
}

TEST(StackHostile, random_edits_give_a_document_or_an_input_error) {
  const unsigned seed = std::random_device{}();
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  const std::string_view likely = "{}[]\",:0123456789.-+eE\\u \n\r\t/tfn\x80\xff\xef\x00";
  constexpr int rounds = 20000;
  int accepted = 0;
  for (int round = 0; round < rounds; ++round) {
    std::string text(valid);
    const std::size_t edits = 1 + random() % 3;
    for (std::size_t edit = 0; edit < edits && !text.empty(); ++edit) {
      const std::size_t at = random() % text.size();
      const char byte =
          random() % 2 == 0 ? static_cast<char>(random() % 256) : likely[random() % likely.size()];
      switch (random() % 4) {
      case 0:
        text[at] = byte;
        break;
      case 1:
        text.insert(at, 1, byte);
        break;
      case 2:
        text.erase(at, 1 + random() % 8);
        break;
      default:
        text.insert(at, text.substr(random() % text.size(), random() % 64));
        break;
      }
    }
    accepted += parses(text);
    ASSERT_FALSE(HasFailure()) << "seed " << seed << " round " << round << "\n" << text;
  }
  std::printf("%d of %d edited documents are documents\n", accepted, rounds);
  // Edits inside strings and numbers often leave a document; were there none, or were all accepted,
  // this loop would reach only one side of the parser.
  EXPECT_GT(accepted, rounds / 100);
  EXPECT_LT(accepted, rounds / 2);
}

std::string repeat(std::string_view part, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += part;
  return text;
}

Fault fault_of(const std::string& text) {
  try {
    static_cast<void>(parse_stack(text, "stack.json"));
  } catch (const InputError& error) {
    return error.fault();
  }
  return {};
}

TEST(StackHostile, deep_nesting_is_refused_without_recursion) {
  for (const char* open : {"[", "{\"a\":", "[{\"a\":"}) {
    const Fault fault = fault_of("{\n\"surfgrad\": 1,\n\"layers\":\n" + repeat(open, 1'000'000));
    EXPECT_EQ(fault.line, 4);
    EXPECT_EQ(fault.problem, "is nested deeper than 64 levels");
  }
  // 63 arrays in the document's object are the deepest that parse, as JSON.
  EXPECT_EQ(fault_of("{\"a\": " + repeat("[", 63) + repeat("]", 63) + "}").problem,
            "lacks \"surfgrad\", the version of the format");
  EXPECT_EQ(fault_of("{\"a\": " + repeat("[", 64) + repeat("]", 64) + "}").problem,
            "is nested deeper than 64 levels");
}

TEST(StackHostile, the_number_of_values_is_bounded) {
  EXPECT_EQ(fault_of("{\"surfgrad\": 1, \"layers\": [" + repeat("0,", 1'000'000) + "0]}").problem,
            "holds more than 1000000 values");
}

TEST(StackHostile, many_keys_take_no_quadratic_time) {
  // A million comparisons a key would run into the test's time limit.
  std::string text = "{";
  for (int i = 0; i < 900'000; ++i) text += "\"k" + std::to_string(i) + "\":0,";
  EXPECT_EQ(fault_of(text + "\"surfgrad\":1}").problem, "unknown key \"k0\"");
  EXPECT_EQ(fault_of(text + "\"k899999\":1}").problem, "repeats the key \"k899999\"");
}

TEST(StackHostile, long_tokens_make_short_messages) {
  for (const char* shape :
       {"\"mesh\": \"%s", "\"mesh\": %s", "\"%s\": 1 }", "\"layers\": [{\"type\": \"%s\"}] }"}) {
    std::string text = std::string("{ \"surfgrad\": 1, ") + shape;
    text.replace(text.find("%s"), 2, std::string(1'000'000, '7'));
    EXPECT_FALSE(parses(text)) << shape;
  }
}

} // namespace
} // namespace surfgrad::stack
