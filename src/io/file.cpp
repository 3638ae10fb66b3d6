#include "io/file.hpp"

#include "diagnostic/error.hpp"
#include "io/digest.hpp"
#include "io/read_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <new>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace fs = std::filesystem;

namespace surfgrad::io {
namespace {

// Twice the largest image the readers accept (2^28 texels of four floats): a sparse file of a
// terabyte must not be read into memory.
constexpr std::uintmax_t max_file_bytes = std::uintmax_t{8} << 30;

// As many links in a row as Linux follows: a circle has no end.
constexpr int most_links = 40;

[[noreturn]] void cannot_write(const fs::path& file, std::string_view doing, int error_number) {
  throw MachineError(
      fmt::format("{}: cannot {}: {}", file.string(), doing, std::generic_category().message(error_number)));
}

/// Where the bytes really go: the target of a symbolic link, checked to be a name a file can take.
fs::path checked_target(const fs::path& file) {
  std::error_code error;
  fs::path target = file;
  // Link by link, since the last may point to a file that is still to be created.
  for (int links = 0; fs::is_symlink(target, error); ++links) {
    if (links == most_links) cannot_write(file, "resolve this path", ELOOP);
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) break;
  }
  if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory)
    cannot_write(file, "resolve this path", error.value());
  if (target.filename().empty() || target.filename() == "." || target.filename() == "..")
    throw InputError(
        {.file = file, .problem = "not a file name", .remedy = "give the name of a file to write"});
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    throw InputError({.file = file,
                      .problem = fmt::format("folder \"{}\" does not exist", folder.string()),
                      .remedy = "create it or write to an existing folder"});
  // Renaming over a device or a pipe would replace it with a file.
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    throw InputError({.file = file,
                      .problem = fs::is_directory(target, error) ? "is a folder" : "is not a regular file",
                      .remedy = "give the name of a file to write"});
  return target;
}

/// A regular file, open.
struct Opened {
  std::ifstream stream;
  std::uintmax_t size = 0;
  std::uintmax_t done = 0; ///< bytes read

  /// The next bytes.
  void read(std::span<std::byte> bytes, const fs::path& file) {
    if (bytes.empty()) return;
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    done += static_cast<std::uintmax_t>(stream.gcount());
    if (!stream)
      throw InputError({.file = file,
                        .problem = fmt::format("only {} of {} bytes could be read", done, size),
                        .remedy = "check that nothing else changes the file and that its disk is sound"});
  }
};

Opened open_to_read(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found)
    throw InputError({.file = file, .problem = "no such file", .remedy = "check the path"});
  if (status.type() == fs::file_type::none)
    throw InputError({.file = file,
                      .problem = fmt::format("cannot be reached: {}", error.message()),
                      .remedy = "check the path and its permissions"});
  if (status.type() == fs::file_type::directory)
    throw InputError({.file = file, .problem = "is a folder", .remedy = "give the name of a file"});
  if (status.type() != fs::file_type::regular)
    throw InputError({.file = file, .problem = "is not a regular file", .remedy = "give the name of a file"});

  Opened opened;
  opened.size = fs::file_size(file, error);
  opened.stream.open(file, std::ios::binary);
  if (error || !opened.stream)
    throw InputError({.file = file,
                      .problem = "cannot be opened for reading",
                      .remedy = "check the permissions of the file"});
  return opened;
}

} // namespace

std::vector<std::byte> read_file(const fs::path& file) {
  Opened opened = open_to_read(file);
  if (opened.size > max_file_bytes)
    throw InputError({.file = file,
                      .problem = fmt::format("has {} bytes", opened.size),
                      .remedy = fmt::format("at most {} bytes can be read", max_file_bytes)});
  std::vector<std::byte> bytes;
  try {
    bytes.resize(static_cast<std::size_t>(opened.size));
  } catch (const std::bad_alloc&) {
    throw MachineError(fmt::format("{}: not enough memory to read {} bytes", file.string(), opened.size));
  }
  opened.read(bytes, file);
  note_read(file, bytes);
  return bytes;
}

std::string digest_of_file(const fs::path& file) {
  Opened opened = open_to_read(file);
  Digest digest;
  std::vector<std::byte> piece;
  constexpr std::uintmax_t piece_bytes = 1 << 20;
  for (std::uintmax_t left = opened.size; left > 0; left -= piece.size()) {
    piece.resize(static_cast<std::size_t>(std::min(left, piece_bytes)));
    opened.read(piece, file);
    digest.add(piece);
  }
  return digest.text();
}

OutputFile::OutputFile(const fs::path& file) : target_(checked_target(file)) {
  std::random_device random;
  // A name clash is a matter of 1 in 2^32 a leftover file; a few attempts are plenty.
  for (int attempt = 0; attempt < 8 && !stream_; ++attempt) {
    temporary_ = target_.parent_path() / fmt::format(".surfgrad-{:08x}.partial", random());
    stream_.reset(std::fopen(temporary_.string().c_str(), "wbx"));
    if (!stream_ && errno != EEXIST) break;
  }
  if (!stream_) cannot_write(target_, "create a file in this folder", errno);
  std::error_code ignored; // a file system without permissions has none to keep
  const fs::file_status old = fs::status(target_, ignored);
  if (fs::exists(old)) fs::permissions(temporary_, old.permissions() & fs::perms::all, ignored);
}

OutputFile::~OutputFile() {
  stream_.reset();
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void OutputFile::write(std::span<const std::byte> bytes) {
  if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size())
    cannot_write(target_, "write", errno);
  position_ += bytes.size();
}

void OutputFile::seek(std::uint64_t position) {
  // What is buffered goes out first, which may fail as writing does.
  if (std::fseek(stream_.get(), static_cast<long>(position), SEEK_SET) != 0)
    cannot_write(target_, "write", errno);
  position_ = position;
}

void OutputFile::finish() {
  // A full disk may show only when the last buffered bytes go out.
  if (std::fflush(stream_.get()) != 0) cannot_write(target_, "write", errno);
  if (std::fclose(stream_.release()) != 0) cannot_write(target_, "write", errno);
}

void OutputFile::commit() {
  if (stream_) finish();
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) cannot_write(target_, "move the finished file into place", error.value());
  temporary_.clear();
}

void write_file(const fs::path& file, std::span<const std::byte> bytes) {
  OutputFile output(file);
  output.write(bytes);
  output.commit();
}

void check_writable(const fs::path& file) { const OutputFile probe(file); }

} // namespace surfgrad::io
