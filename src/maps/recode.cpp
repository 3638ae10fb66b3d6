#include "maps/recode.hpp"

#include "image/parallel.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace surfgrad::maps {
namespace {

bool keeps_values(const image::Image& map, const Conversion& c) {
  if (c.retile || c.width > 0 || c.mips || c.base_roughness) return false;
  const bool has_codes = map.texels.visit([](const auto& values) {
    return std::is_integral_v<typename std::decay_t<decltype(values)>::value_type>;
  });
  if (!has_codes || !image::is_integer(c.depth)) return false;
  const bool widens = map.depth == image::Depth::unorm8 && c.depth == image::Depth::unorm16;
  if (map.depth != c.depth && !widens) return false;
  if (c.from.kind != c.to.kind) return false;
  if (c.from.kind != Kind::derivative) return true;
  // Only between is a code of 8 bits also one of 16.
  const bool same_codes = c.from.range == c.to.range && c.from.neutral == c.to.neutral;
  return same_codes && !(widens && c.from.neutral == stack::NeutralCode::whole);
}

} // namespace

std::optional<Recoding> Recoding::of(const image::Image& map, const Conversion& c,
                                     const std::filesystem::path& file) {
  if (!keeps_values(map, c)) return {};
  const Arrangement arrangement = arrangement_of(map, c.from, c.to, file);
  if (!arrangement.is_only_that) return {};
  Recoding recoding;
  recoding.map_ = &map;
  recoding.depth_ = c.depth;
  recoding.channels_ = arrangement.channels;
  recoding.has_alpha_ = arrangement.has_alpha;
  const bool is_whole = c.from.kind == Kind::derivative && c.from.neutral == stack::NeutralCode::whole;
  for (std::size_t i = 0; i < arrangement.sources.size(); ++i) {
    recoding.sources_[i].source = arrangement.sources[i].channel;
    if (arrangement.sources[i].flips)
      recoding.sources_[i].turn = is_whole ? Channel::Turn::in_whole : Channel::Turn::over;
  }
  return recoding;
}

template <class From, class To>
void Recoding::recode(const From* from, To* to, std::size_t texels) const {
  constexpr From most = std::numeric_limits<From>::max();
  // A code of 8 bits twice over is the same value in 16.
  constexpr unsigned widening = sizeof(To) > sizeof(From) ? 257 : 1;
  const auto from_step = static_cast<std::size_t>(map_->channels);
  const auto to_step = static_cast<std::size_t>(channels_);
  const auto each = [&](std::size_t c, const auto& turned) {
    const From* source = from + sources_[c].source;
    To* target = to + c;
    for (std::size_t i = 0; i < texels; ++i, source += from_step, target += to_step)
      *target = static_cast<To>(widening * turned(*source));
  };
  for (std::size_t c = 0; c < to_step; ++c) {
    if (sources_[c].source < 0) {
      for (std::size_t i = 0; i < texels; ++i) to[i * to_step + c] = std::numeric_limits<To>::max();
      continue;
    }
    switch (sources_[c].turn) {
    case Channel::Turn::none:
      each(c, [](From code) { return unsigned{code}; });
      break;
    case Channel::Turn::over:
      each(c, [](From code) { return unsigned{most} - code; });
      break;
    case Channel::Turn::in_whole: // code 0 is read as code 1
      each(c, [](From code) { return unsigned{most} + 1u - std::max<unsigned>(code, 1u); });
      break;
    }
  }
}

image::Image Recoding::rows(int bottom, int count) const {
  image::Image result{map_->width, count, channels_, depth_, has_alpha_, {}};
  const auto width = static_cast<std::size_t>(map_->width);
  const auto make = [&]<class From, class To>(const std::vector<From>& codes, std::vector<To> made) {
    made.resize(result.index(0, count));
    image::in_parallel(static_cast<std::size_t>(count), width, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      recode(codes.data() + map_->index(0, bottom + y), made.data() + result.index(0, y), width);
    });
    result.texels = image::Texels(std::move(made));
  };
  map_->texels.visit([&](const auto& codes) {
    using Code = typename std::decay_t<decltype(codes)>::value_type;
    if constexpr (std::is_integral_v<Code>) {
      if (depth_ == image::Depth::unorm8) {
        if constexpr (sizeof(Code) == 1) make(codes, image::Texels::Codes8{});
      } else {
        make(codes, image::Texels::Codes16{});
      }
    }
  });
  return result;
}

} // namespace surfgrad::maps
