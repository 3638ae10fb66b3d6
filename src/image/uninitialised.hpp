#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace surfgrad::image {

/// Memory for arrays as large as maps, whose elements a resize leaves as they are found: who fills all of
/// them anyway, in parallel, spares one thread the way through memory that zeroes would take.
template <class T>
struct Uninitialised {
  static_assert(std::is_trivial_v<T>);
  using value_type = T;

  Uninitialised() = default;
  template <class U>
  Uninitialised(const Uninitialised<U>&) {}

  /// Pages of processors are either 4 KiB or 2 MiB. A first touch of each costs about a microsecond, which
  /// for small ones is as long as filling them.
  static constexpr std::align_val_t large_page{std::size_t{2} << 20};

  [[nodiscard]] T* allocate(std::size_t count) {
    void* memory = ::operator new(count * sizeof(T), alignment(count));
#ifdef __linux__
    // Advice: where it is not taken, pages are small.
    if (alignment(count) == large_page)
      madvise(memory, count * sizeof(T) & ~(static_cast<std::size_t>(large_page) - 1), MADV_HUGEPAGE);
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment(count)); }

  template <class U, class... Arguments>
  void construct(U* element, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) == 0)
      ::new (static_cast<void*>(element)) U; // no initialisation
    else
      ::new (static_cast<void*>(element)) U(std::forward<Arguments>(arguments)...);
  }

  friend bool operator==(const Uninitialised&, const Uninitialised&) { return true; }

 private:
  static std::align_val_t alignment(std::size_t count) {
    const bool large = count * sizeof(T) >= 2 * static_cast<std::size_t>(large_page);
    return large ? large_page : std::align_val_t{alignof(std::max_align_t)};
  }
};

template <class T>
using UninitialisedVector = std::vector<T, Uninitialised<T>>;

} // namespace surfgrad::image
