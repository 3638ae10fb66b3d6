#pragma once

#include <vector>

namespace surfgrad::maps {

// Transforms of whole pictures in place, row by row and column by column, on all threads; the same for any
// number of them. Sides of any length cost about the same a texel. Lines are computed in double and kept as
// floats, so that each number is rounded twice, relative to itself.

/// Discrete Fourier transform: sum over (x, y) of v exp(-2 pi i (x k / width + y l / height)); its inverse
/// has the other sign and divides by the number of texels.
///
/// pairs  the real and the imaginary part of each number
void fourier(std::vector<float>& pairs, int width, int height);
void inverse_fourier(std::vector<float>& pairs, int width, int height);

/// Cosine transform, of pictures that their mirror images continue: sum over (x, y) of
/// v cos(pi k (x + 1/2) / width) cos(pi l (y + 1/2) / height) (type II along both axes), and its inverse.
///
/// source  Makhoul 1980, "A fast cosine transform in one and two dimensions": by a Fourier transform of the
///         same length, of two lines at a time
void cosine(std::vector<float>& values, int width, int height);
void inverse_cosine(std::vector<float>& values, int width, int height);

} // namespace surfgrad::maps
