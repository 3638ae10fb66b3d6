#pragma once

#include "diagnostic/report.hpp"
#include "image/image.hpp"

#include <functional>

namespace surfgrad::stage {

/// Receives a picture in bands of rows from its top to its bottom, each an image of its own (row 0 its
/// lowest). Never called by two threads at a time.
using BandSink = std::function<void(const image::Image& band)>;

/// Gives an image a size; what it holds stays undefined.
void reshape(image::Image& image, int width, int height, int channels);

/// Puts a picture together again. The picture must have its size already.
[[nodiscard]] BandSink into(image::Image& picture);

/// Copies the values of an image, or of some of its rows.
void copy_values(const image::Image& image, float* to);
void copy_values(const image::Image& image, int bottom, int rows, float* to);

/// To be called now and then by whoever works long, from any thread: throws Cancelled when the progress
/// callback asks to stop.
using GoOn = std::function<void()>;

/// Makes a band. The image to fill is an old band or empty.
using BandMaker = std::function<void(int band, image::Image& image, const GoOn& go_on)>;

/// Makes a picture's bands in parallel and hands them over in order: whoever takes them works while others
/// are made. A few are under way at a time; memory is theirs.
///
/// count      bands; 0 is the lowest
/// make       makes a band; any thread
/// Results do not depend on the number of threads. Throws Cancelled when the progress callback asks to stop.
void for_each_band(int count, const Report& report, const BandMaker& make, const BandSink& take);

} // namespace surfgrad::stage
