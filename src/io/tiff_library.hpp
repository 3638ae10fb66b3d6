#pragma once

// Internal to src/io: how the TIFF library is opened without files and without its own messages.

#include <tiffio.h>

#include <array>
#include <memory>

namespace surfgrad::io::codec {

/// The first error the library reports, as text.
using TiffError = std::array<char, 256>;

struct CloseTiff {
  // Not TIFFClose, which would write what is missing: a file that is to be whole has been completed.
  void operator()(TIFF* tiff) const { TIFFCleanup(tiff); }
};
using Tiff = std::unique_ptr<TIFF, CloseTiff>;

/// What the library calls to read, write and move about; none may let an exception out.
struct TiffCalls {
  thandle_t handle;
  TIFFReadWriteProc read;
  TIFFReadWriteProc write;
  TIFFSeekProc seek;
  TIFFSizeProc size;
};

/// Null where the library cannot open it; `error` then says why. `error` outlives the result.
/// max_allocation: bytes at once, 0 for any number. Throws std::bad_alloc.
[[nodiscard]] Tiff open_tiff(const char* mode, const TiffCalls& calls, TiffError& error,
                             tmsize_t max_allocation);

} // namespace surfgrad::io::codec
