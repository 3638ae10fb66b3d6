#include "io/tiff_library.hpp"

#include <cstdarg>
#include <cstdio>
#include <new>

namespace surfgrad::io::codec {
namespace {

int keep_error(TIFF*, void* user, const char*, const char* format, va_list arguments) {
  TiffError& error = *static_cast<TiffError*>(user);
  if (error[0] == '\0') std::vsnprintf(error.data(), error.size(), format, arguments);
  return 1; // handled: the library must not print it
}

// Warnings are about tags that do not matter here; lost pixels are errors.
int drop_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

int close_nothing(thandle_t) { return 0; }

} // namespace

Tiff open_tiff(const char* mode, const TiffCalls& calls, TiffError& error, tmsize_t max_allocation) {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  if (!options) throw std::bad_alloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_error, &error);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), drop_warning, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), max_allocation);
  return Tiff(TIFFClientOpenExt("", mode, calls.handle, calls.read, calls.write, calls.seek, close_nothing,
                                calls.size, nullptr, nullptr, options.get()));
}

} // namespace surfgrad::io::codec
