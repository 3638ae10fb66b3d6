#include "output_names.hpp"

#include "diagnostic/error.hpp"
#include "options.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>
#include <system_error>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view name_mark = "<NAME>";

} // namespace

void OutputNames::add_option(CLI::App& verb) {
  verb.add_option("--out-dir", folder_,
                  "folder that outputs go to, made if it is missing; in their names <NAME> is the input's")
      ->check(not_empty())
      ->type_name("DIR");
}

void OutputNames::check(const std::string& option, const std::string& pattern,
                        const std::vector<std::string>& inputs) const {
  if (pattern.empty()) return;
  if (inputs.size() > 1 && pattern.find(name_mark) == std::string::npos)
    throw CLI::ValidationError(option, fmt::format("\"{}\" would be written {} times; put {} into it",
                                                   pattern, inputs.size(), name_mark));
  std::map<fs::path, std::string> input_of;
  for (const std::string& input : inputs) {
    const fs::path file = file_for(pattern, input);
    const auto [at, is_new] = input_of.try_emplace(file.lexically_normal(), input);
    if (!is_new)
      throw CLI::ValidationError(option, fmt::format("\"{}\" would be written for {} and for {}; give one of "
                                                     "them another name, or a call of its own",
                                                     file.string(), at->second, input));
  }
}

void OutputNames::make_folder() const {
  if (!has_folder()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw MachineError(fmt::format("{}: cannot make this folder: {}", folder_, error.message()));
}

fs::path OutputNames::file_for(const std::string& pattern, const fs::path& input) const {
  if (pattern.empty()) return {};
  const std::string name = input.empty() ? "demo" : input.stem().string();
  std::string file = pattern;
  for (std::size_t at = 0; (at = file.find(name_mark, at)) != std::string::npos; at += name.size())
    file.replace(at, name_mark.size(), name);
  return fs::path(folder_) / file;
}

fs::path file_of_level(const fs::path& file, int level) {
  if (level == 0) return file;
  fs::path name = file.stem();
  name += fmt::format("_mip{}", level);
  name += file.extension();
  return file.parent_path() / name;
}

} // namespace surfgrad::cli
