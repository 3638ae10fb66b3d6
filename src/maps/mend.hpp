#pragma once

#include "image/image.hpp"
#include "maps/inspect.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace surfgrad::maps {

/// A map without the mistakes that are certain, and what was done, a line each; none: the map as it is.
struct Mended {
  image::Image map{};
  std::vector<std::string> done{};
};

/// Mends a map of tangent-space normals: turns green up, takes the mean slope out of a map that repeats,
/// makes vectors as long as 1. What is only likely stays.
///
/// depth  of the file to be
/// Throws InputError for a map that does not look like one of tangent-space normals.
[[nodiscard]] Mended mend(const image::Image& map, const Inspection& found, image::Depth depth,
                          const std::filesystem::path& file);

} // namespace surfgrad::maps
