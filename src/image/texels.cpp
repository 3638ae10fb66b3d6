#include "image/texels.hpp"

#include <algorithm>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace surfgrad::image {
namespace {

template <class Code>
const float* decode(const std::vector<Code>& codes, std::size_t first, std::size_t count, float* scratch) {
  std::transform(codes.data() + first, codes.data() + first + count, scratch,
                 [](Code code) { return from_code(code); });
  return scratch;
}

} // namespace

const float* Texels::read(std::size_t first, std::size_t count, float* scratch) const {
  if (const auto* codes = std::get_if<Codes8>(&values_)) return decode(*codes, first, count, scratch);
  if (const auto* codes = std::get_if<Codes16>(&values_)) return decode(*codes, first, count, scratch);
  return std::get<Floats>(values_).data() + first;
}

void Texels::give_back([[maybe_unused]] std::size_t first, [[maybe_unused]] std::size_t count) {
#ifdef __linux__
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  std::visit(
      [&](auto& values) {
        const auto begin = reinterpret_cast<std::uintptr_t>(values.data() + first);
        const auto end = reinterpret_cast<std::uintptr_t>(values.data() + first + count);
        const std::uintptr_t first_page = (begin + page - 1) / page * page;
        const std::uintptr_t last_page = end / page * page;
        // Advice: where it is not taken, the memory is there until the array goes.
        if (first_page < last_page)
          madvise(reinterpret_cast<void*>(first_page), last_page - first_page, MADV_DONTNEED);
      },
      values_);
#endif
}

Texels::Floats& Texels::floats() {
  if (!std::holds_alternative<Floats>(values_)) {
    Floats values(size());
    (void)read(0, values.size(), values.data());
    values_ = std::move(values);
  }
  return std::get<Floats>(values_);
}

bool operator==(const Texels& a, const Texels& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i]) return false;
  return true;
}

} // namespace surfgrad::image
