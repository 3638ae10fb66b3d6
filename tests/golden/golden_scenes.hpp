#pragma once

#include "scene/scene.hpp"

#include <ostream>
#include <string>
#include <vector>

namespace surfgrad {

/// Folder of real models and maps; tests skip where it is absent.
[[nodiscard]] std::filesystem::path shared_assets();

/// A scene kept as a picture.
struct GoldenScene {
  std::string name;
  std::string model;    ///< below shared_assets(); empty: the demo's torus
  std::string document; ///< further keys of the stack document, `@` stands for the assets folder
};

[[nodiscard]] const std::vector<GoldenScene>& golden_scenes();

/// How a failing test names its scene.
inline void PrintTo(const GoldenScene& scene, std::ostream* out) { *out << scene.name; }

/// Writes the scene's document into a temporary folder and loads it.
[[nodiscard]] scene::Scene load(const GoldenScene& scene);

} // namespace surfgrad
