#pragma once

#include "scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace surfgrad::gallery {

/// What a panel stands for beside the others of its figure.
enum class Way {
  choice, ///< one of several answers, all of them sound
  right,  ///< what the surface gradient framework gives
  older,  ///< how it was, or is still, done elsewhere
  wrong,  ///< a mistake that is easily made
};

/// One picture of a figure.
struct Panel {
  std::string id{};    ///< unique within the figure: letters, digits and hyphens
  std::string label{}; ///< a few words
  std::string look{};  ///< what to look at, a sentence or two
  Way way = Way::choice;
  /// For what is older or wrong: the id of the panel of this figure that shows it right.
  std::string against{};
  std::function<scene::Scene()> scene{}; ///< may be called from any thread
};

/// Pictures that are to be seen side by side.
struct Figure {
  std::string id{}; ///< unique: letters, digits and hyphens
  std::string title{};
  std::string caption{};
  std::vector<Panel> panels{};
};

/// The name of a panel's picture, beside the page.
[[nodiscard]] inline std::string picture_name(const Figure& figure, const Panel& panel) {
  return figure.id + "-" + panel.id + ".png";
}

} // namespace surfgrad::gallery
