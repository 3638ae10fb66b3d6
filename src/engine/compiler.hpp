#pragma once

#include "engine/bump_map.hpp"
#include "engine/layers/decal.hpp"
#include "engine/layers/height_map.hpp"
#include "engine/layers/influence.hpp"
#include "engine/layers/noise.hpp"
#include "engine/layers/normal_map.hpp"
#include "engine/layers/object_normal_map.hpp"
#include "engine/layers/parallax.hpp"
#include "engine/layers/planar.hpp"
#include "engine/layers/resolve.hpp"
#include "engine/layers/triplanar.hpp"
#include "engine/map_library.hpp"
#include "raster/surface.hpp"
#include "stack/stack.hpp"

#include <memory>
#include <vector>

namespace surfgrad::engine {

/// What it takes to turn the layers of a document into those that run.
class Compiler {
 public:
  /// slots  texture coordinates that the surfaces carry: every one the layers read
  /// Both must outlive the compiler.
  Compiler(const std::vector<raster::UvSlot>& slots, MapLibrary& maps) : slots_(slots), maps_(maps) {}

  [[nodiscard]] MapLibrary& maps() const { return maps_; }
  [[nodiscard]] TiledMap tiled(const stack::Tiled& use, std::shared_ptr<const image::Map> map) const;
  [[nodiscard]] Texture texture(const stack::Texture& use, std::shared_ptr<const image::Map> map) const;
  [[nodiscard]] BumpMap bump_map(const stack::BumpCodes& use, stack::Content content,
                                 const stack::FileName& file) const;
  [[nodiscard]] BumpMap bump_map(const stack::BumpMap& use, const stack::FileName& file) const {
    return bump_map(use, use.content, file);
  }
  [[nodiscard]] Influence influence(const stack::LayerCommon& common) const;
  [[nodiscard]] std::optional<Texture> mask(const stack::LayerWeight& common) const;
  /// Cosine and sine of an angle in degrees; exact for whole quarter turns.
  [[nodiscard]] static vec2<double> rotation(double degrees);

 private:
  const std::vector<raster::UvSlot>& slots_;
  MapLibrary& maps_;
};

// One for each kind, beside its kernel in layers/.
[[nodiscard]] NormalMap compiled(const stack::NormalMapLayer& layer, const Compiler& compiler);
[[nodiscard]] NormalMap compiled(const stack::DerivativeMapLayer& layer, const Compiler& compiler);
[[nodiscard]] HeightMap compiled(const stack::HeightMapLayer& layer, const Compiler& compiler);
[[nodiscard]] ObjectNormalMap compiled(const stack::ObjectNormalMapLayer& layer, const Compiler& compiler);
[[nodiscard]] VolumeNoise compiled(const stack::NoiseLayer& layer, const Compiler& compiler);
[[nodiscard]] Planar compiled(const stack::PlanarLayer& layer, const Compiler& compiler);
[[nodiscard]] Triplanar compiled(const stack::TriplanarLayer& layer, const Compiler& compiler);
[[nodiscard]] Decals compiled(const stack::DecalLayer& layer, const Compiler& compiler);
[[nodiscard]] Parallax compiled(const stack::ParallaxLayer& layer, const Compiler& compiler);
[[nodiscard]] Resolve compiled(const stack::ResolveLayer& layer, const Compiler& compiler);

} // namespace surfgrad::engine
