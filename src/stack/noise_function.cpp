#include "stack/noise_function.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {
namespace {

/// A key that says nothing about this function is a slip.
void check_keys(NoiseFunction& noise, const Value& value) {
  const bool sum = noise.function == NoiseKind::fractal_sum || noise.function == NoiseKind::turbulence ||
                   noise.function == NoiseKind::ridged;
  const auto refuse = [&](std::string_view key, std::string_view remedy) {
    if (const Member* member = value.find(key))
      value.member(*member).fail("does not apply to this function", std::string(remedy));
  };
  if (!sum)
    for (const char* key : {"basis", "octaves", "lacunarity", "gain"})
      refuse(key, R"(leave it out, or give "function": "fractal_sum", "turbulence" or "ridged")");
  const bool cells = noise.function == NoiseKind::worley || (sum && noise.basis == NoiseBasis::worley);
  if (!cells)
    refuse("worley", R"(leave it out, or give "function": "worley", or a sum and "basis": "worley")");
}

} // namespace

const Fields<NoiseFunction>& NoiseFunction::fields() {
  // 16 octaves of lacunarity 2 span a factor of 32768: more than a pixel and the object's size differ.
  static const auto table =
      Fields<NoiseFunction>()
          .word("function", &NoiseFunction::function)
          .word("basis", &NoiseFunction::basis)
          .word("worley", &NoiseFunction::worley)
          .integer("octaves", &NoiseFunction::octaves, {.least = 1, .most = 16})
          .number("lacunarity", &NoiseFunction::lacunarity, {.least = 1, .excludes_least = true})
          .number("gain", &NoiseFunction::gain, {.least = 0, .most = 1})
          .number("power", &NoiseFunction::power, {.least = 0, .excludes_least = true})
          .number("frequency", &NoiseFunction::frequency, {.least = 0, .excludes_least = true})
          .vector("offset", &NoiseFunction::offset)
          .finally(check_keys);
  return table;
}

} // namespace surfgrad::stack
