#pragma once

#include "shadergen/generator.hpp"

#include <functional>
#include <vector>

namespace surfgrad::shadergen {

/// A map as one layer lays it on a plane of coordinates st (engine/texture.hpp): st' = R * (tile * st) +
/// offset. What the stack leaves as it is by default costs nothing and is no parameter.
class MapUse {
 public:
  /// what  names the texture and the parameters after the layer: `map`, `mask`
  MapUse(Generator& generator, const stack::Tiled& tiled, TextureBinding binding, const std::string& what);

  // Functions of (vec2 st, vec2 dst_dx, vec2 dst_dy), coordinate and footprint on the plane; their names.

  /// vec2: the slope along st of a map of slopes, normals or derivatives. Where the map tells_variance()
  /// vec3: the slope, and the variance of the slopes along an axis that the filter hides.
  [[nodiscard]] std::string slope_function() const;
  [[nodiscard]] bool tells_variance() const;
  /// float: a weight, or a height.
  [[nodiscard]] std::string value_function() const;
  /// vec3: a direction, of any length.
  [[nodiscard]] std::string direction_function() const;
  /// vec2: the derivative by st of a map of heights.
  [[nodiscard]] std::string height_slope_function() const;

  // Pieces of functions.

  /// Where the map is read: the whole plane, or one of the hex tiles over a point.
  struct Place {
    std::string st;        ///< in the map
    std::string footprint; ///< arguments of what filters
    std::string rotation;  ///< of a tile, as an expression; empty on the whole plane
  };
  /// Lines that declare where and how the map is read (places) for vec2 st, dst_dx and dst_dy.
  [[nodiscard]] std::string place_lines() const;
  /// Where those lines have the map read: one place, or three.
  [[nodiscard]] std::vector<Place> places() const;
  /// Height or weight there.
  [[nodiscard]] std::string value(const Place& place) const;
  /// Derivative of the heights by the coordinate of the place.
  [[nodiscard]] std::string height_slope(const Place& place) const;
  /// A change of st' as one of the coordinate of the place, and a derivative by that as one by st'.
  [[nodiscard]] std::string in_place(const Place& place, const std::string& change) const;
  [[nodiscard]] std::string from_place(const Place& place, const std::string& derivative) const;
  /// What three values of tiles are together, by place alone; `a` itself where there are no tiles.
  [[nodiscard]] std::string blended(const std::vector<std::string>& values) const;

  /// Whether st' is something else than st.
  [[nodiscard]] bool moved() const;
  [[nodiscard]] std::string in_map(const std::string& change) const;
  [[nodiscard]] std::string map_coordinate(const std::string& st) const;
  [[nodiscard]] std::string along_coordinate(const std::string& slope) const;
  [[nodiscard]] std::string by_coordinate(const std::string& derivative) const;

  /// Of level 0, as vec2.
  [[nodiscard]] std::string size() const;
  [[nodiscard]] bool trilinear() const;
  /// `exact` access: the number of the map, and its wraps, as arguments.
  [[nodiscard]] std::string exact_map() const { return std::to_string(binding().binding); }
  [[nodiscard]] std::string exact_wraps() const;
  [[nodiscard]] const TextureBinding& binding() const { return generator_.shader().textures[index_]; }
  /// `layer2_map`
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  [[nodiscard]] std::string texel(const Place& place) const;
  [[nodiscard]] std::string sampled_texel(const Place& place) const;
  [[nodiscard]] std::string slope(const Place& place) const;
  [[nodiscard]] std::string slope_and_variance_function() const;
  [[nodiscard]] std::string normal_code(const Place& place) const;
  [[nodiscard]] std::string direction(const Place& place) const;
  [[nodiscard]] std::string function_of(const std::string& type, const std::string& suffix,
                                        const std::string& rest) const;

  Generator& generator_;
  stack::Tiled tiled_;
  std::size_t index_ = 0; // of the binding
  std::string name_;
  std::string tile_, rotation_, offset_, hex_turn_; // parameters; empty where there are none
  std::string range_;                               // hardware: of a map of derivatives
};

/// What most bindings are alike in.
[[nodiscard]] TextureBinding binding_of(MapKind kind, const stack::Tiled& tiled, const stack::FileName& file,
                                        int uv = -1);
[[nodiscard]] TextureBinding binding_of(MapKind kind, const stack::Texture& texture);

/// The weight of a layer, mask included, as an expression of the fragment's function.
[[nodiscard]] std::string weight_of(Generator& generator, const stack::LayerWeight& common,
                                    const std::string& opacity);

/// `s.st0, s.dst0_dx, s.dst0_dy`: a texture coordinate of the surface as arguments of a function of a map.
[[nodiscard]] std::string coordinate_arguments(Generator& generator, int uv);

} // namespace surfgrad::shadergen
