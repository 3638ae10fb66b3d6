#include "stack/noise_function.hpp"

#include "stack/fields.hpp"

namespace surfgrad::stack {

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
          .vector("offset", &NoiseFunction::offset);
  return table;
}

} // namespace surfgrad::stack
