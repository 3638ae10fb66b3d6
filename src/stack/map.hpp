#pragma once

#include "stack/words.hpp"

#include <surfgrad/vec.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace surfgrad::stack {

template <class T>
class Fields;
struct Value;

/// A file a document names, and where it names it, for the message if it cannot be read.
struct FileName {
  std::filesystem::path path{}; ///< as written: relative to the document's folder, or absolute; never empty
  int line = 0;                 ///< 0 where no document names it
  std::string key{};            ///< e.g. `layers[2].mask.map`
};

/// How a 2D map lies on a plane of coordinates st (origin lower left, t up):
///   st' = R(rotate_deg) * (tile * st) + offset, R counter-clockwise.
struct Tiled {
  vec2<double> tile{1, 1}; ///< neither component is zero; a negative one mirrors
  double rotate_deg = 0;
  vec2<double> offset{0, 0}; ///< in units of the map
  Wrap wrap = Wrap::repeat;
  /// Along t where it differs: a model's sampler can say so, a document has one word for both axes.
  std::optional<Wrap> wrap_t{};
  Filter filter = Filter::trilinear; ///< normal only for tangent-space normal maps
  int anisotropy = 8;                ///< most probes of the anisotropic filter, 1 to 16
  Tiling tiling = Tiling::plain;     ///< hex only with Wrap::repeat
  double hex_turn_deg = 180;         ///< 0 to 180: hex tiles turn at random by up to this, either way

  static const Fields<Tiled>& fields();
};

/// Refuses hex tiling, for maps that are more than a picture on a plane. `why` completes "is hex, but".
void refuse_hex_tiling(const Tiled& tiled, const Value& value, const char* why);

/// Refuses the filter of encoded normals for maps of anything else. `what` completes "is normal, but this
/// is".
void refuse_normal_filter(const Tiled& tiled, const Value& value, const char* what);

/// A 2D map on a texture coordinate of the mesh.
struct Texture : Tiled {
  FileName file{};
  int uv = 0;      ///< texture coordinate set, 0 to 7
  int uv_line = 0; ///< line of `uv`, or of the object that leaves it out

  static const Fields<Texture>& fields();
};

/// A map of normals.
struct Map : Texture {
  /// Whether the y of its vectors grows with the green channel, or against it.
  Green green = Green::up;

  static const Fields<Map>& fields();
};

/// A map of normals in tangent space.
struct TangentMap : Map {
  Channels channels = Channels::automatic;

  static const Fields<TangentMap>& fields();
};

/// A map that weighs a layer, 0 to 1 per point.
struct Mask : Texture {
  static constexpr std::string_view format_name = "mask";
  MaskChannel channel = MaskChannel::r;

  static const Fields<Mask>& fields();
};

} // namespace surfgrad::stack
