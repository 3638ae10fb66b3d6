#pragma once

#include "io/byte_sink.hpp"

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace surfgrad::io {

/// The whole content of a regular file, possibly empty. Decoders see only these bytes.
///
/// Throws InputError where `file` is missing, cannot be read, is not a regular file (a folder, a
/// device, a pipe) or is larger than 8 GiB; MachineError where the content does not fit in memory.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& file);

/// io::digest of a regular file's content, of any size, a piece of which is held at a time. Unlike read_file
/// it is not noted by io::ReadLog.
///
/// Throws InputError as read_file does.
[[nodiscard]] std::string digest_of_file(const std::filesystem::path& file);

/// A file written piece by piece that appears whole or not at all. The pieces go to a temporary file
/// beside the target, which commit() renames over it; without that the temporary is removed, and
/// whatever the target held before is untouched.
///
/// A symbolic link is followed, also to a file that does not exist yet, so that the link survives. A
/// file that is replaced passes its permission bits on, before the new one holds anything.
class OutputFile : public ByteSink {
 public:
  /// Throws as check_writable does.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile() override;

  /// Throws MachineError where the file system fails, e.g. a full disk; the file is then good for
  /// nothing but its end. So do seek(), finish() and commit().
  void write(std::span<const std::byte> bytes) override;
  void seek(std::uint64_t position) override;
  [[nodiscard]] std::uint64_t position() const override { return position_; }

  /// After the last write: what is left goes out. All that can fail for want of room fails here, so that
  /// several files that belong together are all finished before the first is committed.
  void finish();
  /// Once, after the last write: finishes the file and moves it into place.
  void commit();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::filesystem::path target_;
  std::filesystem::path temporary_{};
  std::unique_ptr<std::FILE, CloseFile> stream_{};
  std::uint64_t position_ = 0;
};

/// Writes `bytes` through an OutputFile. Throws as it does.
void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// Tries whether write_file could put a file there now, by creating and removing a temporary.
/// Call it before long work.
///
/// Throws InputError where the name is empty, the folder does not exist, or the target exists and
/// is not a regular file; MachineError where the folder cannot be written.
void check_writable(const std::filesystem::path& file);

} // namespace surfgrad::io
