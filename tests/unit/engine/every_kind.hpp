#pragma once

/// One case a layer kind, and a body with six sides to try it on.

#include "lab.hpp"
#include "raster/visibility.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <ostream>

namespace surfgrad::engine::test {

/// A layer kind as the tests of every kind run it: alone, in object space or on a UV set.
struct KindCase {
  const char* name;
  /// The layers for a body of this scale: only heights in scene units depend on it.
  std::function<std::vector<stack::Layer>(double scale)> layers;
  /// Displaced in object space: follows any linear transform of the body. (Directions do too, but not
  /// those that a map holds below the surface, which listing 7 mirrors.)
  bool stretches = false;
  bool vertex_tangents = false; ///< reads the interpolated frame of the vertices
  bool one_sided = false;       ///< forward differences: looks the other way where rows run down
  bool moves = false;           ///< changes the point for what follows: needs a viewer in front
};

/// How GoogleTest names a case that fails.
inline void PrintTo(const KindCase& kind, std::ostream* out) { *out << kind.name; }

/// How the body's texture coordinates lie; the layers' textures are adapted, so that every image stays
/// where it is on the surface.
enum class UnwrappedAs { drawn, mirrored, turned, both };

/// How the body is placed and looked at.
struct View {
  mat3<double> linear = identity; ///< world_from_object, about an arbitrary origin
  /// Part of `linear` that the camera follows, so that each raster position shows the same point.
  std::optional<mat3<double>> projects_through{};
  bool rows_run_down = false;
  bool from_behind = false; ///< the fragments are said to show their back
  BackFaces mode = BackFaces::same;
};

/// What a point of the body looks like.
struct Seen {
  int side;
  vec3<double> base_normal, normal, surfgrad;
  bool degenerate;
};

/// A cube of edge 2.
class Body {
 public:
  static constexpr std::size_t point_count = 6 * 2 * 4;

  /// bend  how far the normals lean towards the corners, so that every projection has its say. With 0
  ///       the texture coordinates are not sheared in the tangent plane: a tangent frame is orthogonal,
  ///       and in sheared coordinates depends on which of the two is called s.
  explicit Body(double bend);
  [[nodiscard]] std::vector<Seen> seen(const KindCase& kind, const View& view, double scale,
                                       UnwrappedAs unwrapped) const;

 private:
  Lab lab_{};
  mesh::TriangleMesh mesh_{};
};

/// Every kind, in each of its ways that differ in their mathematics.
[[nodiscard]] std::vector<KindCase> every_kind();

} // namespace surfgrad::engine::test
