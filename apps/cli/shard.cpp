#include "shard.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

namespace surfgrad::cli {
namespace {

/// A whole number in digits alone, 0 for what is none.
std::size_t number_in(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

} // namespace

void Shard::add_option(CLI::App& verb) {
  verb.add_option_function<std::string>(
          "--shard",
          [this](const std::string& text) {
            const std::string_view given = text;
            const std::size_t slash = given.find('/');
            const std::size_t index = number_in(given.substr(0, slash));
            const std::size_t count =
                slash == std::string_view::npos ? 0 : number_in(given.substr(slash + 1));
            if (index < 1 || index > count)
              throw CLI::ValidationError(
                  "--shard", fmt::format("\"{}\" is no share of the work; use I/N with I from 1 to N", text));
            index_ = index - 1;
            count_ = count;
          },
          "do only the I-th of N shares of the scenes and UDIM tiles; all N together do the whole")
      ->type_name("I/N");
}

} // namespace surfgrad::cli
