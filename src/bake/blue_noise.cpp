#include "bake/blue_noise.hpp"

#include <algorithm>
#include <vector>

namespace surfgrad::bake {
namespace {

constexpr int side = blue_noise_side;
constexpr int area = side * side;

/// Dots on the tile, which goes on at its other side, and how crowded each place is by them.
class Dots {
 public:
  Dots() {
    // A Gaussian of standard deviation 1.5 (Ulichney's choice), in whole numbers: sums of them do not depend
    // on the order in which dots came and went. q = exp(-1 / (2 * 1.5^2)), and exp(-(x^2 + y^2) / ...) =
    // q^(x^2 + y^2).
    constexpr double q = 0.80073740291680806;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        double weight = 1 << 24;
        for (int i = 0; i < x * x + y * y; ++i) weight *= q;
        weights_.push_back(static_cast<std::int32_t>(weight + 0.5));
      }
  }

  void put(int place) { change(place, true); }
  void take(int place) { change(place, false); }
  /// The dot with the most dots around it, and the place without a dot with the fewest; the first of several.
  [[nodiscard]] int tightest_cluster() const {
    int found = -1;
    for (int i = 0; i < area; ++i)
      if (dots_[i] && (found < 0 || crowd_[i] > crowd_[found])) found = i;
    return found;
  }
  [[nodiscard]] int largest_void() const {
    int found = -1;
    for (int i = 0; i < area; ++i)
      if (!dots_[i] && (found < 0 || crowd_[i] < crowd_[found])) found = i;
    return found;
  }

 private:
  static constexpr int reach = 9; // beyond six deviations nothing is left of 2^24

  void change(int place, bool dot) {
    dots_[place] = dot;
    const int sign = dot ? 1 : -1;
    const std::int32_t* weight = weights_.data();
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x) {
        const int column = (place % side + x + side) % side;
        const int row = (place / side + y + side) % side;
        crowd_[row * side + column] += sign * *weight++;
      }
  }

  std::vector<std::int32_t> weights_{};
  std::array<bool, area> dots_{};
  std::array<std::int32_t, area> crowd_{}; // at most 2^24 * 2 pi 1.5^2 < 2^28
};

BlueNoise make() {
  Dots dots;
  // A tenth of the places at random, then moved from clusters into voids until none moves.
  constexpr int few = area / 10;
  std::vector<int> initial;
  std::uint32_t state = 1;
  while (initial.size() < static_cast<std::size_t>(few)) {
    state = state * 1664525u + 1013904223u;          // Numerical Recipes; the high bits are random enough
    const int place = static_cast<int>(state >> 20); // of 2^12
    if (std::find(initial.begin(), initial.end(), place) != initial.end()) continue;
    initial.push_back(place);
    dots.put(place);
  }
  for (;;) {
    const int from = dots.tightest_cluster();
    dots.take(from);
    const int to = dots.largest_void();
    dots.put(to);
    if (from == to) break;
    *std::find(initial.begin(), initial.end(), from) = to;
  }
  BlueNoise ranks{};
  // Below the few ranks: clusters go first, so that what stays is even.
  Dots shrinking = dots;
  for (int rank = few - 1; rank >= 0; --rank) {
    const int place = shrinking.tightest_cluster();
    shrinking.take(place);
    ranks[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(rank);
  }
  // Above: voids are filled. Where dots are the majority the largest void of dots is the tightest cluster of
  // gaps, as the two crowds add up to a constant.
  for (int rank = few; rank < area; ++rank) {
    const int place = dots.largest_void();
    dots.put(place);
    ranks[static_cast<std::size_t>(place)] = static_cast<std::uint16_t>(rank);
  }
  return ranks;
}

} // namespace

const BlueNoise& blue_noise() {
  static const BlueNoise ranks = make();
  return ranks;
}

} // namespace surfgrad::bake
