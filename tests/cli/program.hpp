#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad {

/// What one run of the program did.
struct Outcome {
  int status = -1; ///< exit status; -1 if it was killed
  std::string out{};
  std::string error{};
};

/// Runs build/bin/surfgrad in a folder and waits for it.
[[nodiscard]] Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder);

/// A fresh, empty folder for one test, removed with it.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::string_view bytes) const;
  /// Names of what lies in it, sorted.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  std::filesystem::path path_;
};

} // namespace surfgrad
