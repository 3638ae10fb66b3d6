#pragma once

/// A scalar with what the concepts ask for and no more: one lane, whose index and bits come from conversions
/// alone.

#include <surfgrad/scalar.hpp>

namespace surfgrad::test {

struct LeastBits;

class LeastIndex {
 public:
  explicit LeastIndex(const LeastBits& b);
  friend LeastIndex operator+(LeastIndex a, LeastIndex b) { return {a.v_ + b.v_, made}; }
  friend LeastIndex operator-(LeastIndex a, LeastIndex b) { return {a.v_ - b.v_, made}; }
  friend LeastIndex operator>>(LeastIndex a, int n) { return {a.v_ >> n, made}; }
  friend bool operator<(LeastIndex a, LeastIndex b) { return a.v_ < b.v_; }
  friend LeastIndex select(bool m, LeastIndex a, LeastIndex b) { return m ? a : b; }

 private:
  friend struct LeastFloat;
  friend struct LeastBits;
  static constexpr bool made = true; // keeps what is made here from what users could make
  LeastIndex(std::int32_t v, bool) : v_(v) {}
  std::int32_t v_;
};

struct LeastBits {
  explicit LeastBits(LeastIndex i) : v(static_cast<std::uint32_t>(i.v_)) {}
  friend LeastBits operator^(LeastBits a, LeastBits b) { return of(a.v ^ b.v); }
  friend LeastBits operator*(LeastBits a, LeastBits b) { return of(a.v * b.v); }
  friend LeastBits operator+(LeastBits a, LeastBits b) { return of(a.v + b.v); }
  friend LeastBits operator>>(LeastBits a, int n) { return of(a.v >> n); }
  friend LeastBits operator<<(LeastBits a, int n) { return of(a.v << n); }
  static LeastBits of(std::uint32_t v) { return LeastBits(LeastIndex(static_cast<std::int32_t>(v), true)); }
  std::uint32_t v;
};

inline LeastIndex::LeastIndex(const LeastBits& b) : v_(static_cast<std::int32_t>(b.v)) {}

struct LeastFloat {
  LeastFloat() = default;
  explicit LeastFloat(float x) : v(x) {}
  explicit LeastFloat(LeastIndex i) : v(static_cast<float>(i.v_)) {}
  friend LeastFloat operator+(LeastFloat a, LeastFloat b) { return LeastFloat(a.v + b.v); }
  friend LeastFloat operator-(LeastFloat a, LeastFloat b) { return LeastFloat(a.v - b.v); }
  friend LeastFloat operator*(LeastFloat a, LeastFloat b) { return LeastFloat(a.v * b.v); }
  friend LeastFloat operator/(LeastFloat a, LeastFloat b) { return LeastFloat(a.v / b.v); }
  friend LeastFloat operator-(LeastFloat a) { return LeastFloat(-a.v); }
  friend bool operator<(LeastFloat a, LeastFloat b) { return a.v < b.v; }
  friend bool operator==(LeastFloat a, LeastFloat b) { return a.v == b.v; }
  friend LeastFloat select(bool m, LeastFloat a, LeastFloat b) { return m ? a : b; }
  friend LeastFloat sqrt(LeastFloat a) { return LeastFloat(std::sqrt(a.v)); }
  friend LeastFloat floor(LeastFloat a) { return LeastFloat(std::floor(a.v)); }
  friend LeastFloat abs(LeastFloat a) { return LeastFloat(std::abs(a.v)); }
  friend LeastFloat min(LeastFloat a, LeastFloat b) { return LeastFloat(surfgrad::min(a.v, b.v)); }
  friend LeastFloat max(LeastFloat a, LeastFloat b) { return LeastFloat(surfgrad::max(a.v, b.v)); }
  friend LeastIndex to_index(LeastFloat a) {
    return LeastIndex(LeastBits::of(static_cast<std::uint32_t>(surfgrad::to_index(a.v))));
  }
  float v;
};

inline LeastBits gather(Words words, LeastIndex i, bool m) {
  return LeastBits::of(surfgrad::gather(words, static_cast<std::int32_t>(LeastBits(i).v), m));
}

} // namespace surfgrad::test

template <>
struct surfgrad::lanes_of<surfgrad::test::LeastFloat> {
  using value = float;
  using mask = bool;
  using index = surfgrad::test::LeastIndex;
  using bits = surfgrad::test::LeastBits;
};
