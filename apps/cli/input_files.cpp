#include "input_files.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

bool is_image(const fs::path& file) {
  static const std::set<std::string_view> extensions{".png", ".tif",  ".tiff", ".exr",
                                                     ".jpg", ".jpeg", ".hdr",  ".tga"};
  return extensions.contains(io::lower_extension(file));
}

std::vector<std::string> images_in(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_image(entry.path())) files.push_back(entry.path().string());
  if (files.empty())
    throw InputError(
        {.file = folder, .problem = "has no images in it", .remedy = "name files, or another folder"});
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> matches_of(const std::string& pattern) {
  glob_t found{};
  std::vector<std::string> files;
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i) files.emplace_back(found.gl_pathv[i]);
  globfree(&found);
  if (files.empty())
    throw InputError(
        {.file = pattern, .problem = "no file matches this pattern", .remedy = "check the path"});
  return files;
}

} // namespace

std::vector<std::string> image_files(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  std::set<std::string> known;
  const auto add = [&](const std::vector<std::string>& some) {
    for (const std::string& file : some)
      if (known.insert(file).second) files.push_back(file);
  };
  for (const std::string& argument : arguments) {
    std::error_code ignored;
    const bool is_pattern =
        argument.find_first_of("*?[") != std::string::npos && !fs::exists(argument, ignored);
    if (fs::is_directory(argument, ignored))
      add(images_in(argument));
    else
      add(is_pattern ? matches_of(argument) : std::vector<std::string>{argument});
  }
  return files;
}

} // namespace surfgrad::cli
