#pragma once

/// Vector registers as a scalar of the core: one fragment a lane.
///
/// Only for sources that are compiled once for each instruction set (surfgrad_for_each_isa in CMake):
/// SURFGRAD_ISA_NAMESPACE keeps their types apart, so that the linker never mixes their functions. Every
/// operation gives each lane the bits that the core's one-lane float gives, but for the sign of NaN.

#include "simd/lane.hpp"

#include <hwy/highway.h>

#include <surfgrad/scalar.hpp>

#include <array>

#ifndef SURFGRAD_ISA_NAMESPACE
#error "simd/pack.hpp serves sources that are compiled for one instruction set at a time"
#endif

namespace surfgrad::simd::SURFGRAD_ISA_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using FloatTag = hn::ScalableTag<float>;
using IndexTag = hn::RebindToSigned<FloatTag>;
using BitsTag = hn::RebindToUnsigned<FloatTag>;

inline constexpr int pack_width = HWY_LANES(float);

struct Float;
struct Index;
struct Bits;

struct Mask {
  hn::Mask<FloatTag> v;

  Mask() = default;
  HWY_INLINE Mask(hn::Mask<FloatTag> m) : v(m) {} // NOLINT: what comparisons give
  HWY_INLINE explicit Mask(bool set)
      : v(hn::RebindMask(FloatTag(), hn::Ne(hn::Set(IndexTag(), set ? 1 : 0), hn::Zero(IndexTag())))) {}
};

struct Index {
  hn::Vec<IndexTag> v;

  Index() = default;
  HWY_INLINE Index(hn::Vec<IndexTag> x) : v(x) {} // NOLINT: what integer operations give
  HWY_INLINE explicit Index(std::int32_t x) : v(hn::Set(IndexTag(), x)) {}
  HWY_INLINE explicit Index(const Bits& x);
};

struct Bits {
  hn::Vec<BitsTag> v;

  Bits() = default;
  HWY_INLINE Bits(hn::Vec<BitsTag> x) : v(x) {} // NOLINT: what integer operations give
  HWY_INLINE explicit Bits(std::uint32_t x) : v(hn::Set(BitsTag(), x)) {}
  HWY_INLINE explicit Bits(const Index& x) : v(hn::BitCast(BitsTag(), x.v)) {}
};

HWY_INLINE Index::Index(const Bits& x) : v(hn::BitCast(IndexTag(), x.v)) {}

struct Float {
  hn::Vec<FloatTag> v;

  Float() = default;
  HWY_INLINE Float(hn::Vec<FloatTag> x) : v(x) {} // NOLINT: what operations give
  HWY_INLINE explicit Float(float x) : v(hn::Set(FloatTag(), x)) {}
  HWY_INLINE explicit Float(const Index& x) : v(hn::ConvertTo(FloatTag(), x.v)) {}
};

// clang-format off
HWY_INLINE Float operator+(Float a, Float b) { return hn::Add(a.v, b.v); }
HWY_INLINE Float operator-(Float a, Float b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Float operator*(Float a, Float b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Float operator/(Float a, Float b) { return hn::Div(a.v, b.v); }
HWY_INLINE Float operator-(Float a) { return hn::Neg(a.v); }
HWY_INLINE Mask operator<(Float a, Float b) { return hn::Lt(a.v, b.v); }
HWY_INLINE Mask operator==(Float a, Float b) { return hn::Eq(a.v, b.v); }

HWY_INLINE Mask operator&(Mask a, Mask b) { return hn::And(a.v, b.v); }
HWY_INLINE Mask operator|(Mask a, Mask b) { return hn::Or(a.v, b.v); }
HWY_INLINE Mask operator!(Mask a) { return hn::Not(a.v); }

HWY_INLINE Index operator+(Index a, Index b) { return hn::Add(a.v, b.v); }
HWY_INLINE Index operator-(Index a, Index b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Index operator*(Index a, Index b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Index operator&(Index a, Index b) { return hn::And(a.v, b.v); }
HWY_INLINE Index operator>>(Index a, int n) { return hn::ShiftRightSame(a.v, n); }
HWY_INLINE Mask operator<(Index a, Index b) { return hn::RebindMask(FloatTag(), hn::Lt(a.v, b.v)); }
HWY_INLINE Mask operator==(Index a, Index b) { return hn::RebindMask(FloatTag(), hn::Eq(a.v, b.v)); }

HWY_INLINE Bits operator+(Bits a, Bits b) { return hn::Add(a.v, b.v); }
HWY_INLINE Bits operator*(Bits a, Bits b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Bits operator^(Bits a, Bits b) { return hn::Xor(a.v, b.v); }
HWY_INLINE Bits operator&(Bits a, Bits b) { return hn::And(a.v, b.v); }
HWY_INLINE Bits operator|(Bits a, Bits b) { return hn::Or(a.v, b.v); }
HWY_INLINE Bits operator>>(Bits a, int n) { return hn::ShiftRightSame(a.v, n); }
HWY_INLINE Bits operator<<(Bits a, int n) { return hn::ShiftLeftSame(a.v, n); }

/// Lane by lane, a where the mask is set, else b.
HWY_INLINE Float select(Mask m, Float a, Float b) { return hn::IfThenElse(m.v, a.v, b.v); }
HWY_INLINE Index select(Mask m, Index a, Index b) { return hn::IfThenElse(hn::RebindMask(IndexTag(), m.v), a.v, b.v); }
HWY_INLINE Bits select(Mask m, Bits a, Bits b) { return hn::IfThenElse(hn::RebindMask(BitsTag(), m.v), a.v, b.v); }

HWY_INLINE bool any(Mask m) { return !hn::AllFalse(FloatTag(), m.v); }
HWY_INLINE bool all(Mask m) { return hn::AllTrue(FloatTag(), m.v); }

HWY_INLINE Float sqrt(Float a) { return hn::Sqrt(a.v); }
HWY_INLINE Float floor(Float a) { return hn::Floor(a.v); }
HWY_INLINE Float abs(Float a) { return hn::Abs(a.v); }
// clang-format on

#if HWY_ARCH_X86
// What minps and maxps do: the second operand where either is NaN, and of equal zeros.
HWY_INLINE Float min(Float a, Float b) { return hn::Min(a.v, b.v); }
HWY_INLINE Float max(Float a, Float b) { return hn::Max(a.v, b.v); }
#else
HWY_INLINE Float min(Float a, Float b) { return select(a < b, a, b); }
HWY_INLINE Float max(Float a, Float b) { return select(b < a, a, b); }
#endif

/// Truncates; saturates; NaN gives 0.
HWY_INLINE Index to_index(Float a) {
  const hn::Mask<IndexTag> number = hn::RebindMask(IndexTag(), hn::Eq(a.v, a.v));
  return hn::IfThenElseZero(number, hn::ConvertTo(IndexTag(), a.v));
}

/// 2^23 more, a whole number is in the lowest bits.
HWY_INLINE Index whole_index(Float a) {
  const hn::Vec<FloatTag> shifted = hn::Add(a.v, hn::Set(FloatTag(), 8388608.0f));
  return hn::Sub(hn::BitCast(IndexTag(), shifted), hn::BitCast(IndexTag(), hn::Set(FloatTag(), 8388608.0f)));
}

/// The floats whose bits these are.
template <std::same_as<Float> T>
HWY_INLINE T float_from_bits(Bits a) {
  return hn::BitCast(FloatTag(), a.v);
}

/// As surfgrad::detail's for one lane: exponents by their bits.
HWY_INLINE void split_exponent(Float& m, Float& exponent) {
  const hn::Vec<BitsTag> bits = hn::BitCast(BitsTag(), m.v);
  const hn::Vec<IndexTag> e =
      hn::Sub(hn::BitCast(IndexTag(), hn::ShiftRight<23>(bits)), hn::Set(IndexTag(), 127));
  exponent = exponent + Float(Index(e));
  m = hn::BitCast(FloatTag(),
                  hn::Or(hn::And(bits, hn::Set(BitsTag(), 0x007fffffu)), hn::Set(BitsTag(), 0x3f800000u)));
}
HWY_INLINE void split_whole(Float& rest, Float& power) {
  const hn::Vec<IndexTag> whole = hn::ConvertTo(IndexTag(), rest.v);
  rest = rest - Float(Index(whole));
  power = power * Float(hn::BitCast(FloatTag(), hn::ShiftLeft<23>(hn::Add(whole, hn::Set(IndexTag(), 127)))));
}

/// Unset lanes read word 0 and give 0: there are no masked gathers on all instruction sets.
HWY_INLINE Bits gather(Words words, Index index, Mask m) {
  const hn::Mask<IndexTag> mi = hn::RebindMask(IndexTag(), m.v);
  const hn::Vec<BitsTag> read = hn::GatherIndex(BitsTag(), words.data, hn::IfThenElseZero(mi, index.v));
  return hn::IfThenElseZero(hn::RebindMask(BitsTag(), m.v), read);
}

HWY_INLINE float lane(Float a, int i) { return hn::ExtractLane(a.v, static_cast<std::size_t>(i)); }
HWY_INLINE std::int32_t lane(Index a, int i) { return hn::ExtractLane(a.v, static_cast<std::size_t>(i)); }
HWY_INLINE Float with_lane(Float a, int i, float x) {
  return hn::InsertLane(a.v, static_cast<std::size_t>(i), x);
}

/// Four words of each lane, loaded at once, as the vectors of their first, second, ... words.
template <std::size_t Lanes, class Load>
HWY_INLINE auto each_block(const Load& load, std::size_t first, std::size_t step) {
  if constexpr (Lanes == 4) {
    return load(first);
  } else {
    const hn::FixedTag<std::uint32_t, Lanes> all;
    return hn::Combine(all, each_block<Lanes / 2>(load, first + step * (Lanes / 8), step),
                       each_block<Lanes / 2>(load, first, step));
  }
}

using PairTag = hn::Repartition<std::uint64_t, BitsTag>;

/// Two words at each index, as one number. Highway's gather of them counts in pairs, and in 64 bits.
HWY_INLINE hn::Vec<PairTag> gather_pairs(const std::uint32_t* words, hn::Vec<hn::Half<IndexTag>> index) {
#if HWY_TARGET <= HWY_AVX3
  return {_mm512_i32gather_epi64(index.raw, words, sizeof(std::uint32_t))};
#elif HWY_TARGET == HWY_AVX2
  return {
      _mm256_i32gather_epi64(reinterpret_cast<const long long*>(words), index.raw, sizeof(std::uint32_t))};
#else
  const auto offset = hn::ShiftLeft<2>(hn::PromoteTo(hn::RebindToSigned<PairTag>(), index));
  return hn::GatherOffset(PairTag(), reinterpret_cast<const std::uint64_t*>(words), offset);
#endif
}

/// The words at `index` and behind it, as gather reads them: two by a gather of pairs, four by a load and
/// part of a shuffle for each lane. Either costs less than gathers of each word.
template <int Count>
HWY_INLINE std::array<Bits, Count> gather_words(Words words, Index index, Mask m) {
  static_assert(Count == 2 || Count == 4);
  const hn::Mask<BitsTag> mb = hn::RebindMask(BitsTag(), m.v);
  const hn::Vec<IndexTag> from = hn::IfThenElseZero(hn::RebindMask(IndexTag(), m.v), index.v);
  if constexpr (Count == 2) {
    const auto pairs = [&](auto half) { return hn::BitCast(BitsTag(), gather_pairs(words.data, half)); };
    const hn::Vec<BitsTag> low = pairs(hn::LowerHalf(hn::Half<IndexTag>(), from));
    const hn::Vec<BitsTag> high = pairs(hn::UpperHalf(hn::Half<IndexTag>(), from));
    return {Bits(hn::IfThenElseZero(mb, hn::ConcatEven(BitsTag(), high, low))),
            Bits(hn::IfThenElseZero(mb, hn::ConcatOdd(BitsTag(), high, low)))};
  } else {
    alignas(64) std::int32_t at[pack_width];
    hn::Store(from, IndexTag(), at);
    const auto load = [&](std::size_t lane) {
      return hn::LoadU(hn::FixedTag<std::uint32_t, 4>(), words.data + at[lane]);
    };
    // Lanes k, k + 4, k + 8, ... of one vector become the rows k of a 4x4 transposition in every block.
    const hn::Vec<BitsTag> a = each_block<pack_width>(load, 0, 4);
    const hn::Vec<BitsTag> b = each_block<pack_width>(load, 1, 4);
    const hn::Vec<BitsTag> c = each_block<pack_width>(load, 2, 4);
    const hn::Vec<BitsTag> d = each_block<pack_width>(load, 3, 4);
    const PairTag pair;
    const auto low_ab = hn::BitCast(pair, hn::InterleaveLower(BitsTag(), a, b));
    const auto low_cd = hn::BitCast(pair, hn::InterleaveLower(BitsTag(), c, d));
    const auto word = [&](auto pairs) { return Bits(hn::IfThenElseZero(mb, hn::BitCast(BitsTag(), pairs))); };
    const auto high_ab = hn::BitCast(pair, hn::InterleaveUpper(BitsTag(), a, b));
    const auto high_cd = hn::BitCast(pair, hn::InterleaveUpper(BitsTag(), c, d));
    return {word(hn::InterleaveLower(pair, low_ab, low_cd)), word(hn::InterleaveUpper(pair, low_ab, low_cd)),
            word(hn::InterleaveLower(pair, high_ab, high_cd)),
            word(hn::InterleaveUpper(pair, high_ab, high_cd))};
  }
}

/// Whether a small index, 0 or more, is the same in all lanes that are active, and what it is there: 0 where
/// none is. Found by branches, which are predicted: what depends on the value need not wait for the index.
HWY_INLINE bool same_in_all(Index a, Mask active, std::int32_t& value) {
  const hn::Mask<IndexTag> mi = hn::RebindMask(IndexTag(), active.v);
  for (value = 0;; ++value) {
    const hn::Vec<IndexTag> here = hn::Set(IndexTag(), value);
    if (hn::AllFalse(IndexTag(), hn::And(mi, hn::Ne(a.v, here)))) return true;
    if (!hn::AllFalse(IndexTag(), hn::And(mi, hn::Eq(a.v, here)))) return false;
  }
}

} // namespace surfgrad::simd::SURFGRAD_ISA_NAMESPACE

namespace surfgrad {

template <>
struct lanes_of<simd::SURFGRAD_ISA_NAMESPACE::Float> {
  using value = float;
  using mask = simd::SURFGRAD_ISA_NAMESPACE::Mask;
  using index = simd::SURFGRAD_ISA_NAMESPACE::Index;
  using bits = simd::SURFGRAD_ISA_NAMESPACE::Bits;
};

static_assert(LaneScalar<simd::SURFGRAD_ISA_NAMESPACE::Float>);

template <>
inline constexpr int lane_count<simd::SURFGRAD_ISA_NAMESPACE::Float> =
    simd::SURFGRAD_ISA_NAMESPACE::pack_width;

template <>
struct LaneArrays<simd::SURFGRAD_ISA_NAMESPACE::Float> {
  using Float = simd::SURFGRAD_ISA_NAMESPACE::Float;
  using Index = simd::SURFGRAD_ISA_NAMESPACE::Index;
  static HWY_INLINE Float load(const float* from) {
    return hwy::HWY_NAMESPACE::LoadU(simd::SURFGRAD_ISA_NAMESPACE::FloatTag(), from);
  }
  static HWY_INLINE Index load_index(const std::int32_t* from) {
    return hwy::HWY_NAMESPACE::LoadU(simd::SURFGRAD_ISA_NAMESPACE::IndexTag(), from);
  }
  static HWY_INLINE void store(Float a, float* to) {
    hwy::HWY_NAMESPACE::StoreU(a.v, simd::SURFGRAD_ISA_NAMESPACE::FloatTag(), to);
  }
};

} // namespace surfgrad
