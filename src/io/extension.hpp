#pragma once

#include <filesystem>
#include <string>

namespace surfgrad::io {

/// The extension of a file name, dot included, in lower case whatever the locale.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

} // namespace surfgrad::io
