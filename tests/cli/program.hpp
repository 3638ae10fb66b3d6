#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace surfgrad {

/// What one run of the program did.
struct Outcome {
  int status = -1; ///< exit status; -1 if a signal ended it
  int signal = 0;  ///< the signal that ended it, or 0
  std::string out{};
  std::string error{};
};

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

/// Where a program's words go instead of a file that the outcome reads back; empty: not redirected.
struct Streams {
  std::string out{};
  std::string error{};
};

/// build/bin/surfgrad at work in a folder. wait() must be called once.
class Running {
 public:
  Running(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
          const Streams& streams = {});
  void send(int signal) const;
  [[nodiscard]] bool ended() const;
  [[nodiscard]] Outcome wait();

 private:
  Folder outputs_{};
  std::string out_;
  std::string error_;
  int child_ = 0;
};

/// What a file holds.
[[nodiscard]] std::string text_of(const std::filesystem::path& file);

/// Runs every command `build/bin/surfgrad ...` of a page of the project, in order, in a folder; each must end
/// with status 0.
///
/// returns  how many there are
[[nodiscard]] int run_commands_of(const std::filesystem::path& page, const Folder& folder);

/// Runs build/bin/surfgrad in a folder and waits for it.
[[nodiscard]] Outcome run_program(const std::vector<std::string>& arguments,
                                  const std::filesystem::path& folder, const Streams& streams = {});

} // namespace surfgrad
