// The noise layer's keys: defaults, every value, and what is wrong with bad ones.

#include "diagnostic/error.hpp"
#include "stack_text.hpp"

#include <gtest/gtest.h>

namespace surfgrad::stack {
namespace {

std::string document(const std::string& keys) {
  return "{ \"surfgrad\": 1, \"layers\": [\n{ \"type\": \"noise\"" + (keys.empty() ? "" : ",\n" + keys) +
         " } ] }";
}

NoiseLayer parsed(const std::string& keys) {
  return std::get<NoiseLayer>(parse_stack(document(keys), "stack.json").layers.at(0));
}

TEST(StackNoise, SmallestLayerHasTheDefaults) {
  const NoiseLayer layer = parsed("");
  EXPECT_EQ(layer.noise.function, NoiseKind::perlin);
  EXPECT_EQ(layer.noise.basis, NoiseBasis::perlin);
  EXPECT_EQ(layer.noise.worley, WorleyKind::f1);
  EXPECT_EQ(layer.noise.octaves, 4);
  EXPECT_EQ(layer.noise.lacunarity, 2);
  EXPECT_EQ(layer.noise.gain, 0.5);
  EXPECT_EQ(layer.noise.power, 1);
  EXPECT_EQ(layer.noise.frequency, 1);
  EXPECT_EQ(max_abs(layer.noise.offset), 0);
  EXPECT_EQ(layer.space, Space::object);
  EXPECT_EQ(layer.method, NoiseMethod::surface_gradient);
  EXPECT_FALSE(layer.custom);
}

TEST(StackNoise, EveryKeyArrives) {
  const NoiseLayer layer =
      parsed(R"("function": "turbulence", "basis": "worley", "worley": "f2_minus_f1", "octaves": 16,
                "lacunarity": 1.5, "gain": 1, "power": 0.25, "frequency": 40, "offset": [1, -2, 3],
                "space": "world", "method": "perlin1985", "scale": -2, "opacity": 0.5, "blend": "mix",
                "mask": { "map": "k.png" })");
  test::StackText out;
  out(layer);
  EXPECT_EQ(out.text, R"(noise 4 2 1 octaves 16 1.5 1 power 0.25 frequency 40 offset 1 -2 3
space 1 method 1
scale -2 opacity 0.5 blend 1
k.png uv 0 tile 1 1 rotate 0 offset 0 0 wrap 0 filter 2
channel 0
)");
  EXPECT_EQ(layer.common.line, 2);
  EXPECT_EQ(layer.common.key, "layers[0]");
}

struct Wrong {
  const char* keys;
  const char* message; ///< after the file and the line, which is 3
};

TEST(StackNoise, BadValuesSayWhatWouldBeRight) {
  constexpr Wrong wrong[] = {
      {R"("function": "turbulance")", "layers[0].function: is \"turbulance\"; did you mean \"turbulence\"? "
                                      "expected one of: perlin, simplex, "
                                      "worley, fractal_sum, turbulence, ridged"},
      {R"("basis": "ridged")", "layers[0].basis: is \"ridged\"; expected one of: perlin, simplex, worley"},
      {R"("worley": "second")", "layers[0].worley: is \"second\"; expected one of: f1, f2_minus_f1"},
      {R"("method": "bump")", "layers[0].method: is \"bump\"; expected one of: surface_gradient, perlin1985"},
      {R"("octaves": 17)", "layers[0].octaves: is 17; expected a whole number from 1 to 16"},
      {R"("octaves": 2.5)", "layers[0].octaves: is 2.5; expected a whole number from 1 to 16"},
      {R"("lacunarity": 1)", "layers[0].lacunarity: is 1; expected a number greater than 1"},
      {R"("gain": 1.5)", "layers[0].gain: is 1.5; expected a number from 0 to 1"},
      {R"("power": 0)", "layers[0].power: is 0; expected a number greater than 0"},
      {R"("frequency": -1)", "layers[0].frequency: is -1; expected a number greater than 0"},
      {R"("offset": [0, 1])", "layers[0].offset: is an array of 2; expected an array of 3 numbers"},
      {R"("octaves": 3)", "layers[0].octaves: does not apply to this function; leave it out, or give "
                          "\"function\": \"fractal_sum\", \"turbulence\" or \"ridged\""},
      {R"("function": "ridged", "worley": "f1")", "layers[0].worley: does not apply to this function; leave "
                                                  "it out, or give \"function\": \"worley\", or "
                                                  "a sum and \"basis\": \"worley\""},
      {R"("map": "n.png")",
       "layers[0]: unknown key \"map\"; expected one of: type, function, basis, worley, octaves, lacunarity, "
       "gain, power, frequency, offset, space, method, scale, mask, opacity, blend"},
  };
  for (const Wrong& c : wrong) {
    std::string message;
    try {
      static_cast<void>(parsed(c.keys));
    } catch (const InputError& error) {
      message = error.what();
    }
    EXPECT_EQ(message, std::string("stack.json:3: ") + c.message);
  }
}

} // namespace
} // namespace surfgrad::stack
