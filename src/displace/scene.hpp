#pragma once

#include "diagnostic/report.hpp"
#include "scene/scene.hpp"

#include <cstddef>
#include <optional>

namespace surfgrad::displace {

/// Triangles that the meshes of a scene may have together after a subdivision: with their vertices and the
/// search for edges they take about 4 GiB.
inline constexpr std::size_t most_triangles = std::size_t{1} << 24;

/// A scene whose displacement is done.
struct DisplacedScene {
  scene::Scene scene{}; ///< without `displace`; its meshes hold their rest positions
  // Over all meshes:
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  double lowest = 0, highest = 0; ///< in object units
  std::size_t joined_places = 0;
  std::size_t parted_places = 0;
};

/// Carries out a scene's displacement; nothing where it has none. Jobs begin with this, so that a camera
/// frames, a bake unwraps and a file holds the same mesh.
///
/// Warns where a mesh may have opened. Throws InputError where the subdivision makes too many triangles or
/// the height moves a vertex out of the range of numbers; Cancelled.
[[nodiscard]] std::optional<DisplacedScene> displaced(const scene::Scene& scene, const Report& report = {});

} // namespace surfgrad::displace
