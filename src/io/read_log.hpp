#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>

namespace surfgrad::io {

/// While one lives it notes what read_file reads, in whichever thread: what a result was made from. One at a
/// time.
class ReadLog {
 public:
  ReadLog();
  ~ReadLog();
  ReadLog(const ReadLog&) = delete;
  ReadLog& operator=(const ReadLog&) = delete;

  /// Absolute paths, with the digest of what each file held when it was first read.
  [[nodiscard]] std::map<std::filesystem::path, std::string> files() const;

 private:
  friend void note_read(const std::filesystem::path& file, std::span<const std::byte> bytes);

  mutable std::mutex mutex_{};
  std::map<std::filesystem::path, std::string> files_{};
};

/// What read_file calls.
void note_read(const std::filesystem::path& file, std::span<const std::byte> bytes);

} // namespace surfgrad::io
