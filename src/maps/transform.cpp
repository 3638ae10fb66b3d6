#include "maps/transform.hpp"

#include "maps/lines.hpp"
#include "maps/plan.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace surfgrad::maps {
namespace {

using Complex = std::complex<double>;

/// One line of a block, and room for its transform.
struct Line {
  explicit Line(std::size_t length) : values(length), spectrum(length) {}
  std::vector<Complex> values;
  std::vector<Complex> spectrum;
};

/// Blocks of lines of complex numbers, each two floats.
void load_pairs(const Lines& lines, const float* values, std::size_t first, std::size_t count,
                LineBlock<Complex>& block) {
  for (std::size_t k = 0; k < lines.length; ++k)
    for (std::size_t l = 0; l < count; ++l) {
      const float* const pair = values + (first + l) * lines.across + k * lines.along;
      block[k][l] = {pair[0], pair[1]};
    }
}
void store_pairs(const Lines& lines, const LineBlock<Complex>& block, std::size_t first, std::size_t count,
                 float* values) {
  for (std::size_t k = 0; k < lines.length; ++k)
    for (std::size_t l = 0; l < count; ++l) {
      float* const pair = values + (first + l) * lines.across + k * lines.along;
      pair[0] = static_cast<float>(block[k][l].real());
      pair[1] = static_cast<float>(block[k][l].imag());
    }
}

void fourier_of_block(LineBlock<Complex>& block, std::size_t count, Plan& plan, Line& line, double scale) {
  for (std::size_t l = 0; l < count; ++l) {
    for (std::size_t k = 0; k < block.length(); ++k) line.values[k] = block[k][l];
    plan.transform(line.values.data(), line.spectrum.data());
    for (std::size_t k = 0; k < block.length(); ++k) block[k][l] = scale * line.spectrum[k];
  }
}

void fourier_both(std::vector<float>& pairs, int width, int height, bool inverse) {
  for (const Axis axis : {Axis::s, Axis::t}) {
    const double scale = inverse ? 1.0 / (axis == Axis::s ? width : height) : 1;
    const Lines lines = lines_of(width, height, axis, 2);
    const Plan shared(lines.length, inverse);
    for_blocks_of_lines(lines, [&](std::size_t first, std::size_t count) {
      Plan plan = shared; // has room of its own
      LineBlock<Complex> block(lines.length);
      Line line(lines.length);
      load_pairs(lines, pairs.data(), first, count, block);
      fourier_of_block(block, count, plan, line, scale);
      store_pairs(lines, block, first, count, pairs.data());
    });
  }
}

/// Where Makhoul's order puts the value of index k: the even ones upwards, then the odd ones downwards.
std::size_t place_of(std::size_t k, std::size_t n) { return k % 2 == 0 ? k / 2 : n - 1 - k / 2; }

/// exp(-i pi k / 2n)
std::vector<Complex> quarter_turns(std::size_t n) {
  std::vector<Complex> turns(n);
  for (std::size_t k = 0; k < n; ++k)
    turns[k] = std::polar(1.0, -std::numbers::pi * static_cast<double>(k) / (2.0 * static_cast<double>(n)));
  return turns;
}

/// Two lines as the real and the imaginary part of one: the parts of its spectrum's symmetric halves.
void cosine_of_block(LineBlock<double>& block, Plan& plan, Line& line, const std::vector<Complex>& turns) {
  const std::size_t n = block.length();
  for (std::size_t l = 0; l < lanes; l += 2) {
    for (std::size_t k = 0; k < n; ++k) line.values[place_of(k, n)] = {block[k][l], block[k][l + 1]};
    plan.transform(line.values.data(), line.spectrum.data());
    for (std::size_t k = 0; k < n; ++k) {
      const Complex v = line.spectrum[k];
      const Complex mirrored = std::conj(line.spectrum[(n - k) % n]);
      block[k][l] = (turns[k] * (0.5 * (v + mirrored))).real();
      block[k][l + 1] = (turns[k] * (Complex(0, -0.5) * (v - mirrored))).real();
    }
  }
}

/// The steps of cosine_of_block backwards. A line's spectrum is turn' * (X[k] - i X[n - k]), of which the
/// part with X[n - k] is what taking the real part left out.
void inverse_cosine_of_block(LineBlock<double>& block, Plan& plan, Line& line,
                             const std::vector<Complex>& turns) {
  const std::size_t n = block.length();
  const double scale = 1.0 / static_cast<double>(n);
  for (std::size_t l = 0; l < lanes; l += 2) {
    for (std::size_t k = 0; k < n; ++k) {
      const double* const back = k > 0 ? block[n - k] : nullptr;
      const Complex a(block[k][l], back ? -back[l] : 0.0);
      const Complex b(block[k][l + 1], back ? -back[l + 1] : 0.0);
      line.spectrum[k] = std::conj(turns[k]) * (a + Complex(0, 1) * b);
    }
    plan.transform(line.spectrum.data(), line.values.data());
    for (std::size_t k = 0; k < n; ++k) {
      const Complex v = line.values[place_of(k, n)];
      block[k][l] = scale * v.real();
      block[k][l + 1] = scale * v.imag();
    }
  }
}

/// transform(block, plan, room, turns) works on a block of lines.
template <class Transform>
void cosine_both(std::vector<float>& values, int width, int height, bool inverse,
                 const Transform& transform) {
  for (const Axis axis : {Axis::s, Axis::t}) {
    const Lines lines = lines_of(width, height, axis);
    const std::vector<Complex> turns = quarter_turns(lines.length);
    const Plan shared(lines.length, inverse);
    for_blocks_of_lines(lines, [&](std::size_t first, std::size_t count) {
      Plan plan = shared; // has room of its own
      LineBlock<double> block(lines.length);
      Line line(lines.length);
      load(lines, values.data(), first, count, block);
      transform(block, plan, line, turns);
      store(lines, block, first, count, values.data());
    });
  }
}

} // namespace

void fourier(std::vector<float>& pairs, int width, int height) { fourier_both(pairs, width, height, false); }

void inverse_fourier(std::vector<float>& pairs, int width, int height) {
  fourier_both(pairs, width, height, true);
}

void cosine(std::vector<float>& values, int width, int height) {
  cosine_both(values, width, height, false, cosine_of_block);
}

void inverse_cosine(std::vector<float>& values, int width, int height) {
  cosine_both(values, width, height, true, inverse_cosine_of_block);
}

} // namespace surfgrad::maps
