#pragma once

#include "image/image.hpp"
#include "maps/convert.hpp"

#include <array>
#include <filesystem>
#include <optional>

namespace surfgrad::maps {

/// A conversion that only moves channels of a file of codes, turns some over, and widens 8 bits to 16: on the
/// codes themselves and as few rows at a time as one likes, in little more time than it takes to read and
/// write the file. Every step can be undone to the last code.
class Recoding {
 public:
  /// None where the conversion asks for more, or the file's values are no codes. The map must outlive it.
  ///
  /// Throws InputError as convert does.
  [[nodiscard]] static std::optional<Recoding> of(const image::Image& map, const Conversion& conversion,
                                                  const std::filesystem::path& file);

  [[nodiscard]] int channels() const { return channels_; }
  [[nodiscard]] bool has_alpha() const { return has_alpha_; }
  /// The rows [bottom, bottom + count), as codes.
  [[nodiscard]] image::Image rows(int bottom, int count) const;

 private:
  /// What a channel of the result is made of.
  struct Channel {
    int source = -1; ///< -1: white
    enum class Turn {
      none,
      over,     ///< most code - code
      in_whole, ///< around the whole code in the middle, NeutralCode::whole
    } turn = Turn::none;
  };

  template <class From, class To>
  void recode(const From* from, To* to, std::size_t texels) const;

  const image::Image* map_ = nullptr;
  std::array<Channel, 4> sources_{};
  int channels_ = 0;
  bool has_alpha_ = false;
  image::Depth depth_ = image::Depth::unorm8;
};

} // namespace surfgrad::maps
