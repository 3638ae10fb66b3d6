#pragma once

#include "image/image.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace surfgrad::gallery {

/// The built-in maps, each made when it is first asked for and then shared by all scenes. Safe to use
/// from any thread.
///
///   flat            a normal map that says nothing
///   plates, weave   those of the demo; stripes: its mask
///   grain           isotropic noise over four octaves
///   studs           domes, steep at their rims
///   ripples         fine waves, steep, across the domes
///   letter          a raised F on a field of knobs: which way up it lies is plain to see
///   letter cube     the same as a cube map: the F on the face +z, knobs all around
///   cobbles         heights of rounded stones
///   crags           a rock face of a few large forms and much fine detail
///   rock            tangent-space normals of the rock on its mesh, baked by this program
///   rock object     the same as object-space normals
///   ledged rock     object-space normals of a rock with level ledges, on the rock's mesh
///   linear, udn, whiteout, reoriented         studs and ripples made one map
///   cobbles         heights: worn stones in courses, rounded at their rims
///   coarse heights  heights of 16x16 texels, smooth: to be magnified
///   flat linear, flat udn, flat whiteout, flat reoriented     flat and studs made one map
class Maps {
 public:
  /// name  one of the above; anything else is a mistake of the caller (std::out_of_range)
  [[nodiscard]] std::shared_ptr<const image::Image> operator[](const std::string& name);

  /// Gives the map to a scene; returns how a layer names it.
  [[nodiscard]] stack::FileName in(scene::Scene& scene, const std::string& name);

 private:
  struct Entry {
    std::once_flag once{};
    std::shared_ptr<const image::Image> image{};
  };
  std::mutex mutex_{};
  std::map<std::string, Entry> entries_{};
};

} // namespace surfgrad::gallery
