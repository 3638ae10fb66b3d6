// What a surface seen from behind shows.

#include "gallery/figures.hpp"
#include "gallery/meshes.hpp"
#include "gallery/parts.hpp"

namespace surfgrad::gallery {

std::vector<Figure> back_face_figures(const std::shared_ptr<Maps>& maps) {
  const auto panel = [maps](stack::BackFaces mode) {
    return [maps, mode] {
      scene::Scene scene = scene_of(scroll());
      look_from(scene, -8, 36);
      light_from(scene, {-0.4, 0.9, 0.6});
      scene.materials[0].back_faces = mode;
      scene.materials[0].layers = {normal_map(scene, *maps, "studs", {.tile = {1, 1}}, 0.8)};
      return scene;
    };
  };
  return {{"back-faces",
           "Both sides of one sheet",
           "A sheet embossed with domes, rolled up so that its outside and its inside show. The outside is "
           "the same in all pictures; look at the inside.",
           {{"same", "same",
             "The inside keeps the outside's normal: it is lit as if one saw through to the other side.",
             Way::choice, "", panel(stack::BackFaces::same)},
            {"mirror", "mirror",
             "The inside is lit as an inside, and its domes rise towards the viewer, as if each side had "
             "been embossed on its own.",
             Way::choice, "", panel(stack::BackFaces::mirror)},
            {"flip", "flip", "As a real sheet would look: what rises outside is a dent inside.", Way::choice,
             "", panel(stack::BackFaces::flip)},
            {"cull", "cull", "The inside is not drawn at all.", Way::choice, "",
             panel(stack::BackFaces::cull)}}}};
}

} // namespace surfgrad::gallery
