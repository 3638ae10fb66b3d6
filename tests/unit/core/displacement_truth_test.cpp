/// Every source of bumps against the surface that is really displaced: physical heights, noise, decals
/// and triplanar projection on an analytic sphere and torus. Three statements, of growing reach:
///   the composed normal is Blinn's;
///   put right for curvature and for the change of the triplanar weights it is the displaced surface's;
///   as it is, it is off by an amount that falls with the height.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <numbers>
#include <surfgrad/surfgrad.hpp>

namespace surfgrad::test {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// What a source says at a point of the surface.
struct Bump {
  double height;
  vec3d surfgrad;
  /// Height by the parameters as the source means it (triplanar: weights held constant).
  vec2d dh_duv;
  /// Part of the height's change that the source neglects: sum of H_i dw_i for triplanar, else zero.
  vec2d neglected_duv{0, 0};
};

/// A texture of hills over a plane, and its derivatives.
double hills(vec2d st) { return std::sin(7 * st.x + 2 * st.y) + 0.6 * std::cos(5 * st.y - 3 * st.x); }
vec2d slope_of_hills(vec2d st) {
  const double a = std::cos(7 * st.x + 2 * st.y);
  const double b = 0.6 * std::sin(5 * st.y - 3 * st.x);
  return {7 * a + 3 * b, 2 * a - 5 * b};
}

vec2d along_surface(const SurfacePoint& p, vec3d gradient) {
  return {dot(gradient, p.dp_du), dot(gradient, p.dp_dv)};
}

/// A height map on the surface's parameters, seen by a camera: listing 8.
struct PhysicalHeight {
  static constexpr const char* name = "physical height";
  template <class Surface>
  Bump operator()(const Surface&, const SurfacePoint& p) const {
    // In texels of a map of 64 x 32 that covers st = uv / 2.
    const vec2d st = 0.5 * p.uv;
    const vec2d size{64, 32};
    const vec2d dh_dst = slope_of_hills(st);
    Random random(static_cast<std::uint64_t>(1e6 * (p.uv.x + 4)));
    const Fragment f = random_camera(p, random).fragment(p);
    const vec3d g = from_texel_derivative(frame_at(p, f), vec2d{dh_dst.x / size.x, dh_dst.y / size.y}, size,
                                          0.5 * f.duv_dx, 0.5 * f.duv_dy);
    return {hills(st), g, 0.5 * dh_dst};
  }
};

struct SolidNoise {
  static constexpr const char* name = "noise";
  template <class Surface>
  Bump operator()(const Surface&, const SurfacePoint& p) const {
    const double frequency = 1.7;
    const Noise<double> n = fractal_sum(frequency * p.position, Fractal<double>{.octaves = 2});
    const vec3d gradient = frequency * n.gradient;
    return {n.value, from_volume_gradient(p.normal, gradient), along_surface(p, gradient)};
  }
};

/// A projector that covers the whole surface: its falloff is no part of the height (section 2.9).
const DecalFrame<double> projector{{0.2, -0.1, -4}, {0.8, 0.6, 0}, {-0.6, 0.8, 0}, {0, 0, 1}};

Bump projected(const SurfacePoint& p, const DecalProjection<double>& decal) {
  EXPECT_TRUE(decal.inside);
  const vec2d st = 6.0 * decal.texture_coordinate;
  const vec3d gradient = decal_gradient(6.0 * slope_of_hills(st), decal.grad_s, decal.grad_t);
  return {hills(st), from_volume_gradient(p.normal, gradient), along_surface(p, gradient)};
}

struct BoxDecal {
  static constexpr const char* name = "box decal";
  template <class Surface>
  Bump operator()(const Surface&, const SurfacePoint& p) const {
    return projected(p, box_decal(projector, p.position, vec3d{3, 3, 9}, 0.0));
  }
};

struct ConeDecal {
  static constexpr const char* name = "cone decal";
  template <class Surface>
  Bump operator()(const Surface&, const SurfacePoint& p) const {
    return projected(p, cone_decal(projector, p.position, 1.2, 9.0, 0.0));
  }
};

struct Triplanar {
  static constexpr const char* name = "triplanar";
  static constexpr TriplanarConvention convention{Handedness::right};
  template <class Surface>
  Bump operator()(const Surface& surface, const SurfacePoint& p) const {
    const TriplanarCoordinates<double> st = triplanar_coordinates(p.position, convention);
    const vec3d w = triplanar_weights(p.normal);
    const vec3d h{hills(st.x_plane), hills(st.y_plane), hills(st.z_plane)};
    const vec2d dx = slope_of_hills(st.x_plane);
    const vec2d dy = slope_of_hills(st.y_plane);
    const vec2d dz = slope_of_hills(st.z_plane);
    const auto weights_at = [&](double u, double v) { return triplanar_weights(surface.normal(u, v)); };
    // Central differences; the weights have third derivatives of order 100, hence an error of 2e-9.
    constexpr double step = 1e-5;
    const vec3d dw_du =
        (0.5 / step) * (weights_at(p.uv.x + step, p.uv.y) - weights_at(p.uv.x - step, p.uv.y));
    const vec3d dw_dv =
        (0.5 / step) * (weights_at(p.uv.x, p.uv.y + step) - weights_at(p.uv.x, p.uv.y - step));
    return {dot(w, h),
            from_triplanar(p.normal, w, dx, dy, dz, convention),
            along_surface(p, triplanar_gradient(w, dx, dy, dz, convention)),
            {dot(dw_du, h), dot(dw_dv, h)}};
  }
};

/// Calls visit(surface, name) with a sphere and a torus of about size 1.
template <class Visit>
void for_each_body(Visit&& visit) {
  visit(Sphere{1.0}, "sphere");
  visit(Torus{1.0, 0.5}, "torus");
}

template <class Visit>
void for_each_source(Visit&& visit) {
  visit(PhysicalHeight{});
  visit(SolidNoise{});
  visit(BoxDecal{});
  visit(ConeDecal{});
  visit(Triplanar{});
}

/// Away from the poles of the sphere, where its parameters collapse.
template <class Surface>
SurfacePoint any_point(const Surface& surface, Random& random) {
  const double half = std::is_same_v<Surface, Sphere> ? 1.4 : std::numbers::pi;
  return evaluate(surface,
                  {random.uniform(-std::numbers::pi, std::numbers::pi), random.uniform(-half, half)});
}

/// Normal of P + a h N from the positions alone: differences of fourth order.
template <class Surface, class Source>
vec3d displaced_normal(const Surface& surface, const Source& source, double amplitude, vec2d uv) {
  const auto position = [&](vec2d at) {
    const SurfacePoint q = evaluate(surface, at);
    return q.position + (amplitude * source(surface, q).height) * q.normal;
  };
  const auto derivative = [&](vec2d along) {
    return 8.0 * (position(uv + along) - position(uv - along)) -
           (position(uv + 2.0 * along) - position(uv - 2.0 * along));
  };
  // Small against the cells of the noise, across whose borders its third derivative jumps.
  constexpr double step = 1e-4;
  return normalize_or_zero(cross(derivative({step, 0}), derivative({0, step})));
}

double angle_between(vec3d a, vec3d b) { return degrees * std::atan2(length(cross(a, b)), dot(a, b)); }

TEST(DisplacementTruth, EverySourceGivesBlinnsNormal) {
  for_each_body([](const auto& surface, const char* body) {
    for_each_source([&](const auto& source) {
      Random random(3001);
      Worst worst(std::string(source.name) + " against Blinn's normal on a " + body);
      for (long i = 0; i < 300; ++i) {
        const SurfacePoint p = any_point(surface, random);
        const Bump b = source(surface, p);
        const double amplitude = random.uniform(0.005, 0.05);
        const vec3d blinn = normalize_or_zero(cross(p.dp_du + (amplitude * b.dh_duv.x) * p.normal,
                                                    p.dp_dv + (amplitude * b.dh_duv.y) * p.normal));
        worst.add(resolve_normal(make_frame(p.normal), scale_bump(amplitude, b.surfgrad)), blinn, 1e-9, i);
      }
    });
  });
}

TEST(DisplacementTruth, TheExactCorrectionGivesTheDisplacedSurfacesNormal) {
  for_each_body([](const auto& surface, const char* body) {
    for_each_source([&](const auto& source) {
      Random random(3002);
      double worst = 0;
      for (int i = 0; i < 200; ++i) {
        const SurfacePoint p = any_point(surface, random);
        const Bump b = source(surface, p);
        const double amplitude = 0.01;
        // surfgrad + sum H_i grad_S(w_i), then (I + h dN)^-1 through the moved tangents.
        const vec3d whole = amplitude * (b.surfgrad + from_parametric_derivative(p.normal, p.dp_du, p.dp_dv,
                                                                                 b.neglected_duv));
        const double h = amplitude * b.height;
        const vec3d corrected = from_parametric_derivative(p.normal, p.dp_du + h * p.dn_du,
                                                           p.dp_dv + h * p.dn_dv, along_surface(p, whole));
        const double angle = angle_between(resolve_normal(make_frame(p.normal), corrected),
                                           displaced_normal(surface, source, amplitude, p.uv));
        worst = std::max(worst, angle);
      }
      std::printf("  %s on a %s, corrected: worst %.2g degrees\n", source.name, body, worst);
      EXPECT_LT(worst, 1e-5) << source.name << " on a " << body;
    });
  });
}

TEST(DisplacementTruth, ThePlainErrorFallsWithTheHeight) {
  for_each_body([](const auto& surface, const char* body) {
    for_each_source([&](const auto& source) {
      constexpr bool weighted = std::is_same_v<std::decay_t<decltype(source)>, Triplanar>;
      double mean[3];
      double amplitude = 0.01; // of the body's size
      for (double& error : mean) {
        Random random(3003);
        error = 0;
        constexpr int count = 400;
        for (int i = 0; i < count; ++i) {
          const SurfacePoint p = any_point(surface, random);
          const Bump b = source(surface, p);
          error += angle_between(resolve_normal(make_frame(p.normal), amplitude * b.surfgrad),
                                 displaced_normal(surface, source, amplitude, p.uv)) /
                   count;
        }
        amplitude /= 2;
      }
      std::printf("  %s on a %s, height 1, 0.5, 0.25 %%: mean error %.4f, %.4f, %.4f degrees\n", source.name,
                  body, mean[0], mean[1], mean[2]);
      EXPECT_LT(mean[0], weighted ? 1.0 : 0.5) << source.name << " on a " << body;
      // Halving the height divides a quadratic error by 4, a linear one by 2; the next order of the
      // series moves either by a few percent of a ratio at these heights.
      const double order = weighted ? 2 : 4;
      EXPECT_NEAR(mean[0] / mean[1], order, 0.1 * order) << source.name << " on a " << body;
      EXPECT_NEAR(mean[1] / mean[2], order, 0.1 * order) << source.name << " on a " << body;
    });
  });
}

} // namespace
} // namespace surfgrad::test
