#pragma once

#include "stack/bump_map.hpp"
#include "stack/layers/common.hpp"

#include <array>
#include <optional>
#include <vector>

namespace surfgrad::stack {

/// Where a decal sits and how large it is, in units of its space. Sizes of shapes other than the layer's
/// are without meaning.
struct DecalPlacement {
  vec3<double> position{0, 0, 0};   ///< centre of a box, sphere or capsule; apex of a cone or wedge
  vec3<double> direction{0, -1, 0}; ///< the way it projects, into the surface; any length but 0
  double roll_deg = 0; ///< turns the image counter-clockwise, seen along `direction`, from the upright
  /// Instead of these: takes the decal's own space to its space, column by column. x and y lie along the
  /// image's s and t, z points out of the surface. Columns are perpendicular, of any handedness; their
  /// lengths scale the sizes below.
  std::optional<std::array<double, 16>> transform{};

  vec3<double> size{1, 1, 1}; ///< edges of a box, along s, t and the direction
  double angle_deg = 60;      ///< between opposite sides of a cone or wedge, 0 to 180
  double depth = 1;           ///< of a cone or wedge, along the direction
  double radius = 0.5;        ///< of a sphere or capsule
  double length = 1;          ///< of the segment along s that a capsule or wedge is drawn out over; may be 0

  static const Fields<DecalPlacement>& fields();
};

/// One decal of a layer: what it leaves out is as in the layer.
struct DecalInstance : DecalPlacement {
  static constexpr std::string_view format_name = "decal_instance";
  std::optional<double> scale{};
  std::optional<double> opacity{}; ///< 0 to 1
  std::optional<DecalBlend> blend{};

  static const Fields<DecalInstance>& fields();
};

/// Images of bumps projected onto whatever lies within a shape, and decals that share one.
struct DecalLayer {
  static constexpr std::string_view type = "decal";
  LayerWeight common{};
  DecalBlend blend = DecalBlend::add;
  DecalShape shape = DecalShape::box;
  /// One image; for a sphere or capsule one cube map or its six faces, +x -x +y -y +z -z.
  std::vector<FileName> files{};
  BumpMap map = clamped(); ///< how the image of a box, cone or wedge lies
  Space space = Space::world;
  double falloff = 0.1; ///< fraction of the shape over which the decal fades towards its border, 0 to 1
  ConeGradient gradient = ConeGradient::exact;                          ///< cone and wedge
  std::vector<DecalInstance> instances = std::vector<DecalInstance>(1); ///< in order

  static const Fields<DecalLayer>& fields();

 private:
  /// An image ends where its shape does: its borders must not bleed into each other.
  static BumpMap clamped() {
    BumpMap map;
    map.wrap = Wrap::clamp;
    return map;
  }
};

} // namespace surfgrad::stack
