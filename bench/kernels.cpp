#include "kernels.hpp"

#include "image/anisotropy.hpp"
#include "simd/object_scalar.hpp"

#include <surfgrad/gradient.hpp>
#include <surfgrad/resolve.hpp>

#include <hwy/cache_control.h>

namespace surfgrad::bench::SURFGRAD_ISA_NAMESPACE {
namespace {

using T = simd::ObjectScalar;
using V2 = vec2<T>;
using V3 = vec3<T>;

#if SURFGRAD_ISA_IS_PLAIN
void stream(T a, float* to) { store(a, to); }
void fetch_ahead(const float*) {}
#else
HWY_INLINE void fetch_ahead(const float* from) { hwy::Prefetch(from); }
HWY_INLINE void stream(T a, float* to) {
  hwy::HWY_NAMESPACE::Stream(a.v, simd::SURFGRAD_ISA_NAMESPACE::FloatTag(), to);
}
#endif

/// ahead  packs whose loads from memory are asked for before they are needed; 0 leaves it to the processor,
///        which follows streams by itself as long as it sees beyond the work on one pack
template <int ahead, class Pixel>
void for_each_pack(const Planes& planes, int begin, int end, Stores stores, const Pixel& pixel) {
  for (int i = begin; i < end; i += lane_count<T>) {
    const V3 n = pixel([&](int plane) {
      const float* from = planes.in[static_cast<std::size_t>(plane)] + i;
      if (ahead > 0 && stores == Stores::streaming) fetch_ahead(from + ahead * lane_count<T>);
      return load<T>(from);
    });
    if (stores == Stores::streaming) {
      stream(n.x, planes.out[0] + i);
      stream(n.y, planes.out[1] + i);
      stream(n.z, planes.out[2] + i);
    } else {
      store(n.x, planes.out[0] + i);
      store(n.y, planes.out[1] + i);
      store(n.z, planes.out[2] + i);
    }
  }
}

} // namespace

void compose_planes(const Planes& planes, int begin, int end, Stores stores) {
  for_each_pack<6>(planes, begin, end, stores, [](const auto& in) {
    const auto frame = make_frame(V3{in(0), in(1), in(2)}, V3{in(3), in(4), in(5)}, V3{in(6), in(7), in(8)});
    const auto layer = [&](int k) {
      const int at = 9 + 4 * k;
      const auto basis = tangent_basis(frame, V2{in(at), in(at + 1)}, V2{in(at + 2), in(at + 3)});
      return from_tbn(V2{in(21 + 2 * k), in(22 + 2 * k)}, basis.tangent, basis.bitangent);
    };
    return resolve_normal(frame, layer(0) + layer(1) + layer(2));
  });
}

void sum_planes(const Planes& planes, int begin, int end, Stores stores) {
  static_assert(planes_in == 9 * planes_out);
  for_each_pack<0>(planes, begin, end, stores, [](const auto& in) {
    const auto sum_of_nine = [&](int first) {
      T sum = in(first);
      for (int k = 1; k < 9; ++k) sum = sum + in(first + k);
      return sum;
    };
    return V3{sum_of_nine(0), sum_of_nine(9), sum_of_nine(18)};
  });
}

void sample_map(const image::Map& map, const Lookups& lookups, image::Filter filter, int begin, int end) {
  const T one = T(value_t<T>(1));
  for (int i = begin; i < end; i += lane_count<T>) {
    const V2 st{load<T>(lookups.s + i), load<T>(lookups.t + i)};
    const auto texel = image::sample<2>(map, st, load<T>(lookups.lod + i), {}, filter, mask_t<T>(one == one));
    store(texel[0], lookups.first + i);
    store(texel[1], lookups.second + i);
  }
}

void sample_anisotropic(const image::Map& map, const Lookups& lookups, int anisotropy, int begin, int end) {
  const T zero = T(value_t<T>(0));
  const V2 size{T(static_cast<float>(map.width())), T(static_cast<float>(map.height()))};
  for (int i = begin; i < end; i += lane_count<T>) {
    const V2 st{load<T>(lookups.s + i), load<T>(lookups.t + i)};
    const T width = load<T>(lookups.width + i);
    const auto footprint =
        image::footprint_of(V2{constant<T>(anisotropy) * width, zero}, V2{zero, width}, size, anisotropy);
    const auto texel = image::sample<2>(map, st, footprint, {}, mask_t<T>(zero == zero));
    store(texel[0], lookups.first + i);
    store(texel[1], lookups.second + i);
  }
}

void gather_pairs(Words words, const WordPairs& pairs, int begin, int end) {
  const T one = T(value_t<T>(1));
  const mask_t<T> everywhere(one == one);
  for (int i = begin; i < end; i += lane_count<T>) {
    bits_t<T> sum(0U);
    for (int k = 0; k < pairs.count; ++k) {
      const auto two =
          gather_words<2>(words, load_index<T>(pairs.at[static_cast<std::size_t>(k)] + i), everywhere);
      sum = sum + (two[0] + two[1]);
    }
    store(T(index_t<T>(sum)), pairs.sums + i);
  }
}

} // namespace surfgrad::bench::SURFGRAD_ISA_NAMESPACE
