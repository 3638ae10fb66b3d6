#pragma once

#include "stack/map.hpp"
#include "stack/noise_function.hpp"

#include <optional>
#include <string>
#include <vector>

namespace surfgrad::stack {

/// A height map on a texture coordinate of the mesh. It is read through a smooth curve over 4x4 texels of the
/// file itself, so `filter` and `tiling` do not apply.
struct DisplacementMap : Texture {
  static constexpr std::string_view format_name = "displacement_map";
  MaskChannel channel = MaskChannel::r;

  static const Fields<DisplacementMap>& fields();
};

/// What moves the vertices of the meshes: each goes along its normal by height * (value - level).
struct Displace {
  static constexpr std::string_view format_name = "displace";
  /// Each level makes four triangles of one: six make 4096.
  static constexpr int most_levels = 6;

  NoiseFunction noise{};                ///< of the object's space; counts where there is no map
  std::optional<DisplacementMap> map{}; ///< values 0 to 1, of a float file as they are
  double height = 1;                    ///< object units by which a value of 1 moves; any sign
  double level = 0;                     ///< the value that stays on the mesh
  int subdivide = 0;                    ///< 0 to most_levels: levels of subdivision before
  Edges edges = Edges::straight;        ///< where the subdivision puts new vertices
  int line = 0;                         ///< of the block; 0 where no document gives it
  int subdivide_line = 0;               ///< of `subdivide`, or of the block that leaves it out

  static const Fields<Displace>& fields();
};

/// How far a glTF mesh is pulled towards its morph targets.
struct MorphWeights {
  std::vector<double> weights{}; ///< one a target from the first on; the file's own where there are none
  int line = 0;
};

} // namespace surfgrad::stack
