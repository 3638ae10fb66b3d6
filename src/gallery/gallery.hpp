#pragma once

#include "diagnostic/report.hpp"
#include "gallery/figure.hpp"
#include "io/image_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace surfgrad::gallery {

struct Options {
  int width = 512;
  int height = 512;
  int samples = 2; ///< along each side of a pixel
  io::Compression compression = io::Compression::fast;
};

/// The figures of the page, in its order: the built-in ones, and with an assets folder its models.
///
/// Throws InputError where the folder is missing or holds no model with a normal map. Warns about models
/// that cannot be read; they are left out.
[[nodiscard]] std::vector<Figure> figures(const std::filesystem::path& assets, const Report& report = {});

/// A file of the gallery, ready to be written.
struct File {
  std::string name;
  std::vector<std::byte> bytes;
};

struct Drawn {
  std::vector<File> pictures{}; ///< PNG, in the order of the panels
  std::int64_t degenerate = 0;  ///< samples without a normal or a tangent frame, over all pictures
};

/// Renders every panel, as many at once as there are threads. Same bytes for any number of them.
///
/// Throws as render does; Cancelled where the progress callback asks to stop.
[[nodiscard]] Drawn draw(const std::vector<Figure>& figures, const Options& options,
                         const Report& report = {});

/// What write would refuse before there is anything to write: a name that is taken by a file, a missing
/// parent, a folder that cannot be written. Throws as io::check_writable does.
void check_folder(const std::filesystem::path& folder);

/// Writes the pictures, then index.html, each whole or not at all; makes the folder where it is missing.
/// The page shows those of `figures` whose pictures are all in the folder: after a part was drawn anew it
/// shows the rest as well.
///
/// Throws as io::write_file does.
void write(const std::filesystem::path& folder, const std::vector<Figure>& figures,
           const std::vector<File>& pictures, const Options& options);

} // namespace surfgrad::gallery
