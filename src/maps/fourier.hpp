#pragma once

#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace surfgrad::maps {

using Complex = std::complex<double>;

/// Discrete Fourier transforms of one length: X[k] = sum of x[n] exp(-2 pi i k n / length). Any length, at a
/// cost of length log(length).
///
/// An object serves one thread at a time.
class Fourier {
 public:
  explicit Fourier(std::size_t length);
  ~Fourier();
  Fourier(const Fourier&) = delete;
  Fourier& operator=(const Fourier&) = delete;

  /// In place.
  void transform(Complex* line);
  /// The inverse, with its factor 1 / length.
  void inverse(Complex* line);

 private:
  struct Plans;
  std::size_t length_;
  std::unique_ptr<Plans> plans_;
};

/// Cosine transforms of one length, of type II: X[k] = sum of x[n] cos(pi k (n + 1/2) / length), which stand
/// for lines that are reflected at their ends. Being linear and real, a transform of complex numbers is that
/// of two lines at once.
///
/// An object serves one thread at a time.
class Cosine {
 public:
  explicit Cosine(std::size_t length);

  void transform(Complex* line);
  void inverse(Complex* line);

 private:
  std::size_t length_;
  Fourier fourier_;
  std::vector<Complex> turns_; ///< exp(-i pi k / (2 length))
  std::vector<Complex> scratch_;
};

} // namespace surfgrad::maps
