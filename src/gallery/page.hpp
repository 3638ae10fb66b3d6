#pragma once

#include "gallery/figure.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace surfgrad::gallery {

/// Text as HTML content or as a quoted attribute.
[[nodiscard]] std::string escaped(std::string_view text);

/// One static HTML page of all figures: no script, pictures by their relative names, each of the given
/// size in pixels.
[[nodiscard]] std::string page(const std::vector<Figure>& figures, int width, int height);

} // namespace surfgrad::gallery
