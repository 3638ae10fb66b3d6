#include "image/texels.hpp"

#include <algorithm>

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
