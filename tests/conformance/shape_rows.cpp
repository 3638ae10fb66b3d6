/// Decals, parallax, hex tiles, moments.

#include "conformance/rows.hpp"
#include "support/core_functions.hpp"

#include <surfgrad/decal.hpp>
#include <surfgrad/hex_tiles.hpp>
#include <surfgrad/moments.hpp>
#include <surfgrad/parallax_march.hpp>

#include <algorithm>
#include <utility>

namespace surfgrad::test {
namespace {

template <class T>
using Shader = ShaderInputs<T>;
using Exact = ShaderInputs<double>;

template <class T>
DecalFrame<T> decal_frame(const Shader<T>& in) {
  return {in.decal_origin, in.core.rotation.x, in.core.rotation.y, in.core.rotation.z};
}

template <class T>
std::array<T, 16> flat(const DecalProjection<T>& p) {
  return {p.texture_coordinate.x,
          p.texture_coordinate.y,
          p.grad_s.x,
          p.grad_s.y,
          p.grad_s.z,
          p.grad_t.x,
          p.grad_t.y,
          p.grad_t.z,
          p.axis_s.x,
          p.axis_s.y,
          p.axis_s.z,
          p.axis_t.x,
          p.axis_t.y,
          p.axis_t.z,
          p.falloff,
          p.inside ? T(1) : T(0)};
}
template <class T>
std::array<T, 11> flat(const DecalDirection<T>& d) {
  return {d.direction.x,  d.direction.y, d.direction.z,         d.lookup.x,
          d.lookup.y,     d.lookup.z,    d.unchanging.x,        d.unchanging.y,
          d.unchanging.z, d.falloff,     d.inside ? T(1) : T(0)};
}

/// Whether the answer is the same for shapes a little larger and smaller: else rounding may decide.
template <class At>
bool is_decided(const At& at) {
  constexpr double little = 1e-5;
  const auto less = at(1 - little);
  const auto more = at(1 + little);
  return less.inside == more.inside && at(1).inside == less.inside;
}

/// eps of p - origin, of its coordinates along the axes, and of these in units of a size.
double relative_position(const Exact& in, double size) {
  return 4 * length(in.point - in.decal_origin) / size;
}

/// The falloff is a smoothstep over `fade`, of slope 1.5 / fade at most; its own arithmetic errs by 8 eps.
double falloff_bound(const Exact& in, double of_position) { return 1.5 / in.fade * (of_position + 4) + 8; }

std::array<double, 16> projection_bounds(double st, double grad, double axis, double falloff, bool decided) {
  std::array<double, 16> eps{};
  eps[0] = eps[1] = st + 1;
  for (int i = 2; i < 8; ++i) eps[i] = grad;
  for (int i = 8; i < 14; ++i) eps[i] = axis;
  eps[14] = falloff;
  for (double& each : eps) each = decided ? each : undecided;
  return eps;
}

std::array<double, 16> box_bounds(const Exact& in) {
  const bool decided = is_decided(
      [&](double size) { return box_decal(decal_frame(in), in.point, size * in.half_size, in.fade); });
  const double least = std::min({in.half_size.x, in.half_size.y, in.half_size.z});
  const double st = relative_position(in, least);
  return projection_bounds(st, 1 / least, 0, 3 * falloff_bound(in, st), decided);
}

template <class At>
std::array<double, 16> cone_bounds(const Exact& in, double half_length, const At& at) {
  const double across = dot(in.point - in.decal_origin, in.core.rotation.x);
  const bool at_end = std::abs(std::abs(across) - half_length) < 1e-5;
  const double z = dot(in.point - in.decal_origin, in.core.rotation.z);
  const double radius = std::abs(z * in.tan_half_angle);
  const double st = 2 * relative_position(in, radius);
  // x / z errs by the rounding of both, relative to z.
  const double axis = 2 * relative_position(in, std::abs(z)) * (1 + in.tan_half_angle) + 1;
  return projection_bounds(st, (st + axis) / radius + 1 / radius, axis,
                           2 * falloff_bound(in, st + relative_position(in, in.range)),
                           is_decided(at) && !(half_length > 0 && at_end));
}

template <class At>
std::array<double, 11> sphere_bounds(const Exact& in, double half_length, const At& at) {
  const vec3<double> d = in.point - in.decal_origin;
  double x = dot(d, in.core.rotation.x);
  const bool at_end = half_length > 0 && std::abs(std::abs(x) - half_length) < 1e-5;
  x -= std::max(-half_length, std::min(x, half_length));
  const double y = dot(d, in.core.rotation.y);
  const double z = dot(d, in.core.rotation.z);
  const double distance = std::sqrt(x * x + y * y + z * z);
  const bool decided = is_decided(at) && !at_end;
  std::array<double, 11> eps{};
  for (int i = 0; i < 6; ++i) eps[i] = 6 + relative_position(in, distance);
  eps[9] = falloff_bound(in, relative_position(in, in.radius));
  for (double& each : eps) each = decided ? each : undecided;
  return eps;
}

template <class T>
auto cone(const Shader<T>& in, ConeGradient gradient) {
  return cone_decal(decal_frame(in), in.point, in.tan_half_angle, in.range, in.fade, gradient);
}
template <class T>
auto wedge(const Shader<T>& in, ConeGradient gradient) {
  return wedge_decal(decal_frame(in), in.point, in.half_length, in.tan_half_angle, in.range, in.fade,
                     gradient);
}

void add_decals(std::vector<Row>& rows) {
  const std::string frame = "decal_frame($decal_origin, $rotation)";
  rows.push_back(make_row(
      "decal_gradient", "put3(surfgrad_decal_gradient($deriv, $tangent, $bitangent))",
      [](const auto& in) {
        return test::flat(decal_gradient(in.core.deriv, in.core.tangent, in.core.bitangent));
      },
      [](const Exact& in) {
        return test::flat(absolute(in.core.deriv.x * in.core.tangent) +
                          absolute(in.core.deriv.y * in.core.bitangent));
      }));
  rows.push_back(make_row(
      "from_decal", "put3(surfgrad_from_decal($frame.normal, $deriv, $tangent, $bitangent))",
      [](const auto& in) {
        return test::flat(
            from_decal(in.core.frame.normal, in.core.deriv, in.core.tangent, in.core.bitangent));
      },
      [](const Exact& in) {
        return all_within<3>(5 * (std::abs(in.core.deriv.x) * length(in.core.tangent) +
                                  std::abs(in.core.deriv.y) * length(in.core.bitangent)));
      }));
  rows.push_back(make_row(
      "box_decal", "put_projection(surfgrad_box_decal(" + frame + ", $point, $half_size, $fade))",
      [](const auto& in) { return flat(box_decal(decal_frame(in), in.point, in.half_size, in.fade)); },
      box_bounds));
  const auto cone_row = [&](ConeGradient gradient, const std::string& mode, const std::string& argument) {
    rows.push_back(make_row(
        "cone_decal" + mode,
        "put_projection(surfgrad_cone_decal(" + frame + ", $point, $tan_half_angle, $range, $fade" +
            argument + "))",
        [gradient](const auto& in) { return flat(cone(in, gradient)); },
        [](const Exact& in) {
          return cone_bounds(in, 0, [&](double size) {
            return cone_decal(decal_frame(in), in.point, size * in.tan_half_angle, size * in.range, in.fade);
          });
        }));
    rows.push_back(make_row(
        "wedge_decal" + mode,
        "put_projection(surfgrad_wedge_decal(" + frame +
            ", $point, $half_length, $tan_half_angle, $range, $fade" + argument + "))",
        [gradient](const auto& in) { return flat(wedge(in, gradient)); },
        [](const Exact& in) {
          return cone_bounds(in, in.half_length, [&](double size) {
            return wedge_decal(decal_frame(in), in.point, in.half_length, size * in.tan_half_angle,
                               size * in.range, in.fade);
          });
        }));
  };
  cone_row(ConeGradient::exact, "", "");
  cone_row(ConeGradient::scale_free, ": scale-free", ", SURFGRAD_CONE_GRADIENT_SCALE_FREE");
  rows.push_back(make_row(
      "sphere_decal", "put_direction(surfgrad_sphere_decal(" + frame + ", $point, $radius, $fade))",
      [](const auto& in) { return flat(sphere_decal(decal_frame(in), in.point, in.radius, in.fade)); },
      [](const Exact& in) {
        return sphere_bounds(in, 0, [&](double size) {
          return sphere_decal(decal_frame(in), in.point, size * in.radius, in.fade);
        });
      }));
  rows.push_back(make_row(
      "capsule_decal",
      "put_direction(surfgrad_capsule_decal(" + frame + ", $point, $half_length, $radius, $fade))",
      [](const auto& in) {
        return flat(capsule_decal(decal_frame(in), in.point, in.half_length, in.radius, in.fade));
      },
      [](const Exact& in) {
        return sphere_bounds(in, in.half_length, [&](double size) {
          return capsule_decal(decal_frame(in), in.point, in.half_length, size * in.radius, in.fade);
        });
      }));
  // A direction that is known exactly: the bound is the function's own.
  rows.push_back(make_row(
      "decal_gradient_from_normal",
      "put3(surfgrad_decal_gradient_from_normal(decal_direction($direction, $rotation), $perturbed))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return test::flat(decal_gradient_from_normal(
            DecalDirection<T>{in.core.direction, in.core.direction, in.core.rotation.x, T(1), true},
            in.core.perturbed));
      },
      [](const Exact& in) {
        const double along = std::abs(dot(in.core.direction, normalize_or_zero(in.core.perturbed)));
        const double g = length(from_perturbed_normal(in.core.direction, in.core.perturbed));
        return all_within<3>(11 / along * std::max(1.0, g));
      }));
}

/// A plane over the texture, above and below the rays: h = 0.5 + slope . (st - origin).
template <class T>
ParallaxHit<T> march(const Shader<T>& in) {
  const auto height_at = [&](vec2<T> st, T, bool) {
    return T(0.5) + dot(in.height_map, st - in.core.fraction);
  };
  return march_parallax(height_at, in.core.fraction, vec2<T>{T(0.4), T(-0.3)}, 20);
}

void add_parallax(std::vector<Row>& rows) {
  const auto march_row = [&](const char* name, const char* call) {
    rows.push_back(make_row(
        name, call,
        [](const auto& in) {
          using T = std::decay_t<decltype(in.fade)>;
          const ParallaxHit<T> hit = march(in);
          return std::array{hit.texture_coordinate.x, hit.texture_coordinate.y, hit.height,
                            hit.hit ? T(1) : T(0)};
        },
        [](const Exact& in) {
          // Ray and plane approach at the rate 1 - slope . dst, which is at least 1/2 here.
          const double rate = 1 - dot(in.height_map, vec2<double>{0.4, -0.3});
          const double height = 4 / rate;
          return std::array{height + 2, height + 2, height, 0.0};
        }));
  };
  march_row("march_parallax", "put_march($fraction, v2(0.4, -0.3), 20, $height_map)");
  march_row("march_parallax: in one statement",
            "put_march_in_one($fraction, v2(0.4, -0.3), 20, $height_map)");
}

template <class T>
std::array<T, 15> flat(const HexTiles<T>& t) {
  return {t.st[0].x,       t.st[0].y,       t.st[1].x,       t.st[1].y,       t.st[2].x,
          t.st[2].y,       t.weight[0],     t.weight[1],     t.weight[2],     t.rotation[0].x,
          t.rotation[0].y, t.rotation[1].x, t.rotation[1].y, t.rotation[2].x, t.rotation[2].y};
}

/// The grid's triangle is a decision: within rounding of a border, which of two are the tiles is open.
std::array<double, 15> hex_bounds(const Exact& in, double edge, double period, const HexTiles<double>& t) {
  const double size = max_abs(in.plane);
  const double weight = 4 * (1 + size / edge);
  std::array<double, 15> eps{};
  for (int i = 0; i < 6; ++i) eps[i] = 4 * (size + edge + period);
  for (int i = 6; i < 9; ++i) eps[i] = weight;
  for (int i = 9; i < 15; ++i) eps[i] = 2;
  const double margin = std::min({t.weight[0], t.weight[1], t.weight[2]});
  const bool decided = margin > 2 * weight * static_cast<double>(epsilon_v<float>);
  for (double& each : eps) each = decided ? each : undecided;
  return eps;
}

/// Tiles with weights that sum to 1 and slopes as different as they get.
template <class T>
HexTiles<T> some_tiles(const Shader<T>& in) {
  return {{in.core.deriv, in.core.deriv_y, in.core.deriv_z},
          {in.core.weights.x, in.core.weights.y, in.core.weights.z},
          {in.core.xy_normal, in.core.fraction, in.core.xy_normal}};
}

template <class T>
vec3<T> some_weights(const Shader<T>& in, T exponent, T contrast) {
  const vec2<T> deriv[3] = {in.core.deriv, in.core.deriv_y, in.core.deriv_z};
  return hex_weights(some_tiles(in), deriv, exponent, contrast);
}

/// The weights times what `of` says of a tile's weight before.
template <class Of>
std::vector<double> of_weights(const Exact& in, double exponent, double contrast, const Of& of) {
  const vec3<double> w = some_weights(in, exponent, contrast);
  const vec3<double> b = in.core.weights;
  return {w.x * of(b.x), w.y * of(b.y), w.z * of(b.z)};
}

void add_hex_weights(std::vector<Row>& rows, Row row, double exponent, double contrast) {
  // An exponent of 0 is the input.
  const auto power = [exponent](const Exact& in) { return exponent > 0 ? exponent : in.exponent; };
  row.bound = [=](const Exact& in) {
    return of_weights(in, power(in), contrast, [&](double share) {
      return 16 + 2 * power(in) * (1 + std::abs(std::log2(std::max(share, 1e-30))));
    });
  };
  // The weight's own power, and the largest error of the sum's.
  row.of_powers = [=](const Exact& in) {
    const double largest = max_abs(in.core.weights);
    const auto of_power = [&](double share) { return vulkan_pow_error(share / largest, power(in)); };
    const auto terms = of_weights(in, power(in), contrast, of_power);
    const double of_sum = *std::max_element(terms.begin(), terms.end());
    return of_weights(in, power(in), contrast, [&](double share) { return of_power(share) + of_sum; });
  };
  rows.push_back(std::move(row));
}

void add_hex_tiles(std::vector<Row>& rows) {
  rows.push_back(make_row(
      "hex_tiles", "put_tiles(surfgrad_hex_tiles($plane))",
      [](const auto& in) { return flat(hex_tiles(in.plane)); },
      [](const Exact& in) { return hex_bounds(in, 0.5, 1, hex_tiles(in.plane)); }));
  rows.push_back(make_row(
      "hex_tiles: rotation", "put_tiles(surfgrad_hex_tiles($plane, $turn))",
      [](const auto& in) { return flat(hex_tiles(in.plane, in.turn)); },
      [](const Exact& in) { return hex_bounds(in, 0.5, 1, hex_tiles(in.plane, in.turn)); }));
  rows.push_back(make_row(
      "hex_tiles: moved",
      "put_tiles(surfgrad_hex_tiles($plane, $turn, 0.75, v2(1.0, 1.5), hex_origin(12345u, v2(0.25, 0.5))))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return flat(hex_tiles(in.plane, in.turn, T(0.75), {T(1), T(1.5)}, {12345u, {T(0.25), T(0.5)}}));
      },
      [](const Exact& in) {
        return hex_bounds(in, 0.75, 1.5, hex_tiles(in.plane, in.turn, 0.75, {1, 1.5}, {12345u, {0.25, 0.5}}));
      }));
  rows.push_back(make_row(
      "rotate", "put2(surfgrad_rotate($deriv, $direction.xy))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return test::flat(rotate(in.core.deriv, vec2<T>{in.core.direction.x, in.core.direction.y}));
      },
      [](const Exact& in) { return all_within<2>(2 * max_abs(in.core.deriv)); }));
  rows.push_back(make_row(
      "rotate_back", "put2(surfgrad_rotate_back($deriv, $direction.xy))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return test::flat(rotate_back(in.core.deriv, vec2<T>{in.core.direction.x, in.core.direction.y}));
      },
      [](const Exact& in) { return all_within<2>(2 * max_abs(in.core.deriv)); }));
  const std::string tiles = "some_tiles($deriv, $deriv_y, $deriv_z, $weights, $xy_normal, $fraction)";
  add_hex_weights(rows,
                  make_row(
                      "hex_weights", "put_hex_weights(" + tiles + ", $deriv, $deriv_y, $deriv_z)",
                      [](const auto& in) {
                        using T = std::decay_t<decltype(in.fade)>;
                        return test::flat(some_weights(in, T(7), T(1.5)));
                      },
                      [](const Exact&) { return all_within<3>(0); }),
                  7, 1.5);
  add_hex_weights(rows,
                  make_row(
                      "hex_weights: exponent",
                      "put_hex_weights_of(" + tiles + ", $deriv, $deriv_y, $deriv_z, $exponent, 0.0)",
                      [](const auto& in) {
                        using T = std::decay_t<decltype(in.fade)>;
                        return test::flat(some_weights(in, in.exponent, T(0)));
                      },
                      [](const Exact&) { return all_within<3>(0); }),
                  0, 0);
  rows.push_back(make_row(
      "hex_derivative", "put_hex_derivative(" + tiles + ", $weights, $deriv, $deriv_y, $deriv_z)",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        const vec2<T> deriv[3] = {in.core.deriv, in.core.deriv_y, in.core.deriv_z};
        return test::flat(hex_derivative(some_tiles(in), in.core.weights, deriv));
      },
      [](const Exact& in) {
        const auto sum = [](vec2<double> d) { return std::abs(d.x) + std::abs(d.y); };
        return all_within<2>(4 * (in.core.weights.x * sum(in.core.deriv) +
                                  in.core.weights.y * sum(in.core.deriv_y) +
                                  in.core.weights.z * sum(in.core.deriv_z)));
      }));
}

void add_moments(std::vector<Row>& rows) {
  rows.push_back(make_row(
      "moments_from_derivative", "put_moments(surfgrad_moments_from_derivative($deriv))",
      [](const auto& in) {
        const auto m = moments_from_derivative(in.core.deriv);
        return std::array{m.mean.x, m.mean.y, m.square.x, m.square.y, m.product};
      },
      [](const Exact& in) {
        const vec2<double> d = in.core.deriv;
        return std::array{0.0, 0.0, 0.5 * d.x * d.x, 0.5 * d.y * d.y, 0.5 * std::abs(d.x * d.y)};
      }));
  rows.push_back(make_row(
      "roughness_from_moments",
      "put1(surfgrad_roughness_from_moments($alpha, moments($height_map, $fraction)))",
      [](const auto& in) {
        using T = std::decay_t<decltype(in.fade)>;
        return test::flat(
            roughness_from_moments(in.alpha, SlopeMoments<T>{in.height_map, in.core.fraction, T(0)}));
      },
      [](const Exact& in) {
        const double r =
            roughness_from_moments(in.alpha, SlopeMoments<double>{in.height_map, in.core.fraction, 0});
        return all_within<1>(2 * (in.alpha + (in.core.fraction.x + in.core.fraction.y) / r));
      }));
}

} // namespace

void add_shape_rows(std::vector<Row>& rows) {
  add_decals(rows);
  add_parallax(rows);
  add_hex_tiles(rows);
  add_moments(rows);
}

} // namespace surfgrad::test
