#include <surfgrad/noise_hash.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <random>
#include <vector>

namespace surfgrad {
namespace {

constexpr std::uint64_t seed = 20240611;

TEST(LatticeHash, SeparatesEveryPointOfALargeBlock) {
  std::vector<std::uint32_t> hashes;
  for (int z = -64; z < 64; ++z) {
    for (int y = -64; y < 64; ++y) {
      for (int x = -64; x < 64; ++x) hashes.push_back(lattice_hash<float>(x, y, z));
    }
  }
  std::sort(hashes.begin(), hashes.end());
  // Random values would collide about 500 times; the documented distance of 1749 forbids any.
  EXPECT_EQ(std::adjacent_find(hashes.begin(), hashes.end()), hashes.end());
}

TEST(LatticeHash, EveryLowInputBitFlipsEveryOutputBitHalfOfTheTime) {
  std::mt19937 engine(static_cast<unsigned>(seed));
  constexpr int trials = 20000;
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (int bit = 0; bit < 12; ++bit) {
      std::array<int, 32> flips{};
      for (int i = 0; i < trials; ++i) {
        std::array<std::int32_t, 3> c{};
        for (auto& component : c) component = static_cast<std::int32_t>(engine() % 8192) - 4096;
        const std::uint32_t before = lattice_hash<float>(c[0], c[1], c[2]);
        c[axis] ^= 1 << bit;
        const std::uint32_t changed = before ^ lattice_hash<float>(c[0], c[1], c[2]);
        for (int out = 0; out < 32; ++out) flips[out] += (changed >> out) & 1u;
      }
      for (const int n : flips) worst = std::max(worst, std::abs(double(n) / trials - 0.5));
    }
  }
  std::cout << "largest deviation from 1/2: " << worst << " (seed " << seed << ")\n";
  // Five standard deviations of 20000 coin tosses (0.0035 each) for 1152 pairs of bits.
  EXPECT_LT(worst, 0.018);
}

TEST(LatticeHash, GradientChoicesOfNeighboursAreIndependent) {
  for (const std::array<int, 3> step : {std::array{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}) {
    std::vector<int> pairs(256);
    constexpr int edge = 48;
    for (int z = 0; z < edge; ++z) {
      for (int y = 0; y < edge; ++y) {
        for (int x = 0; x < edge; ++x) {
          const std::uint32_t a = lattice_hash<float>(x, y, z);
          const std::uint32_t b = lattice_hash<float>(x + step[0], y + step[1], z + step[2]);
          ++pairs[(a & 15u) * 16 + (b & 15u)];
        }
      }
    }
    const double expected = edge * edge * edge / 256.0;
    double chi_square = 0;
    for (const int n : pairs) chi_square += (n - expected) * (n - expected) / expected;
    std::cout << "chi square of 255 degrees of freedom: " << chi_square << "\n";
    // Mean 255, standard deviation sqrt(2 * 255) = 22.6; five of them.
    EXPECT_LT(chi_square, 255 + 5 * 22.6);
  }
}

TEST(LatticeHash, IsTheSameForEveryScalar) {
  for (int i = -1000; i < 1000; ++i) {
    EXPECT_EQ(lattice_hash<float>(i, 7 * i, -3), lattice_hash<double>(i, 7 * i, -3));
  }
}

TEST(MovedLatticeHash, CountsFromItsCell) {
  std::mt19937 engine(static_cast<unsigned>(seed));
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t cell[3] = {static_cast<std::uint32_t>(engine()), static_cast<std::uint32_t>(engine()),
                                   static_cast<std::uint32_t>(engine())};
    const MovedLatticeHash<float> moved{lattice_start(cell[0], cell[1], cell[2])};
    const auto near = [&] { return static_cast<std::int32_t>(engine() % 2001) - 1000; };
    const std::int32_t x = near(), y = near(), z = near();
    const auto sum = [](std::uint32_t a, std::int32_t b) {
      return static_cast<std::int32_t>(a + static_cast<std::uint32_t>(b));
    };
    EXPECT_EQ(moved(x, y, z), lattice_hash<float>(sum(cell[0], x), sum(cell[1], y), sum(cell[2], z)));
    EXPECT_EQ(MovedLatticeHash<double>{}(x, y, z), lattice_hash<double>(x, y, z));
  }
}

} // namespace
} // namespace surfgrad
