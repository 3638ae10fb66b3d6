#include "maps/transform.hpp"

#include "maps/lines.hpp"
#include "maps/plan.hpp"

#include <cmath>
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

/// Transforms all lines of an axis, of a picture of values of type T. transform(block, lines in it, plan,
/// room) works on a block.
template <class T, class Transform>
void transform_lines(std::vector<T>& values, int width, int height, Axis axis, bool inverse,
                     const Transform& transform) {
  const Lines lines = lines_of(width, height, axis);
  const Plan shared(lines.length, inverse);
  for_blocks_of_lines(lines, [&](std::size_t first, std::size_t count) {
    Plan plan = shared; // has room of its own
    LineBlock<T> block(lines.length);
    Line line(lines.length);
    load(lines, values.data(), first, count, block);
    transform(block, count, plan, line);
    store(lines, block, first, count, values.data());
  });
}

void fourier_of_block(LineBlock<Complex>& block, std::size_t count, Plan& plan, Line& line, double scale) {
  for (std::size_t l = 0; l < count; ++l) {
    for (std::size_t k = 0; k < block.length(); ++k) line.values[k] = block[k][l];
    plan.transform(line.values.data(), line.spectrum.data());
    for (std::size_t k = 0; k < block.length(); ++k) block[k][l] = scale * line.spectrum[k];
  }
}

void fourier_both(std::vector<Complex>& values, int width, int height, bool inverse) {
  for (const Axis axis : {Axis::s, Axis::t}) {
    const double scale = inverse ? 1.0 / (axis == Axis::s ? width : height) : 1;
    transform_lines(values, width, height, axis, inverse,
                    [&](LineBlock<Complex>& block, std::size_t count, Plan& plan, Line& line) {
                      fourier_of_block(block, count, plan, line, scale);
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

template <class Transform>
void cosine_both(std::vector<double>& values, int width, int height, bool inverse,
                 const Transform& transform) {
  for (const Axis axis : {Axis::s, Axis::t}) {
    const std::vector<Complex> turns =
        quarter_turns(static_cast<std::size_t>(axis == Axis::s ? width : height));
    transform_lines(values, width, height, axis, inverse,
                    [&](LineBlock<double>& block, std::size_t, Plan& plan, Line& line) {
                      transform(block, plan, line, turns);
                    });
  }
}

} // namespace

void fourier(std::vector<Complex>& values, int width, int height) {
  fourier_both(values, width, height, false);
}

void inverse_fourier(std::vector<Complex>& values, int width, int height) {
  fourier_both(values, width, height, true);
}

void cosine(std::vector<double>& values, int width, int height) {
  cosine_both(values, width, height, false, cosine_of_block);
}

void inverse_cosine(std::vector<double>& values, int width, int height) {
  cosine_both(values, width, height, true, inverse_cosine_of_block);
}

} // namespace surfgrad::maps
