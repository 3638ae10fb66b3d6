#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::cli {

/// What outputs were baked from, kept in a file beside the first of them: `rock_n.png.bake-record`.
class BakeRecord {
 public:
  [[nodiscard]] static std::filesystem::path file_for(const std::filesystem::path& output);

  /// output  file that the record is kept beside
  /// job     all that decides what the outputs hold but the contents of the inputs
  BakeRecord(const std::filesystem::path& output, nlohmann::json job);

  /// Whether the same job was done with inputs that hold what they hold now, and left the outputs that are
  /// there now. A record that cannot be understood is warned of and says nothing.
  [[nodiscard]] bool is_up_to_date(const std::function<void(std::string_view)>& warn) const;

  /// inputs  absolute paths and digests; outputs among them are left out
  ///
  /// Throws as io::write_file.
  void write(const std::map<std::filesystem::path, std::string>& inputs,
             const std::vector<std::filesystem::path>& outputs) const;

 private:
  std::filesystem::path file_;
  nlohmann::json job_;
};

} // namespace surfgrad::cli
