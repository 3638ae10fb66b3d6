/// For the arguments of the reference vectors, shaders give what the author's own shaders gave.

#include "conformance/device_rows.hpp"
#include "support/reference_vectors.hpp"
#include "support/worst.hpp"

#include <surfgrad/triplanar.hpp>

#include <algorithm>
#include <cmath>

namespace surfgrad::test {
namespace {

using Inputs = ShaderInputs<float>;

/// Arguments that are results of the reference: what it chained together is compared a function at a time.
vec3<float> three(const float* out) { return {out[0], out[1], out[2]}; }
void with_mikktspace(Inputs& in, const float* out) {
  in.core.deriv = {out[16], out[17]};
  in.core.tangent = three(out + 10);
  in.core.bitangent = three(out + 13);
}
void with_tangent_basis(Inputs& in, const float* out) {
  in.core.deriv = {out[16], out[17]};
  in.core.tangent = three(out + 21);
  in.core.bitangent = three(out + 24);
}
void with_sum(Inputs& in, const float* out) {
  in.core.frame.normal = three(out + 7);
  in.core.gradient = 0.7f * three(out + 18) + 0.4f * three(out + 39);
}

/// The columns of the reference's results that a row gives.
struct Columns {
  const char* row;
  std::size_t first, count;
  bool turns_green = false;  ///< the reference's texture origin is upper left
  bool by_magnitude = false; ///< the reference divides by |dot(normal, dir)|
  void (*prepare)(Inputs&, const float*) = nullptr;
  std::size_t component = 0; ///< of the row, where the columns begin
};
constexpr Columns columns[] = {
    {.row = "make_frame", .first = 0, .count = 6},
    {.row = "make_frame: back faces SAME", .first = 6, .count = 1, .component = 9},
    {.row = "make_frame: back faces SAME", .first = 7, .count = 3},
    {.row = "mikktspace_basis", .first = 10, .count = 6},
    {.row = "derivative_from_normal(3)", .first = 16, .count = 2, .turns_green = true},
    {.row = "from_tbn", .first = 18, .count = 3, .prepare = with_mikktspace},
    {.row = "tangent_basis", .first = 21, .count = 6},
    {.row = "from_tbn", .first = 27, .count = 3, .prepare = with_tangent_basis},
    {.row = "from_perturbed_normal", .first = 30, .count = 3},
    {.row = "from_texel_derivative", .first = 33, .count = 3},
    {.row = "from_height_derivative", .first = 36, .count = 3},
    {.row = "from_volume_gradient", .first = 39, .count = 3},
    {.row = "triplanar_weights", .first = 42, .count = 3},
    {.row = "from_triplanar: listing 13", .first = 45, .count = 3},
    {.row = "project_to_texture_space", .first = 48, .count = 2, .by_magnitude = true},
    {.row = "project_to_texture_space, skipped", .first = 50, .count = 2},
    {.row = "surface_offset", .first = 52, .count = 3},
    {.row = "resolve_normal", .first = 55, .count = 3, .prepare = with_sum},
    {.row = "screen_derivatives", .first = 58, .count = 6}};

Inputs inputs_of(const Pixel<float>& p, const mat4<float>& world_from_screen) {
  Inputs in{};
  in.core.frame = make_frame(p.normal, p.dp_dx, p.dp_dy);
  in.core.raw_normal = p.normal;
  in.core.raw_tangent = p.tangent;
  in.core.sign = p.sign;
  in.core.tangent_normal = p.tangent_normal;
  in.core.perturbed = p.perturbed;
  in.core.gradient = p.gradient;
  in.core.direction = p.direction;
  in.core.position = p.screen_position;
  in.core.weights = triplanar_weights(in.core.frame.normal);
  in.core.dst_dx = p.dst_dx;
  in.core.dst_dy = p.dst_dy;
  in.core.texture_offset = p.offset;
  in.core.size = {512, 256};
  in.core.deriv = p.deriv_x;
  in.core.deriv_y = p.deriv_y;
  in.core.deriv_z = p.deriv_z;
  in.core.dh_duv = p.height_deriv;
  in.core.bump_scale = p.bump_scale;
  in.core.world_from_screen = world_from_screen;
  in.core.x = p.x;
  in.core.y = p.y;
  return in;
}

const Row& row_of(const Columns& some) {
  const auto found =
      std::find_if(rows().begin(), rows().end(), [&](const Row& row) { return row.name == some.row; });
  EXPECT_NE(found, rows().end()) << some.row;
  return *found;
}

TEST(Registry, EveryColumnOfTheReferenceVectorsIsCompared) {
  std::size_t next = 0;
  for (const Columns& some : columns) {
    EXPECT_EQ(some.first, next) << "columns before those of " << some.row << " are not compared, or twice";
    next = some.first + some.count;
  }
  EXPECT_EQ(next, std::size_t{quad_outputs});
}

TEST_P(Conformance, TheReferenceVectorsComeOut) {
  const Quads quads(own_quads);
  ASSERT_TRUE(quads.complete()) << "the reference vectors are cut short";
  std::vector<Inputs> cases;
  std::vector<const float*> outputs;
  for (int y = 0; y < quads.height; ++y)
    for (int x = 0; x < quads.width; ++x) {
      cases.push_back(inputs_of(quads.pixel<float>(x, y), quads.matrix<float>()));
      outputs.push_back(quads.expected(x, y));
    }
  std::vector<Job> jobs;
  for (const Columns& some : columns) {
    jobs.push_back({&row_of(some), cases});
    for (std::size_t i = 0; some.prepare != nullptr && i < cases.size(); ++i)
      some.prepare(jobs.back().cases[i], outputs[i]);
  }
  run(GetParam(), jobs);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const Columns& some = columns[j];
    Worst worst(jobs[j].row->name);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto bounds = jobs[j].row->device_bound(convert<double>(jobs[j].cases[i]));
      const float* expected = outputs[i];
      const double along = dot(cases[i].core.frame.normal, cases[i].core.direction);
      for (std::size_t k = 0; k < some.count; ++k) {
        const std::size_t column = some.first + k;
        const auto group =
            std::find_if(std::begin(quad_groups), std::end(quad_groups), [&](const QuadGroup& g) {
              return column < static_cast<std::size_t>(g.first + g.count);
            });
        double size = 0;
        for (int c = group->first; c < group->first + group->count; ++c)
          size = std::max(size, std::abs(static_cast<double>(expected[c])));
        double sign = 1;
        if (some.turns_green && k == 1) sign = -1;
        if (some.by_magnitude && along < 0) sign = -1;
        // The frame that came in has rounded once already: the row's bound counts twice.
        worst.add(sign * jobs[j].result(i, some.component + k), static_cast<double>(expected[column]),
                  group->reference_error * size + 2 * eps * bounds[some.component + k], static_cast<long>(i));
      }
    }
  }
}

} // namespace
} // namespace surfgrad::test
