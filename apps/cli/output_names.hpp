#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace surfgrad::cli {

/// Where the outputs of several inputs go. In the names that the user gives, `<NAME>` stands for the input's
/// name without folder and extension.
class OutputNames {
 public:
  void add_option(CLI::App& verb);

  [[nodiscard]] bool has_folder() const { return !folder_.empty(); }

  /// Refuses names that do not tell the inputs apart: throws CLI::ValidationError. `option` is the one that
  /// gave the pattern; an empty pattern is not looked at.
  void check(const std::string& option, const std::string& pattern,
             const std::vector<std::string>& inputs) const;

  /// Once all is checked. Throws MachineError where the folder cannot be made.
  void make_folder() const;

  /// The file that a pattern means for an input. Empty for an empty pattern.
  [[nodiscard]] std::filesystem::path file_for(const std::string& pattern,
                                               const std::filesystem::path& input) const;

 private:
  std::string folder_{};
};

/// The file of a mip level: rock_n.png, rock_n_mip1.png ...
[[nodiscard]] std::filesystem::path file_of_level(const std::filesystem::path& file, int level);

} // namespace surfgrad::cli
