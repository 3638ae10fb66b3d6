#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace surfgrad::cli {

/// All files that a run is going to write: each only once, and none that it reads.
class OutputSet {
 public:
  /// A file that is written for an input; `option` names it. Throws CLI::ValidationError if another one is
  /// the same file, however it is spelled.
  void claim(const std::string& option, const std::filesystem::path& file, const std::string& input);

  /// Throws InputError if a file that an input is made of is one of them; whoever was to write it is kept
  /// from that, see check_outputs.
  void check_input(const std::filesystem::path& file, const std::string& input);

  /// Throws InputError if an output of this input turned out to be read for another one.
  void check_outputs(const std::string& input) const;

 private:
  struct Owner {
    std::string option;
    std::filesystem::path file;
    std::string input;
    std::optional<std::string> reader{}; ///< an input that it is read for
  };
  std::map<std::filesystem::path, Owner> owners_{};
};

} // namespace surfgrad::cli
