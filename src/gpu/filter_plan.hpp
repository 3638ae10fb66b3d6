#pragma once

#include "engine/program.hpp"
#include "gpu/filter_error.hpp"
#include "gpu/mesh_reach.hpp"
#include "shadergen/shadergen.hpp"

#include <cstddef>
#include <functional>
#include <vector>

namespace surfgrad::gpu {

/// Which maps of a material hardware may filter, and how far its normals are then from those of exact
/// filters.
///
/// A map is filtered by hardware where it is known how much its error turns the normal at most. Derivation
/// (docs/device.md has it at length): a pass's normal has the direction of n - G, G the sum of its surface
/// gradients. Both ends of a change of G lie beyond a plane at the distance d = 1 - |n . G| from where
/// directions start, so that the angle between them is at most |change of G| / d. G lies in the tangent plane
/// and d is 1, but for what interpolated tangents lend it along the normal (MeshReach). G changes by weight *
/// scale * the change of each slope, and by the change of a mask times the layer's steepest gradient. A later
/// pass starts from a normal that is off by a, and its own is off by at most (1 + turn) * a: a volume
/// gradient v adds |v| to turn; a slope on a tangent frame, which turns by at most a / cos(tilt of the
/// normal from the surface), adds its size divided by that.
class FilterPlan {
 public:
  /// even  no object of the material is scaled more along one direction than along another
  FilterPlan(const engine::Program& program, const MeshReach& mesh, bool even);

  /// Whether the error of a map can be followed to the normal, and is not magnified more than fourfold on the
  /// way by what later passes may be at worst.
  [[nodiscard]] bool follows(const shadergen::MapSite& site) const;
  /// Counts an error of a map that `follows`: of several that one site reads, the largest.
  void count(const shadergen::MapSite& site, double error);
  /// Between the normals and those of exact filters, with all errors counted: at most pi.
  [[nodiscard]] double largest_angle() const;

  // Of the plan itself.

  /// How a layer joins its pass: what it adds has weights from 0 to `opacity`.
  struct Weight {
    double opacity = 1;
    double scale = 1; ///< magnitude
    bool mix = false;
  };
  /// What a layer may add to G before its weight; infinite where that is not known.
  struct Gradient {
    double gain = 0;     ///< its change by a change of what its maps give
    double steepest = 0; ///< its length
    double lean = 0;     ///< its part along the normal
    double turn = 0;     ///< its change by a turn of the pass's normal
  };

 private:
  struct Layer {
    Weight weight{};
    double gain = 0, mask_gain = 0;
    std::size_t pass = 0;
    double error = 0, mask_error = 0;
  };
  struct Pass {
    double distance = 1; ///< d
    double growth = 1;   ///< of an error of the normal it starts from
  };
  /// How much an error of a pass's normal has grown at the end.
  [[nodiscard]] double growth_after(std::size_t pass) const;

  std::vector<Layer> layers_;
  std::vector<Pass> passes_;
};

} // namespace surfgrad::gpu
