/// Listings 6 and 16: the prologue, its double-sided modes, and tangent frames made in place.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/frame.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

namespace surfgrad::test {
namespace {

// A few dozen roundings of double, 1e-16 each, on input with condition numbers up to ten.
constexpr double exact = 1e-13;

TEST(Frame, PrologueFieldsFollowListing16) {
  Random random(161);
  Worst worst("make_frame");
  for (long i = 0; i < 1000; ++i) {
    const vec3d raw = random.magnitude(1e-6, 1e6) * random.unit_vector();
    const vec3d dp_dx = random.vector3();
    const vec3d dp_dy = random.vector3();
    const Frame<double> f = make_frame(raw, dp_dx, dp_dy);
    worst.add(length(f.normal), 1, exact, i);
    worst.add(cross(f.normal, raw), {0, 0, 0}, exact * length(raw), i);
    EXPECT_GT(dot(f.normal, raw), 0);
    // sigma: the tangential part and nothing else.
    worst.add(dot(f.sigma_x, f.normal), 0, exact, i);
    worst.add(dot(f.sigma_y, f.normal), 0, exact, i);
    worst.add(cross(f.normal, f.sigma_x), cross(f.normal, dp_dx), exact, i);
    worst.add(cross(f.normal, f.sigma_y), cross(f.normal, dp_dy), exact, i);
    // flip_sign: the side of the normal on which dp_dx turns into dp_dy counter-clockwise.
    EXPECT_EQ(f.flip_sign, dot(f.normal, cross(dp_dx, dp_dy)) < 0 ? -1 : 1);
    EXPECT_EQ(f.resolve_sign, 1);
    EXPECT_EQ(f.dp_dx.x, dp_dx.x);
    EXPECT_EQ(f.dp_dy.z, dp_dy.z);
  }
}

TEST(Frame, FlipSignTurnsWithScreenYAndWithTheNormal) {
  Random random(162);
  for (int i = 0; i < 200; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    Pinhole camera = random_camera(p, random);
    camera.screen_y = -1;
    const Frame<double> down = frame_at(p, camera.fragment(p));
    camera.screen_y = 1;
    const Frame<double> up = frame_at(p, camera.fragment(p));
    EXPECT_EQ(down.flip_sign, -up.flip_sign);
    EXPECT_EQ(make_frame(-p.normal, up.dp_dx, up.dp_dy).flip_sign, -up.flip_sign);
  }
}

TEST(Frame, BackFaceModesSetNormalAndResolveSign) { // section 2.10
  const vec3d n{0, 0, 2};
  const vec3d x{1, 0, 0};
  const vec3d y{0, 1, 0};
  struct Row {
    BackFaces mode;
    bool front;
    double normal_z, resolve_sign, flip_sign;
  };
  for (const Row& row : {Row{BackFaces::same, true, 1, 1, 1}, Row{BackFaces::same, false, 1, 1, 1},
                         Row{BackFaces::mirror, true, 1, 1, 1}, Row{BackFaces::mirror, false, -1, 1, -1},
                         Row{BackFaces::flip, true, 1, 1, 1}, Row{BackFaces::flip, false, -1, -1, -1}}) {
    const Frame<double> f = make_frame(n, x, y, row.front, row.mode);
    EXPECT_EQ(f.normal.z, row.normal_z);
    EXPECT_EQ(f.resolve_sign, row.resolve_sign);
    EXPECT_EQ(f.flip_sign, row.flip_sign);
  }
}

TEST(Frame, AbsentNormalIsReplacedByThePlaneFacingTheViewer) {
  // Right-handed space, screen y up: cross(dp_dx, dp_dy) faces the viewer.
  const Frame<double> f = make_frame(vec3d{0, 0, 0}, vec3d{3e-9, 0, 0}, vec3d{1e-9, 2e-9, 0});
  EXPECT_NEAR(f.normal.z, 1, exact);
  const Frame<double> none = make_frame(vec3d{0, 0, 0});
  EXPECT_EQ(max_abs(none.normal), 0);
  EXPECT_EQ(none.flip_sign, 1);
}

TEST(Frame, RebaseRecomputesForTheNewNormal) { // section 2.11
  Random random(163);
  Worst worst("rebase_frame equals the prologue of the new normal");
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Sphere{}, random);
    const Fragment at = random_camera(p, random).fragment(p);
    const Frame<double> first = make_frame(p.normal, at.dp_dx, at.dp_dy, at.front_facing, BackFaces::flip);
    const vec3d next = normalize_or_zero(first.normal + 0.3 * random.vector3());
    const Frame<double> rebased = rebase_frame(first, next);
    const Frame<double> fresh = make_frame(next, at.dp_dx, at.dp_dy);
    worst.add(rebased.normal, next, exact, i);
    worst.add(rebased.sigma_x, fresh.sigma_x, exact, i);
    worst.add(rebased.sigma_y, fresh.sigma_y, exact, i);
    EXPECT_EQ(rebased.flip_sign, fresh.flip_sign);
    EXPECT_EQ(rebased.resolve_sign, first.resolve_sign);
    const Frame<double> moved = rebase_frame(first, next, 2.0 * at.dp_dx, 3.0 * at.dp_dy);
    worst.add(moved.sigma_x, 2.0 * fresh.sigma_x, exact, i);
    worst.add(moved.dp_dy, 3.0 * at.dp_dy, exact, i);
  }
}

TEST(Frame, MikktspaceBasisIsListing16) {
  Random random(164);
  Worst worst("mikktspace_basis as printed");
  for (long i = 0; i < 500; ++i) {
    const vec3d n = random.magnitude(0.01, 100) * random.unit_vector();
    const vec3d t = random.vector3();
    for (const double sign : {1.0, -1.0, 0.5, -0.0, 0.0}) {
      const TangentFrame<double> b = mikktspace_basis(n, t, sign);
      const double inverse = 1 / length(n);
      worst.add(b.tangent, inverse * t, exact * inverse, i);
      worst.add(b.bitangent, (sign > 0 ? inverse : -inverse) * cross(n, t), exact, i);
    }
  }
}

TEST(Frame, TangentBasisIsTheProjectedDerivative) { // listing 6
  Random random(61);
  Worst worst("listing 6: tangent against normalised dp/ds, bitangent on the side of +t");
  for_each_surface([&](const auto& surface) {
    for (long i = 0; i < 700; ++i) {
      const SurfacePoint p = random_point(surface, random);
      const UvMap st = random_uv_map(random);                  // both handednesses
      const Fragment f = random_camera(p, random).fragment(p); // both sides, both directions of y
      const auto [dp_ds, dp_dt] = st.tangents(p);
      for (const bool front : {true, false}) {
        for (const BackFaces mode : {BackFaces::same, BackFaces::mirror, BackFaces::flip}) {
          const Frame<double> frame = make_frame(p.normal, f.dp_dx, f.dp_dy, front, mode);
          const TangentFrame<double> basis = tangent_basis(frame, st.linear(f.duv_dx), st.linear(f.duv_dy));
          worst.add(basis.tangent, normalize_or_zero(dp_ds), exact, i);
          worst.add(dot(basis.bitangent, basis.tangent), 0, exact, i);
          worst.add(dot(basis.bitangent, frame.normal), 0, exact, i);
          worst.add(length(basis.bitangent), 1, exact, i);
          EXPECT_GT(dot(basis.bitangent, dp_dt), 0) << "case " << i;
        }
      }
    }
  });
}

TEST(Frame, TangentBasisOfAnInterpolatedNormalProjectsFirst) { // sigma, not dp
  Random random(62);
  Worst worst("listing 6 with a normal that is not the plane's");
  for (long i = 0; i < 700; ++i) {
    const SurfacePoint p = random_point(Plane{}, random);
    const UvMap st = random_uv_map(random);
    const Fragment f = random_camera(p, random).fragment(p);
    const vec3d n = normalize_or_zero(p.normal + 0.5 * random.vector3());
    const Frame<double> frame = make_frame(n, f.dp_dx, f.dp_dy);
    const TangentFrame<double> basis = tangent_basis(frame, st.linear(f.duv_dx), st.linear(f.duv_dy));
    const vec3d dp_ds = st.tangents(p).first;
    worst.add(basis.tangent, normalize_or_zero(dp_ds - dot(dp_ds, n) * n), exact, i);
  }
}

TEST(Frame, GreenDownWithTDownIsTheSameBump) { // section 2.1
  // Upper-left origin: t turns over and positive green means down. Either convention alone is right.
  Random random(64);
  Worst worst("both texture origins");
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Sphere{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const Frame<double> frame = frame_at(p, f);
    const vec2d up = random.vector2();
    const vec2d down{up.x, -up.y};
    const TangentFrame<double> lower_left = tangent_basis(frame, f.duv_dx, f.duv_dy);
    const TangentFrame<double> upper_left =
        tangent_basis(frame, vec2d{f.duv_dx.x, -f.duv_dx.y}, vec2d{f.duv_dy.x, -f.duv_dy.y});
    const vec3d expected = from_tbn(up, lower_left.tangent, lower_left.bitangent);
    worst.add(from_tbn(down, upper_left.tangent, upper_left.bitangent), expected, exact, i);
  }
}

TEST(Frame, TangentBasisOfMirroredCoordinatesKeepsTheBump) {
  // The same physical bump mapped with s negated: derivative and tangent both change sign.
  Random random(63);
  Worst worst("mirrored coordinates");
  for (long i = 0; i < 300; ++i) {
    const SurfacePoint p = random_point(Torus{}, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const Frame<double> frame = frame_at(p, f);
    const vec2d d = random.vector2();
    const TangentFrame<double> a = tangent_basis(frame, f.duv_dx, f.duv_dy);
    const TangentFrame<double> b =
        tangent_basis(frame, vec2d{-f.duv_dx.x, f.duv_dx.y}, vec2d{-f.duv_dy.x, f.duv_dy.y});
    worst.add(from_tbn(vec2d{-d.x, d.y}, b.tangent, b.bitangent), from_tbn(d, a.tangent, a.bitangent), exact,
              i);
  }
}

} // namespace
} // namespace surfgrad::test
