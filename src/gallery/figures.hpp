#pragma once

#include "gallery/figure.hpp"
#include "gallery/maps.hpp"

#include <filesystem>
#include <memory>
#include <vector>

namespace surfgrad::gallery {

// The figures in groups, a file each. Their scenes share the maps.

[[nodiscard]] std::vector<Figure> detail_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> blending_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> basis_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> back_face_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> transform_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> height_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> displacement_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> morphing_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> volume_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> projection_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> decal_figures(const std::shared_ptr<Maps>& maps);
[[nodiscard]] std::vector<Figure> tiling_figures(const std::shared_ptr<Maps>& maps);

/// Every built-in figure, in the order of the page.
[[nodiscard]] std::vector<Figure> built_in_figures();

} // namespace surfgrad::gallery
