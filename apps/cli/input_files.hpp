#pragma once

#include <string>
#include <vector>

namespace surfgrad::cli {

/// The files that arguments mean, each once, those of a folder or pattern in the order of their names: a file
/// as it is, a folder for the images in it (not in its folders), a pattern with * and ? for what matches it
/// (where the shell has not done so).
///
/// Throws InputError for a folder without images and for a pattern that nothing matches.
[[nodiscard]] std::vector<std::string> image_files(const std::vector<std::string>& arguments);

} // namespace surfgrad::cli
