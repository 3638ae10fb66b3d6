#pragma once

#include <kissfft/kissfft.hh>

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace surfgrad::maps {

/// A Fourier transform of one length or, without the factor 1 / length, its inverse. What it costs grows with
/// length * log(length), whatever the length's factors.
///
/// An object serves one thread at a time; copies are independent.
class Plan {
 public:
  Plan(std::size_t length, bool inverse);

  /// from, to  `length` numbers each, apart
  void transform(const std::complex<double>* from, std::complex<double>* to);

 private:
  /// A transform as a convolution, which two transforms of a length of a power of two do.
  class Chirp {
   public:
    Chirp(std::size_t length, bool inverse);
    void transform(const std::complex<double>* from, std::complex<double>* to);

   private:
    std::size_t length_, padded_;
    kissfft<double> forward_, backward_;
    std::vector<std::complex<double>> chirp_{}, filter_, line_, spectrum_;
  };

  std::optional<kissfft<double>> direct_{};
  std::optional<Chirp> chirp_{};
};

} // namespace surfgrad::maps
