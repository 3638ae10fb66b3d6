#pragma once

/// Fragments of a surface in lanes, interpolated from the setups of its triangles.

#include "raster/fragment.hpp"
#include "raster/triangle_setup.hpp"
#include "simd/lane.hpp"

#include <surfgrad/noise_hash.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::raster {

/// What of a surface's fragments is wanted, the same for all its fragments. What is not stays zero.
struct Wanted {
  bool screen = true;     ///< perspective, and triangles show one side; else a texture, whose front shows
  bool to_viewer = false; ///< from the origin, where the eye is
  bool object_position = true;
  bool normal_derivatives = true;
  int slots = 0;                             ///< texture coordinates
  std::array<bool, max_uv_slots> present{};  ///< the mesh has them
  std::array<bool, max_uv_slots> tangents{}; ///< and a tangent space for them
};

/// The setups of the triangles that lanes lie in: of one, or of several.
template <LaneScalar T>
class LaneSetup {
 public:
  /// which  of the setups: lane_count<T> numbers. Those of one triangle should lie together.
  LaneSetup(const TriangleSetup* setups, const std::int32_t* which) : setups_(setups), which_(which) {
    const index_t<T> numbers = load_index<T>(which);
    shown_[0] = which[0];
    for (int i = 1; i < lane_count<T>; ++i) {
      if (which[i] == which[i - 1]) continue;
      if (count_ == most_blended) {
        count_ = too_many;
        return;
      }
      shown_[count_] = which[i];
      in_[count_++] = numbers == detail::index_constant<T>(which[i]);
    }
  }

  /// A float of each lane's setup.
  template <class Member>
  [[nodiscard]] T at(Member member) const {
    const auto of = [&](std::int32_t i) { return static_cast<value_t<T>>(member(setups_[i])); };
    if (count_ == too_many) {
      value_t<T> each[lane_count<T>];
      for (int i = 0; i < lane_count<T>; ++i) each[i] = of(which_[i]);
      return load<T>(each);
    }
    T value = T(of(shown_[0]));
    for (int k = 1; k < count_; ++k) value = select(in_[k], T(of(shown_[k])), value);
    return value;
  }

 private:
  static constexpr int most_blended = 4; ///< more are cheaper lane by lane
  static constexpr int too_many = -1;

  const TriangleSetup* setups_;
  const std::int32_t* which_;
  int count_ = 1;
  std::int32_t shown_[most_blended];
  mask_t<T> in_[most_blended];
};

/// Interpolates attributes at raster positions.
template <LaneScalar T>
class Interpolator {
 public:
  Interpolator(const LaneSetup<T>& setup, bool perspective, vec2<T> raster)
      : setup_(setup), perspective_(perspective) {
    const auto of = [&](auto member) { return setup.at(member); };
    d_ = raster - vec2<T>{of([](const TriangleSetup& s) { return s.x; }),
                          of([](const TriangleSetup& s) { return s.y; })};
    if (!perspective) return;
    qx_ = of([](const TriangleSetup& s) { return s.qx; });
    qy_ = of([](const TriangleSetup& s) { return s.qy; });
    const T one = T(value_t<T>(1));
    r_ = one / (one + qx_ * d_.x + qy_ * d_.y);
  }

  struct Value {
    T at, dx, dy;
  };
  /// An attribute and its derivatives. plane: const Plane&(const TriangleSetup&)
  template <class PlaneOf>
  [[nodiscard]] Value operator()(PlaneOf plane) const {
    const T at = setup_.at([&](const TriangleSetup& s) { return plane(s).at; });
    const T dx = setup_.at([&](const TriangleSetup& s) { return plane(s).dx; });
    const T dy = setup_.at([&](const TriangleSetup& s) { return plane(s).dy; });
    const T step = dx * d_.x + dy * d_.y;
    if (!perspective_) return {at + step, dx, dy};
    const T change = step * r_;
    return {at + change, (dx - change * qx_) * r_, (dy - change * qy_) * r_};
  }

  struct Vector {
    vec3<T> at, dx, dy;
  };
  /// planes: const std::array<Plane, 3>&(const TriangleSetup&)
  template <class PlanesOf>
  [[nodiscard]] Vector vector(PlanesOf planes) const {
    const Value x = (*this)([&](const TriangleSetup& s) { return planes(s)[0]; });
    const Value y = (*this)([&](const TriangleSetup& s) { return planes(s)[1]; });
    const Value z = (*this)([&](const TriangleSetup& s) { return planes(s)[2]; });
    return {{x.at, y.at, z.at}, {x.dx, y.dx, z.dx}, {x.dy, y.dy, z.dy}};
  }

 private:
  const LaneSetup<T>& setup_;
  bool perspective_;
  vec2<T> d_;
  T qx_, qy_, r_;
};

/// The fragments of triangles at raster positions.
///
/// setups, which  the triangles of the lanes
template <LaneScalar T>
[[nodiscard]] Fragment<T> interpolate(const TriangleSetup* setups, const std::int32_t* which,
                                      const Wanted& wanted, vec2<T> raster) {
  const LaneSetup<T> setup(setups, which);
  const Interpolator<T> attribute(setup, wanted.screen, raster);
  const T zero = T(value_t<T>(0));
  const vec3<T> none{zero, zero, zero};
  Fragment<T> f; // texture coordinates that nobody carries stay unset
  f.slots = wanted.slots;
  f.raster = raster;
  const auto position = attribute.vector([](const TriangleSetup& s) { return s.position; });
  f.position = position.at;
  f.dp_dx = position.dx;
  f.dp_dy = position.dy;
  f.object_position = wanted.object_position
                          ? attribute.vector([](const TriangleSetup& s) { return s.object_position; }).at
                          : none;
  f.to_viewer = wanted.to_viewer ? normalize_or_zero(-f.position) : none;
  const auto normal = attribute.vector([](const TriangleSetup& s) { return s.normal; });
  // Vertex normals are unit or zero: what is shorter than this is the rounding of normals that cancel.
  f.normal_is_absent = !(constant<T>(1e-6) < max_abs(normal.at));
  f.normal = normal.at;
  if (any(f.normal_is_absent)) {
    const vec3<T> flat{setup.at([](const TriangleSetup& s) { return s.flat_normal.x; }),
                       setup.at([](const TriangleSetup& s) { return s.flat_normal.y; }),
                       setup.at([](const TriangleSetup& s) { return s.flat_normal.z; })};
    f.normal = select<T>(f.normal_is_absent, flat, f.normal);
  }
  f.dn_dx = wanted.normal_derivatives ? normal.dx : none;
  f.dn_dy = wanted.normal_derivatives ? normal.dy : none;
  // Winding in a texture says mirrored, not turned away.
  f.front_facing = wanted.screen
                       ? mask_t<T>(zero < setup.at([](const TriangleSetup& s) { return s.front_facing; }))
                       : mask_t<T>(zero == zero);
  for (int s = 0; s < wanted.slots; ++s) {
    const auto slot = static_cast<std::size_t>(s);
    UvFragment<T>& uv = f.uvs[slot];
    if (!wanted.present[slot]) {
      uv = {{zero, zero}, {zero, zero}, {zero, zero}, {zero, zero}, {zero, zero}, none, zero};
      continue;
    }
    const auto st = [&](std::size_t i) {
      return attribute([=](const TriangleSetup& t) { return t.slots[slot].st[i]; });
    };
    const auto u = st(0);
    const auto v = st(1);
    uv.st = {u.at, v.at};
    uv.dst_dx = {u.dx, v.dx};
    uv.dst_dy = {u.dy, v.dy};
    uv.footprint_dx = uv.dst_dx;
    uv.footprint_dy = uv.dst_dy;
    uv.tangent = none;
    uv.sign = zero;
    if (!wanted.tangents[slot]) continue;
    uv.tangent = attribute.vector([=](const TriangleSetup& t) { return t.slots[slot].tangent; }).at;
    uv.sign = setup.at([=](const TriangleSetup& t) { return t.slots[slot].sign; });
  }
  return f;
}

} // namespace surfgrad::raster
