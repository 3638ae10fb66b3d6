#pragma once

/// What the author's own shader functions returned for random pixel quads: tests/vectors/README.md describes
/// them. The project has 128 quads, and reads 2048 where the shared folder has them.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <surfgrad/vec.hpp>
#include <vector>

namespace surfgrad::test {

inline constexpr int quad_inputs = 44;
inline constexpr int quad_outputs = 64;

/// Pixels of a set: two a quad along each axis.
struct QuadGrid {
  std::string folder;
  int width, height;
};
inline const QuadGrid own_quads{SURFGRAD_SOURCE_DIR "/tests/vectors/", 256, 2};
inline const QuadGrid all_quads{SURFGRAD_SHARED_DIR "/vectors/", 512, 16};

/// All quads where they are, else the project's own.
inline const QuadGrid& most_quads() {
  return std::filesystem::exists(all_quads.folder) ? all_quads : own_quads;
}

inline std::vector<float> read_floats(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  std::vector<float> values(bytes.size() / sizeof(float));
  // An absent file is no floats, and memcpy takes no null pointer even for none.
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

/// One pixel's inputs, its differences within the quad included.
template <class T>
struct Pixel {
  vec3<T> position, normal, tangent;
  T sign;
  vec3<T> tangent_normal, perturbed, gradient;
  vec2<T> deriv_x, deriv_y, deriv_z;
  vec3<T> direction;
  T bump_scale;
  vec2<T> offset, height_deriv;
  vec3<T> screen_position;
  T x, y;
  vec3<T> dp_dx, dp_dy;
  vec2<T> dst_dx, dst_dy;
};

class Quads {
 public:
  explicit Quads(const QuadGrid& grid)
      : width(grid.width), height(grid.height), in_(read_floats(grid.folder + "quads_in.f32")),
        out_(read_floats(grid.folder + "quads_out.f32")),
        matrix_(read_floats(grid.folder + "world_from_screen.f32")) {}
  const int width, height; ///< in pixels
  [[nodiscard]] bool complete() const {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return in_.size() == pixels * quad_inputs && out_.size() == pixels * quad_outputs && matrix_.size() == 16;
  }
  [[nodiscard]] const float* record(int x, int y) const { return &in_[offset(x, y) * quad_inputs]; }
  [[nodiscard]] const float* expected(int x, int y) const { return &out_[offset(x, y) * quad_outputs]; }

  template <class T>
  [[nodiscard]] mat4<T> matrix() const {
    const auto row = [&](std::size_t r) {
      return vec4<T>{T(matrix_[4 * r]), T(matrix_[4 * r + 1]), T(matrix_[4 * r + 2]), T(matrix_[4 * r + 3])};
    };
    return {row(0), row(1), row(2), row(3)};
  }
  template <class T>
  [[nodiscard]] Pixel<T> pixel(int x, int y) const {
    const float* p = record(x, y);
    const auto v3 = [&](int i) { return vec3<T>{T(p[i]), T(p[i + 1]), T(p[i + 2])}; };
    const auto v2 = [&](int i) { return vec2<T>{T(p[i]), T(p[i + 1])}; };
    // ddx_fine and ddy_fine: differences in float, on the pixel's own row and column of the quad.
    const float* left = record(x & ~1, y);
    const float* right = record(x | 1, y);
    const float* upper = record(x, y & ~1);
    const float* lower = record(x, y | 1);
    const auto dx = [&](int i) { return T(right[i] - left[i]); };
    const auto dy = [&](int i) { return T(lower[i] - upper[i]); };
    return {v3(0),
            v3(3),
            v3(6),
            T(p[9]),
            v3(12),
            v3(15),
            v3(18),
            v2(21),
            v2(23),
            v2(25),
            v3(27),
            T(p[30]),
            v2(31),
            v2(33),
            v3(35),
            T(p[38]),
            T(p[39]),
            {dx(0), dx(1), dx(2)},
            {dy(0), dy(1), dy(2)},
            {dx(10), dx(11)},
            {dy(10), dy(11)}};
  }

 private:
  [[nodiscard]] std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  std::vector<float> in_, out_, matrix_;
};

/// One group of columns, and the error that the reference has in it.
struct QuadGroup {
  const char* name;
  int first, count;
  double reference_error; ///< the README's: relative to the longest component of the group
};
inline constexpr QuadGroup quad_groups[] = {
    {"sigma_x", 0, 3, 2e-7},
    {"sigma_y", 3, 3, 2e-7},
    {"flip_sign", 6, 1, 0},
    {"normal", 7, 3, 2e-7},
    {"mikktspace tangent", 10, 3, 2e-7},
    {"mikktspace bitangent", 13, 3, 2e-7},
    {"derivative_from_normal", 16, 2, 6e-8},
    {"from_tbn, mikktspace", 18, 3, 3e-7},
    {"tangent_basis tangent", 21, 3, 3e-7},
    {"tangent_basis bitangent", 24, 3, 3e-7},
    {"from_tbn, tangent_basis", 27, 3, 3e-7},
    {"from_perturbed_normal", 30, 3, 2e-5},
    {"from_texel_derivative", 33, 3, 7e-7},
    {"from_height_derivative", 36, 3, 3e-7},
    {"from_volume_gradient", 39, 3, 3e-5},
    {"triplanar_weights", 42, 3, 4e-7},
    {"from_triplanar", 45, 3, 6e-6},
    {"project_to_texture_space", 48, 2, 2e-6},
    {"project_to_texture_space, skipped", 50, 2, 2e-6},
    {"surface_offset", 52, 3, 4e-7},
    {"resolve_normal", 55, 3, 1e-6},
    {"screen_derivatives dp_dx", 58, 3, 4e-4},
    {"screen_derivatives dp_dy", 61, 3, 4e-4},
};

} // namespace surfgrad::test
