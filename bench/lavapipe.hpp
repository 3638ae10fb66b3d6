#pragma once

#include "slope_pyramid.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace surfgrad::bench {

/// No Vulkan, or none on the processor.
class NoLavapipe : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Layout of a vertex: what lavapipe_render.vert reads.
struct PeerVertex {
  float position[3]; ///< relative to the eye
  float normal[3];
  float st[3][2];
};

/// What lavapipe_render.frag reads besides the maps.
struct PeerLight {
  float sun[4];
  float mirrored[65][4];
};

struct PeerScene {
  int width = 0;
  int height = 0;
  std::vector<PeerVertex> vertices{};
  std::vector<std::uint32_t> indices{};       ///< counter-clockwise seen from outside
  std::array<float, 16> clip_from_relative{}; ///< column by column
  std::array<const SlopePyramid*, 3> maps{};
  PeerLight light{};
};

/// How the peer's textures hold slopes.
enum class PeerTexels { float32, float16 };

/// The render race's scene on Mesa's lavapipe: Vulkan on the processor, without a window.
class Lavapipe {
 public:
  /// threads  that rasterise and shade
  /// Throws NoLavapipe.
  Lavapipe(const PeerScene& scene, PeerTexels texels, int threads);
  ~Lavapipe();
  Lavapipe(const Lavapipe&) = delete;
  Lavapipe& operator=(const Lavapipe&) = delete;

  /// Draws one picture and waits for it.
  void draw();
  /// RGBA bytes of the last picture, row 0 at the top; alpha is 0 where nothing is seen.
  [[nodiscard]] std::vector<std::uint8_t> picture();
  /// The driver's own name and version.
  [[nodiscard]] std::string driver() const;

 private:
  struct Device;
  std::unique_ptr<Device> device_;
};

} // namespace surfgrad::bench
