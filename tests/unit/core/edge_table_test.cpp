/// The edge table: what every function gives for zeros, subnormals, huge numbers, NaN, collapsed and
/// mirrored coordinates and normals that face away, as its doc comment states.

#include "support/core_functions.hpp"
#include <gtest/gtest.h>

namespace surfgrad::test {
namespace {

template <class T>
class EdgeTable : public ::testing::Test {
 protected:
  static constexpr T smallest = std::numeric_limits<T>::min(); ///< normal
  static constexpr T sub = std::numeric_limits<T>::min() / 4;  ///< subnormal
  static constexpr T huge = std::numeric_limits<T>::max();
  static constexpr T inf = std::numeric_limits<T>::infinity();
  static constexpr T nan = std::numeric_limits<T>::quiet_NaN();
  static constexpr T eps = std::numeric_limits<T>::epsilon();
  static constexpr vec3<T> o{T(0), T(0), T(0)};
  static constexpr vec3<T> x{T(1), T(0), T(0)};
  static constexpr vec3<T> y{T(0), T(1), T(0)};
  static constexpr vec3<T> z{T(0), T(0), T(1)};
  static constexpr vec2<T> s{T(1), T(0)};
  static constexpr vec2<T> t{T(0), T(1)};
  static constexpr vec2<T> o2{T(0), T(0)};

  /// The flat facing frame whose pixel is the unit square.
  static Frame<T> facing() { return make_frame(z, x, y); }

  template <std::size_t N>
  static void gives(const char* row, const std::array<T, N>& got, const std::array<double, N>& expected) {
    for (std::size_t i = 0; i < N; ++i) // exact input: a few roundings
      EXPECT_NEAR(static_cast<double>(got[i]), expected[i], 4 * eps * (1 + std::abs(expected[i])))
          << row << ", component " << i;
  }
  template <std::size_t N>
  static void gives_zero(const char* row, const std::array<T, N>& got) {
    for (std::size_t i = 0; i < N; ++i) EXPECT_EQ(got[i], T(0)) << row << ", component " << i;
  }
  /// Some component is NaN.
  template <std::size_t N>
  static void gives_nan(const char* row, const std::array<T, N>& got) {
    bool found = false;
    for (const T v : got) found |= std::isnan(v);
    EXPECT_TRUE(found) << row;
  }
  template <std::size_t N>
  static void gives_finite(const char* row, const std::array<T, N>& got) {
    for (std::size_t i = 0; i < N; ++i) EXPECT_TRUE(std::isfinite(got[i])) << row << ", component " << i;
  }
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(EdgeTable, Precisions);

TYPED_TEST(EdgeTable, Vectors) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  for (const T v : {T(0), -T(0), E::sub, -E::sub}) {
    EXPECT_EQ(reciprocal_or_zero(v), T(0));
    E::gives_zero("normalize, vanishing", flat(normalize_or_zero(vec3<T>{v, v, v})));
  }
  EXPECT_EQ(reciprocal_or_zero(E::inf), T(0));
  EXPECT_TRUE(std::isnan(reciprocal_or_zero(E::nan)));
  E::gives("normalize, smallest", flat(normalize_or_zero(vec3<T>{T(0), E::smallest, T(0)})), {0, 1, 0});
  E::gives("normalize, huge", flat(normalize_or_zero(vec3<T>{-E::huge, T(0), T(0)})), {-1, 0, 0});
  E::gives("normalize, all huge", flat(normalize_or_zero(vec3<T>{E::huge, E::huge, E::huge})),
           all_within<3>(std::sqrt(1.0 / 3)));
  E::gives_nan("normalize, NaN", flat(normalize_or_zero(vec3<T>{T(1), E::nan, T(0)})));
  E::gives_nan("normalize, Inf", flat(normalize_or_zero(vec3<T>{E::inf, T(0), T(0)})));
  EXPECT_EQ(saturated(E::inf), E::huge / 16);
  EXPECT_EQ(saturated(-E::inf), -E::huge / 16);
  EXPECT_EQ(saturated(T(-3)), T(-3));
  EXPECT_TRUE(std::isnan(saturated(E::nan)));
}

TYPED_TEST(EdgeTable, Derivatives) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  const auto three = [](V m) { return flat(derivative_from_normal(m)); };
  E::gives_zero("xyz, zero", three(E::o));
  E::gives_zero("xyz, -0", three(V{-T(0), -T(0), -T(0)}));
  E::gives_zero("xyz, flat, any length", three(V{T(0), T(0), E::sub}));
  E::gives_zero("xyz, flat, facing away", three(-E::z));
  E::gives("xyz, facing away", three(V{T(1), T(2), T(-1)}), {-1, -2});
  E::gives("xyz, huge", three(V{E::huge, T(0), E::huge}), {-1, 0});
  E::gives("xyz, subnormal", three(V{E::sub, T(0), E::sub}), {-1, 0});
  E::gives("xyz, steepest", three(V{T(0), -E::huge, T(0)}), {0, 128});
  E::gives_nan("xyz, NaN x", three(V{E::nan, T(0), T(1)}));
  E::gives_nan("xyz, NaN z", three(V{T(1), T(0), E::nan}));
  const auto two = [](T a, T b) { return flat(derivative_from_normal(vec2<T>{a, b})); };
  E::gives_zero("xy, zero", two(T(0), -T(0)));
  E::gives("xy, subnormal", two(E::sub, T(0)), {0, 0});
  E::gives("xy, edge", two(T(1), T(0)), {-128, 0});
  E::gives("xy, beyond the edge", two(T(0), T(-2)), {0, 128});
  E::gives_nan("xy, NaN", two(E::nan, T(0)));
  const auto normal = [](T a, T b) { return flat(normal_from_derivative(vec2<T>{a, b})); };
  E::gives("normal, zero", normal(T(0), -T(0)), {0, 0, 1});
  E::gives("normal, subnormal", normal(E::sub, T(0)), {0, 0, 1});
  E::gives("normal, huge", normal(-E::huge, T(0)), {1, 0, 0});
  E::gives_nan("normal, NaN", normal(T(0), E::nan));
  E::gives_zero("heights, equal", flat(derivative_from_heights(E::huge, E::huge, E::huge)));
  E::gives_nan("heights, NaN", flat(derivative_from_heights(E::nan, T(0), T(0))));
  const vec4<T> ones{T(1), T(1), T(1), T(1)};
  const mat4<T> constant_map{ones, ones, ones, ones};
  for (const T f : {T(0), T(0.5), T(1)})
    E::gives("bicubic, constant", flat(derivative_from_bicubic(constant_map, vec2<T>{f, f})), {0, 0});
  E::gives_nan("bicubic, NaN",
               flat(derivative_from_bicubic(mat4<T>{ones, ones, ones, {E::nan, T(1), T(1), T(1)}},
                                            vec2<T>{T(0.5), T(0.5)})));
}

TYPED_TEST(EdgeTable, Frames) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  const auto normal_of = [](V n) { return flat(make_frame(n, E::x, E::y).normal); };
  E::gives("zero normal: the plane's", normal_of(E::o), {0, 0, 1});
  E::gives("subnormal normal counts as zero", normal_of(V{E::sub, T(0), T(0)}), {0, 0, 1});
  E::gives("huge normal", normal_of(V{E::huge, T(0), T(0)}), {1, 0, 0});
  E::gives_nan("NaN normal", normal_of(V{E::nan, T(0), T(0)}));
  // The plane of E::x, E::y faces the viewer along +z.
  const auto plane_of = [](bool front, BackFaces mode) {
    return flat(make_frame(E::o, E::x, E::y, front, mode).normal);
  };
  for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip})
    E::gives("zero normal, front: towards the viewer", plane_of(true, mode), {0, 0, 1});
  E::gives("zero normal, back, same: away", plane_of(false, BackFaces::same), {0, 0, -1});
  E::gives("zero normal, back, mirror: towards", plane_of(false, BackFaces::mirror), {0, 0, 1});
  E::gives("zero normal, back, flip: towards", plane_of(false, BackFaces::flip), {0, 0, 1});
  E::gives("nothing defines a normal", flat(make_frame(E::o, E::x, E::x)), {0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1});
  E::gives("no position", flat(make_frame(-E::z)), {0, 0, -1, 0, 0, 0, 0, 0, 0, 1, 1});
  E::gives("normal facing away: flip_sign turns", flat(make_frame(-E::z, E::x, E::y)),
           {0, 0, -1, 1, 0, 0, 0, 1, 0, -1, 1});
  E::gives("rebase to a zero normal", flat(rebase_frame(E::facing(), E::o)),
           {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1});

  const auto basis = [](V n, V tangent, T sign) { return flat(mikktspace_basis(n, tangent, sign)); };
  E::gives_zero("mikktspace, zero normal", basis(E::o, E::x, T(1)));
  E::gives_zero("mikktspace, subnormal normal", basis(V{T(0), T(0), E::sub}, E::x, T(1)));
  E::gives_zero("mikktspace, zero tangent", basis(E::z, E::o, T(1)));
  for (const T sign : {T(0), -T(0), T(-1), E::nan}) // listing 16: w > 0 ? 1 : -1
    E::gives("mikktspace, sign not positive", basis(E::z, E::x, sign), {1, 0, 0, 0, -1, 0});
  E::gives("mikktspace, tiny positive sign", basis(E::z, E::x, E::sub), {1, 0, 0, 0, 1, 0});
  E::gives("mikktspace, huge normal", basis(V{T(0), T(0), E::huge}, E::x, T(1)), {0, 0, 0, 0, 1, 0});
  E::gives_nan("mikktspace, NaN tangent", basis(E::z, V{E::nan, T(0), T(0)}, T(1)));

  const auto made = [](const Frame<T>& f, vec2<T> dx, vec2<T> dy) { return flat(tangent_basis(f, dx, dy)); };
  const Frame<T> f = E::facing();
  E::gives("plain", made(f, E::s, E::t), {1, 0, 0, 0, 1, 0});
  E::gives("mirrored in s", made(f, -E::s, E::t), {-1, 0, 0, 0, 1, 0});
  E::gives("mirrored in t", made(f, E::s, -E::t), {1, 0, 0, 0, -1, 0});
  E::gives("normal facing away", made(make_frame(-E::z, E::x, E::y), E::s, E::t), {1, 0, 0, 0, 1, 0});
  E::gives("screen y turned over", made(make_frame(E::z, E::x, -E::y), E::s, -E::t), {1, 0, 0, 0, 1, 0});
  E::gives("smallest", made(f, E::smallest * E::s, E::smallest * E::t), {1, 0, 0, 0, 1, 0});
  E::gives("huge", made(f, E::huge * E::s, E::huge * E::t), {1, 0, 0, 0, 1, 0});
  E::gives_zero("collapsed: parallel", made(f, E::s, T(-3) * E::s));
  E::gives_zero("collapsed: zero", made(f, E::o2, E::o2));
  E::gives_zero("collapsed: one zero", made(f, E::s, E::o2));
  E::gives_zero("collapsed: subnormal", made(f, E::sub * E::s, E::t));
  E::gives_zero("collapsed: NaN", made(f, vec2<T>{E::nan, T(0)}, E::t));
  E::gives_zero("zero sigma", made(make_frame(E::z), E::s, E::t));
}

TYPED_TEST(EdgeTable, Gradients) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  E::gives_zero("tbn, zero basis", flat(from_tbn(vec2<T>{T(1), E::huge}, E::o, E::o)));
  E::gives_nan("tbn, NaN", flat(from_tbn(vec2<T>{E::nan, T(0)}, E::x, E::y)));
  const auto towards = [](V n, V v) { return flat(from_perturbed_normal(n, v)); };
  E::gives_zero("perturbed, zero", towards(E::z, E::o));
  E::gives_zero("perturbed, subnormal", towards(E::z, V{E::sub, T(0), E::sub}));
  E::gives_zero("perturbed, the normal itself", towards(E::z, T(7) * E::z));
  E::gives_zero("perturbed, opposite", towards(E::z, -E::z));
  E::gives("perturbed, huge", towards(E::z, V{E::huge, T(0), E::huge}), {-1, 0, 0});
  E::gives("perturbed, below the plane", towards(E::z, V{T(1), T(0), T(-1)}), {-1, 0, 0});
  E::gives("perturbed, in the plane: clamped", towards(E::z, E::x), {-1.0 / E::eps, 0, 0});
  E::gives_nan("perturbed, NaN", towards(E::z, V{T(0), T(0), E::nan}));
  const auto by = [](V n, V du, V dv) {
    return flat(from_parametric_derivative(n, du, dv, vec2<T>{T(1), T(2)}));
  };
  E::gives("parametric", by(E::z, E::x, E::y), {1, 2, 0});
  E::gives("parametric, normal facing away", by(-E::z, E::x, E::y), {1, 2, 0});
  E::gives("parametric, mirrored", by(E::z, -E::x, E::y), {-1, 2, 0});
  E::gives("parametric, part along the normal", by(E::z, E::x + T(5) * E::z, E::y), {1, 2, 0});
  E::gives("parametric, huge", by(E::z, E::huge * E::x, E::y), {0, 2, 0});
  E::gives_zero("parametric, one zero", by(E::z, E::o, E::y));
  E::gives_zero("parametric, both zero", by(E::z, E::o, E::o));
  E::gives_zero("parametric, subnormal", by(E::z, E::sub * E::x, E::y));
  E::gives_zero("parametric, zero normal", by(E::o, E::x, E::y));
  E::gives("parametric, parallel: clamped", by(E::z, E::x, E::x), {0, 1.0 / E::eps, 0});
  E::gives_finite("parametric, beyond the range", by(E::z, E::smallest * E::x, T(2) * E::smallest * E::y));
  E::gives_nan("parametric, NaN", by(E::z, V{E::nan, T(0), T(0)}, E::y));
  const Frame<T> f = E::facing();
  const vec2<T> size{T(1), T(1)};
  E::gives("texel, mirrored", flat(from_texel_derivative(f, vec2<T>{T(1), T(2)}, size, -E::s, E::t)),
           {-1, 2, 0});
  E::gives_zero("texel, collapsed to zero", flat(from_texel_derivative(f, size, size, E::o2, E::o2)));
  E::gives_zero("height, no position", flat(from_height_derivative(make_frame(E::z), size)));
  E::gives_nan("height, NaN", flat(from_height_derivative(f, vec2<T>{E::nan, T(0)})));
  E::gives_zero("volume, along the normal", flat(from_volume_gradient(E::z, T(5) * E::z)));
  E::gives("volume, normal facing away", flat(from_volume_gradient(-E::z, V{T(1), T(2), T(3)})), {1, 2, 0});
  E::gives("volume, zero normal", flat(from_volume_gradient(E::o, V{T(1), T(2), T(3)})), {1, 2, 3});
  E::gives_nan("volume, NaN", flat(from_volume_gradient(E::z, V{T(0), E::nan, T(0)})));
  E::gives_zero("scale zero", flat(scale_bump(T(0), V{T(1), -E::huge, T(3)})));
}

TYPED_TEST(EdgeTable, ResolveAndTransforms) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  const Frame<T> f = E::facing();
  E::gives("resolve, zero", flat(resolve_normal(f, E::o)), {0, 0, 1});
  E::gives("resolve, subnormal", flat(resolve_normal(f, V{E::sub, T(0), T(0)})), {0, 0, 1});
  E::gives("resolve, huge", flat(resolve_normal(f, V{E::huge, T(0), T(0)})), {-1, 0, 0});
  E::gives_zero("resolve, zero normal", flat(resolve_normal(make_frame(E::o), E::x)));
  E::gives_nan("resolve, NaN", flat(resolve_normal(f, V{E::nan, T(0), T(0)})));
  const Frame<T> back = make_frame(E::z, E::x, E::y, false, BackFaces::flip);
  E::gives("resolve, flipped back face", flat(resolve_normal(back, E::x)),
           {std::sqrt(0.5), 0, -std::sqrt(0.5)});
  E::gives("flip from mirror", flat(flip_from_mirror(E::x, -E::z)), {-1, 0, 0});
  const mat3<T> none{E::o, E::o, E::o};
  const mat3<T> flattened{E::x, E::y, E::o};
  const mat3<T> mirrored{-E::x, E::y, E::z};
  E::gives_zero("transform, zero matrix", flat(transform_normal(none, E::z)));
  E::gives("transform, singular", flat(transform_normal(flattened, E::z)), {0, 0, 1});
  E::gives("transform, mirrored", flat(transform_normal(mirrored, E::x)), {-1, 0, 0});
  E::gives("transform, mirrored, along the mirror", flat(transform_normal(mirrored, E::z)), {0, 0, 1});
  E::gives_nan("transform, NaN", flat(transform_normal(mirrored, V{E::nan, T(0), T(0)})));
  const mat3<T> identity{E::x, E::y, E::z};
  const auto matrix = [&](V scale, V du, V dv) {
    return flat(tangent_normal_matrix(identity, scale, du, dv, E::z));
  };
  const V one{T(1), T(1), T(1)};
  E::gives("matrix", matrix(one, E::x, E::y), {1, 0, 0, 0, 1, 0, 0, 0, 1});
  E::gives("matrix, mirrored coordinates", matrix(one, -E::x, E::y), {-1, 0, 0, 0, 1, 0, 0, 0, 1});
  E::gives("matrix, collapsed", matrix(one, E::x, E::x), {0, 0, 0, 0, 0, 0, 0, 0, 1});
  E::gives("matrix, zero", matrix(one, E::o, E::y), {0, 0, 0, 0, 0, 0, 0, 0, 1});
  E::gives_zero("matrix, zero scale", matrix(E::o, E::x, E::y));
  E::gives_finite("matrix, beyond the range", matrix(E::huge * one, E::smallest * E::x, E::y));
}

TYPED_TEST(EdgeTable, Triplanar) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  const auto weights = [](V n) { return flat(triplanar_weights(n)); };
  E::gives("weights, zero", weights(E::o), all_within<3>(1.0 / 3));
  E::gives("weights, axis", weights(-E::y), {0, 1, 0});
  E::gives("weights, signed zeros", weights(V{-T(0), T(0), T(1)}), {0, 0, 1});
  E::gives("weights, NaN component", weights(V{E::nan, T(1), T(0)}), {0, 1, 0});
  E::gives("weights, NaN", weights(V{E::nan, E::nan, E::nan}), all_within<3>(1.0 / 3));
  E::gives("weights, subnormal", weights(V{E::sub, T(0), T(0)}), all_within<3>(1.0 / 3));
  E::gives("weights, huge", weights(V{E::huge, T(0), T(0)}), {1, 0, 0});
  const vec2<T> d{T(2), T(3)};
  E::gives_zero("no weight", flat(triplanar_gradient(E::o, d, d, d)));
  E::gives_nan("NaN derivative", flat(triplanar_gradient(E::x, vec2<T>{E::nan, T(0)}, d, d)));
  E::gives("x plane", flat(planar_gradient(PlaneAxis::x, d)), {0, 3, 2});
  E::gives("y plane", flat(planar_gradient(PlaneAxis::y, d)), {2, 0, 3});
  E::gives("z plane", flat(planar_gradient(PlaneAxis::z, d)), {2, 3, 0});
  E::gives_zero("plane seen along its axis", flat(from_triplanar(E::z, E::z, d, d, E::o2)));
}

TYPED_TEST(EdgeTable, Parallax) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  const Frame<T> f = E::facing();
  const auto project = [&](const Frame<T>& frame, V dir, vec2<T> dx, vec2<T> dy) {
    return flat(project_to_texture_space(frame, dir, dx, dy, T(1)));
  };
  const V slanted{T(0.6), T(0), T(0.8)};
  E::gives("along the normal", project(f, E::z, E::s, E::t), {0, 0});
  E::gives("slanted", project(f, slanted, E::s, E::t), {0.75, 0});
  E::gives("from below: the signed product", project(f, -slanted, E::s, E::t), {0.75, 0});
  E::gives("normal facing away", project(make_frame(-E::z, E::x, E::y), slanted, E::s, E::t), {-0.75, 0});
  E::gives("mirrored", project(f, slanted, -E::s, E::t), {-0.75, 0});
  E::gives("grazing: clamped", project(f, E::x, E::s, E::t), {1.0 / E::eps, 0});
  E::gives_zero("collapsed to zero", project(f, slanted, E::o2, E::o2));
  E::gives_zero("no position", project(make_frame(E::z), slanted, E::s, E::t));
  E::gives_zero("no direction", project(f, E::o, E::s, E::t));
  E::gives_finite("huge rates", project(f, slanted, E::huge * E::s, E::huge * E::t));
  E::gives_nan("NaN", project(f, V{E::nan, T(0), T(1)}, E::s, E::t));
  const auto offset = [](vec2<T> dx, vec2<T> dy) { return flat(screen_offset(dx, dy, vec2<T>{T(1), T(2)})); };
  E::gives("offset", offset(E::s, E::t), {1, 2});
  E::gives("offset, mirrored", offset(-E::s, E::t), {-1, 2});
  E::gives_zero("offset, zero", offset(E::o2, E::o2));
  E::gives_zero("offset, one zero", offset(E::o2, E::t));
  E::gives_finite("offset, collapsed", offset(E::s, E::s));
  E::gives_nan("offset, NaN", offset(vec2<T>{E::nan, T(0)}, E::t));
  E::gives_finite("surface offset, beyond the range",
                  flat(surface_offset(make_frame(E::z, T(1e12) * E::x, T(1e12) * E::y), E::smallest * E::s,
                                      E::smallest * E::t, vec2<T>{T(1e12), T(1e12)})));
  E::gives_zero("offset normal, cancelled", flat(offset_normal(f, -E::z, E::o, E::s)));
  E::gives("offset normal, none", flat(offset_normal(f, E::x, E::y, E::o2)), {0, 0, 1});
}

TYPED_TEST(EdgeTable, Screen) {
  using T = TypeParam;
  using E = EdgeTable<T>;
  using V = vec3<T>;
  const T k0 = T(0);
  const T k1 = T(1);
  const mat4<T> identity{{k1, k0, k0, k0}, {k0, k1, k0, k0}, {k0, k0, k1, k0}, {k0, k0, k0, k1}};
  const auto screen = [&](V n) { return flat(screen_derivatives(E::o, n, identity, T(3), T(4))); };
  E::gives("facing", screen(E::z), {1, 0, 0, 0, 1, 0});
  E::gives("facing away", screen(-E::z), {1, 0, 0, 0, 1, 0});
  E::gives("any length", screen(V{k0, k0, E::smallest}), {1, 0, 0, 0, 1, 0});
  E::gives("slanted", screen(V{k1, k0, k1}), {1, 0, -1, 0, 1, 0});
  E::gives("edge-on: clamped", screen(E::x), {1, 0, -1.0 / E::eps, 0, 1, 0});
  E::gives("zero normal: depth 0", screen(E::o), {1, 0, 0, 0, 1, 0});
  E::gives_nan("NaN", screen(V{E::nan, k0, k0}));
  const vec4<T> zero_row{k0, k0, k0, k0};
  const mat4<T> at_infinity{identity.x, identity.y, identity.z, zero_row};
  E::gives_zero("w = 0", flat(screen_derivatives(E::o, E::z, at_infinity, T(3), T(4))));
  E::gives_finite(
      "zero matrix",
      flat(screen_derivatives(E::z, E::z, mat4<T>{zero_row, zero_row, zero_row, zero_row}, T(3), T(4))));
  const double lowest = std::numeric_limits<T>::min_exponent - 1;
  const auto lod = [](vec2<T> dx, vec2<T> dy) { return flat(texture_lod(dx, dy, vec2<T>{T(8), T(8)})); };
  E::gives("lod, zero", lod(E::o2, E::o2), {lowest});
  E::gives("lod, one axis", lod(E::s, E::o2), {3});
  E::gives("lod, mirrored", lod(-E::s, -E::t), {3});
  E::gives_finite("lod, NaN", lod(vec2<T>{E::nan, k0}, E::t));
  E::gives_finite("lod, huge", lod(E::huge * E::s, E::t));
  const TextureDerivatives<T> none = projected_derivatives(E::o, E::o, E::x, E::y);
  E::gives_zero("projected, zero", flat(none));
}

} // namespace
} // namespace surfgrad::test
