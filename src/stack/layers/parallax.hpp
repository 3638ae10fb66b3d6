#pragma once

#include "stack/layers/common.hpp"

namespace surfgrad::stack {

/// A map of heights that moves what is seen: the layers after it lie on a virtual surface, displaced
/// along the base normal. Its scale and its weight multiply the displacement.
struct ParallaxLayer {
  static constexpr std::string_view type = "parallax";
  /// Moving the surface under a sum of gradients that are not resolved yet would mean nothing.
  static constexpr bool opens_pass = true;
  LayerCommon common{};
  Texture map{};
  MaskChannel channel = MaskChannel::r;
  ParallaxMethod method = ParallaxMethod::occlusion;
  double height = 0.05;      ///< > 0: displacement of the value 1, in units of the scene
  double level = 0;          ///< the value that lies on the mesh: 0 rises from it, 1 is carved into it
  bool limit_offset = false; ///< method offset: no longer way at grazing views (Welsh)
  ParallaxLod lod = ParallaxLod::base;
  ParallaxNormal normal = ParallaxNormal::height;
  bool curvature = true; ///< the base normal turns on the way that the point moves
  Facing facing = Facing::keep;
  bool self_shadow = false; ///< relief in the way to the sun keeps it off

  static const Fields<ParallaxLayer>& fields();
};

} // namespace surfgrad::stack
