#include "output_set.hpp"

#include "diagnostic/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <system_error>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

/// The same for all names of a file. Links are followed, also one to a file that does not exist yet: it would
/// be written.
fs::path identity_of(const fs::path& file) {
  constexpr int most_links = 40; // as many in a row as Linux follows
  std::error_code error;
  fs::path target = fs::absolute(file);
  for (int links = 0; links < most_links && fs::is_symlink(target, error); ++links)
    target = target.parent_path() / fs::read_symlink(target, error);
  const fs::path whole = fs::weakly_canonical(target, error);
  return error ? target.lexically_normal() : whole;
}

} // namespace

void OutputSet::claim(const std::string& option, const fs::path& file, const std::string& input) {
  const auto [at, is_new] = owners_.try_emplace(identity_of(file), Owner{option, file, input});
  if (is_new) return;
  const Owner& other = at->second;
  const std::string whose = other.input == input ? "" : fmt::format(" for {}", other.input);
  throw CLI::ValidationError(option, fmt::format("\"{}\" is already written by {}{}; give it another name",
                                                 file.string(), other.option, whose));
}

void OutputSet::check_input(const fs::path& file, const std::string& input) {
  const auto found = owners_.find(identity_of(file));
  if (found == owners_.end()) return;
  Owner& owner = found->second;
  owner.reader = input;
  throw InputError(
      {.file = owner.file,
       .problem = owner.input == input
                      ? "would replace a file of the scene"
                      : fmt::format("is a file of {}, and would be written for {}", input, owner.input),
       .remedy = "give " + owner.option + " another name"});
}

void OutputSet::check_outputs(const std::string& input) const {
  for (const auto& [identity, owner] : owners_)
    if (owner.input == input && owner.reader)
      throw InputError({.file = owner.file,
                        .problem = "would replace a file of " + *owner.reader,
                        .remedy = "give " + owner.option + " another name"});
}

} // namespace surfgrad::cli
