/// The paper's appendix: the surface gradient depends on the surface and on the heights on it, not on
/// the parametrisation, nor on how the heights continue off the surface.

#include "support/surfaces.hpp"
#include "support/worst.hpp"
#include <surfgrad/gradient.hpp>

namespace surfgrad::test {
namespace {

template <class Surface>
void every_route_gives_one_gradient(const char* name, const Surface& surface, std::uint64_t seed) {
  Random random(seed);
  Worst worst(std::string("the appendix's theorem on a ") + name);
  int mirrored = 0;
  for (long i = 0; i < 500; ++i) {
    const SurfacePoint p = random_point(surface, random);
    const Fragment f = random_camera(p, random).fragment(p);
    const Frame<double> frame = frame_at(p, f);
    const UvMap first = random_uv_map(random);

    // One height, stored in a first set of texture coordinates: listing 8 by texels.
    const vec2d stored = gradient_of([](auto q) { return wavy(q); }, first(p.uv));
    const vec3d truth =
        from_texel_derivative(frame, stored, vec2d{1, 1}, first.linear(f.duv_dx), first.linear(f.duv_dy));

    // The same height stored in a second set, sheared and mirrored against the first.
    UvMap second = random_uv_map(random);
    if (second.determinant() * first.determinant() > 0) second.s = -second.s;
    mirrored += second.determinant() * first.determinant() < 0;
    const UvMap second_inverse = second.inverse();
    const auto by_second = [&](auto q) { return wavy(first(second_inverse(q))); };
    const vec2d restored = gradient_of(by_second, second(p.uv));
    const auto [dp_ds, dp_dt] = second.tangents(p);
    worst.add(from_parametric_derivative(p.normal, dp_ds, dp_dt, restored), truth, 1e-9, i);

    // A smooth extension to a volume, plus a smooth term that vanishes on the surface.
    const auto extension = [&](auto q) {
      using T = decltype(q.x);
      const T off = surface.implicit(q);
      return wavy(first(surface.parameters(q))) + off * (T(1.5) + wavy(q)) + T(3.0) * off * off;
    };
    const vec3d volume = gradient_of(extension, p.position);
    worst.add(from_volume_gradient(p.normal, volume), truth, 1e-9, i);
    // The extension does differ off the surface, or nothing would be proved.
    EXPECT_GT(std::abs(dot(volume, p.normal)), 1e-6) << "case " << i;

    // Screen space is one more parametrisation.
    const vec2d duv = gradient_of([&](auto q) { return wavy(first(q)); }, p.uv);
    worst.add(from_height_derivative(frame, vec2d{dot(duv, f.duv_dx), dot(duv, f.duv_dy)}), truth, 1e-9, i);
  }
  EXPECT_EQ(mirrored, 500);
}

TEST(AppendixTheorem, GradientDoesNotDependOnTheParametrisationOnAPlane) {
  every_route_gives_one_gradient("plane", Plane{}, 1);
}
TEST(AppendixTheorem, GradientDoesNotDependOnTheParametrisationOnASphere) {
  every_route_gives_one_gradient("sphere", Sphere{}, 2);
}
TEST(AppendixTheorem, GradientDoesNotDependOnTheParametrisationOnATorus) {
  every_route_gives_one_gradient("torus", Torus{}, 3);
}

} // namespace
} // namespace surfgrad::test
