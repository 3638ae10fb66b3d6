#pragma once

#include "mesh/triangle_mesh.hpp"
#include "raster/fragment.hpp"

#include <surfgrad/vec.hpp>

#include <cstdint>
#include <vector>

namespace surfgrad::raster {

/// A texture coordinate that layers use, and whether one of them needs vertex tangents for it.
struct UvSlot {
  int uv_set;
  bool tangents;
};

/// A mesh placed in the world: what the rasteriser interpolates, in double.
struct Surface {
  const mesh::TriangleMesh* mesh = nullptr;
  std::vector<vec3<double>> positions; ///< one a vertex, world space relative to the origin given
  std::vector<vec3<double>> normals;   ///< one a vertex, unit (or zero)
  struct Coordinates {
    bool present = false;               ///< the mesh has this UV set
    std::vector<vec2<double>> st;       ///< one a vertex
    std::vector<vec4<double>> tangents; ///< one a triangle corner, unit xyz and sign; or empty
  };
  std::vector<Coordinates> slots; ///< parallel to the UvSlots asked for
  bool mirrored = false;          ///< the transform turns winding over (negative determinant)
};

/// Upper left 3x3 part of an affine transform.
[[nodiscard]] mat3<double> linear_part(const mat4<double>& m);

/// Places a mesh in the world.
///
/// world_from_object  affine; may scale non-uniformly and mirror. Normals go through
///                    transform_normal, tangents through the linear part, both normalised at the
///                    vertex; a mirroring transform also negates the tangent's sign.
/// origin             world position that becomes zero: the camera, so that float precision lies
///                    where the eye does
/// slots              UV sets to carry; one that the mesh lacks stays absent. Tangents come from the
///                    mesh where it has them, else from MikkTSpace.
[[nodiscard]] Surface place_mesh(const mesh::TriangleMesh& mesh, const mat4<double>& world_from_object,
                                 vec3<double> origin, const std::vector<UvSlot>& slots);

/// Projective setup of one triangle: where it lies in the raster and how attributes vary over it.
///
/// Works in homogeneous coordinates, so no triangle is ever clipped: the three edge functions are
/// linear in the raster position and give barycentrics divided by w, whatever the signs of w.
class TrianglePlanes {
 public:
  /// corners are (x w, y w, w) in pixels, y up. For a raster without perspective w is 1.
  explicit TrianglePlanes(const std::array<vec3<double>, 3>& corners);

  /// Zero area (or an edge-on view): covers nothing.
  [[nodiscard]] bool degenerate() const { return degenerate_; }
  /// Counter-clockwise in the raster.
  [[nodiscard]] bool counter_clockwise() const { return counter_clockwise_; }
  /// Whether the point lies inside. A point on an edge shared by two triangles belongs to one.
  [[nodiscard]] bool covers(double x, double y) const;
  /// Linear functions e of the raster position, positive inside: e.x * x + e.y * y + e.z.
  [[nodiscard]] const std::array<vec3<double>, 3>& edges() const { return edges_; }
  /// How far from zero they must be at a point within |x| <= x_most and |y| <= y_most so that covers()
  /// agrees with their signs there.
  [[nodiscard]] std::array<double, 3> margins(double x_most, double y_most) const;
  /// Around all points inside, up to rounding. Everything where a corner lies at or behind the eye.
  struct Box {
    double x_low, y_low, x_high, y_high;
  };
  [[nodiscard]] Box box() const;
  /// 1 / w at the point: larger is nearer. Positive where covers() holds.
  [[nodiscard]] double inverse_w(double x, double y) const {
    return scale_ * (sum_.x * x + sum_.y * y + sum_.z);
  }

  /// Barycentrics at a point and their derivatives by x and y, perspective-correct.
  struct Barycentrics {
    std::array<double, 3> value, dx, dy;
  };
  [[nodiscard]] Barycentrics barycentrics(double x, double y) const;
  /// Change of 1 / w per pixel to the right and upwards, relative to 1 / w at the point.
  [[nodiscard]] vec2<double> relative_change(double x, double y) const;

 private:
  std::array<vec3<double>, 3> corners_;
  std::array<vec3<double>, 3> edges_{}; // edge function i = dot(edges_[i], (x, y, 1)), >= 0 inside
  vec3<double> sum_{};                  // of the edge functions
  double scale_ = 0;                    // 1 / |det|: turns their sum into 1 / w
  bool counter_clockwise_ = false;
  bool degenerate_ = true;
};

/// Unit, as vertex normals are: the strength of bumps follows the length of the normal.
[[nodiscard]] vec3<double> triangle_normal(const Surface& surface, std::uint32_t triangle);

/// The fragment of a triangle at a raster position.
///
/// front_facing is the winding in the raster, corrected for a mirroring transform. to_viewer is zero: the
/// raster knows no eye.
[[nodiscard]] Fragment<double> make_fragment(const Surface& surface, std::uint32_t triangle,
                                             const TrianglePlanes& planes, double x, double y);

} // namespace surfgrad::raster
