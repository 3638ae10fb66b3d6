#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace surfgrad::io {

/// The whole content of a regular file, possibly empty. Decoders see only these bytes.
///
/// Throws InputError where `file` is missing, cannot be read, is not a regular file (a folder, a
/// device, a pipe) or is larger than 8 GiB; MachineError where the content does not fit in memory.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& file);

/// Writes all or nothing: a temporary file beside the target is completed, then renamed over it.
/// A symbolic link is followed, also to a file that does not exist yet, so that the link survives.
/// A file that is replaced passes its permission bits on. On failure the temporary is removed and
/// whatever the target held before is untouched.
///
/// Throws InputError as check_writable does, MachineError where the file system fails (disk full,
/// no permission).
void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);

/// Tries whether write_file could put a file there now, by creating and removing a temporary.
/// Call it before long work.
///
/// Throws InputError where the name is empty, the folder does not exist, or the target exists and
/// is not a regular file; MachineError where the folder cannot be written.
void check_writable(const std::filesystem::path& file);

} // namespace surfgrad::io
