#include "maps/fourier.hpp"

#include <kissfft/kissfft.hh>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace surfgrad::maps {
namespace {

constexpr double pi = std::numbers::pi;

std::size_t largest_prime_factor(std::size_t n) {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; ++p)
    for (; n % p == 0; n /= p) largest = p;
  return std::max(largest, n);
}

// The library sums the parts of a length one by one where their number is a prime above 5: what that costs
// grows with the prime. Beyond this one the detour over two transforms of a length of powers of two is
// shorter.
constexpr std::size_t largest_direct_factor = 31;

Complex product(Complex a, Complex b) {
  // Written out: the operator looks for infinities that are none here.
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// A transform as a convolution (Bluestein 1970): k n = (k^2 + n^2 - (k - n)^2) / 2.
class Chirp {
 public:
  explicit Chirp(std::size_t length)
      : length_(length), padded_(padded_length(length)), forward_(padded_, false), backward_(padded_, true),
        line_(padded_), spectrum_(padded_), filter_(padded_) {
    for (std::size_t n = 0; n < length; ++n)
      // n^2 modulo 2 length: angles stay small, and so exact.
      chirp_.push_back(
          std::polar(1.0, -pi * static_cast<double>(n * n % (2 * length)) / static_cast<double>(length)));
    std::vector<Complex> filter(padded_);
    for (std::size_t n = 0; n < length; ++n)
      filter[n] = filter[(padded_ - n) % padded_] = std::conj(chirp_[n]);
    forward_.transform(filter.data(), filter_.data());
  }

  void transform(const Complex* in, Complex* out) {
    std::fill(line_.begin(), line_.end(), Complex{});
    for (std::size_t n = 0; n < length_; ++n) line_[n] = product(in[n], chirp_[n]);
    forward_.transform(line_.data(), spectrum_.data());
    for (std::size_t k = 0; k < padded_; ++k) spectrum_[k] = product(spectrum_[k], filter_[k]);
    backward_.transform(spectrum_.data(), line_.data());
    const double scale = 1 / static_cast<double>(padded_);
    for (std::size_t k = 0; k < length_; ++k) out[k] = scale * product(line_[k], chirp_[k]);
  }

 private:
  static std::size_t padded_length(std::size_t length) {
    std::size_t padded = 1;
    while (padded < 2 * length - 1) padded *= 2;
    return padded;
  }

  std::size_t length_, padded_;
  kissfft<double> forward_, backward_;
  std::vector<Complex> line_, spectrum_, filter_, chirp_{};
};

} // namespace

struct Fourier::Plans {
  explicit Plans(std::size_t length) : line(length) {
    if (largest_prime_factor(length) > largest_direct_factor)
      chirp.emplace(length);
    else
      direct.emplace(length, false);
  }

  std::optional<kissfft<double>> direct{};
  std::optional<Chirp> chirp{};
  std::vector<Complex> line;
};

Fourier::Fourier(std::size_t length) : length_(length), plans_(std::make_unique<Plans>(length)) {}
Fourier::~Fourier() = default;

void Fourier::transform(Complex* line) {
  std::vector<Complex>& result = plans_->line;
  if (plans_->chirp)
    plans_->chirp->transform(line, result.data());
  else
    plans_->direct->transform(line, result.data());
  std::copy(result.begin(), result.end(), line);
}

void Fourier::inverse(Complex* line) {
  transform(line);
  // Forward with the frequencies the other way round.
  std::reverse(line + 1, line + length_);
  const double scale = 1 / static_cast<double>(length_);
  for (std::size_t n = 0; n < length_; ++n) line[n] *= scale;
}

Cosine::Cosine(std::size_t length) : length_(length), fourier_(length), scratch_(length) {
  for (std::size_t k = 0; k < length; ++k)
    turns_.push_back(std::polar(1.0, -0.5 * pi * static_cast<double>(k) / static_cast<double>(length)));
}

// By a Fourier transform of the same length of the line's even places followed by its odd ones backwards
// (Makhoul 1980). Of a real line with the transform V: X[k] = Re(turn[k] V[k]); V[length - k] is the
// conjugate of V[k], so that (turn[k] V[k] + conj(turn[k]) V[length - k]) / 2 is the same, and linear.

void Cosine::transform(Complex* line) {
  for (std::size_t n = 0; 2 * n < length_; ++n) scratch_[n] = line[2 * n];
  for (std::size_t n = 0; 2 * n + 1 < length_; ++n) scratch_[length_ - 1 - n] = line[2 * n + 1];
  fourier_.transform(scratch_.data());
  for (std::size_t k = 0; k < length_; ++k)
    line[k] = 0.5 * (product(turns_[k], scratch_[k]) +
                     product(std::conj(turns_[k]), scratch_[k == 0 ? 0 : length_ - k]));
}

void Cosine::inverse(Complex* line) {
  // With X[length] = 0: V[k] = conj(turn[k]) (X[k] - i X[length - k]).
  for (std::size_t k = 0; k < length_; ++k) {
    const Complex mirrored = k == 0 ? Complex{} : line[length_ - k];
    scratch_[k] = product(std::conj(turns_[k]), line[k] + Complex{mirrored.imag(), -mirrored.real()});
  }
  fourier_.inverse(scratch_.data());
  for (std::size_t n = 0; 2 * n < length_; ++n) line[2 * n] = scratch_[n];
  for (std::size_t n = 0; 2 * n + 1 < length_; ++n) line[2 * n + 1] = scratch_[length_ - 1 - n];
}

} // namespace surfgrad::maps
