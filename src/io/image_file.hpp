#pragma once

#include "image/image.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace surfgrad::io {

// Rows: image::Image keeps row 0 at the bottom; the functions here flip at the edge.
// Values: integers are scaled to [0, 1], floats kept; no gamma, profile or tone curve is applied.

/// Formats that can be written.
enum class ImageFormat { png, tiff, exr };

/// What matters more when a file is written; decoders read both, and the values are the same.
enum class Compression {
  fast,  ///< about a tenth to a third larger than small, and written two to ten times as fast
  small, ///< for files that are kept or sent
};

/// An image but for its texels.
struct ImageShape {
  int width;
  int height;
  int channels;           ///< 1 to 4
  bool has_alpha = false; ///< the last channel is opacity, which only TIFF tells from data
};

[[nodiscard]] inline ImageShape shape_of(const image::Image& image) {
  return {image.width, image.height, image.channels, image.has_alpha};
}

/// Reads PNG, TIFF, OpenEXR, JPEG, Radiance HDR or TGA, decided by the content, not by the name.
///
/// Channels: 1 grey, 2 grey+alpha (or the two channels of an EXR or TIFF), 3 rgb, 4 rgba.
/// Palettes and PNG transparency are expanded. EXR: R,G,B,A, else Y,A, else the first channels up
/// to four, and the data window. Metadata such as EXIF orientation is not applied.
///
/// Throws InputError as read_file and decode_image do, MachineError where memory runs out.
[[nodiscard]] image::Image read_image(const std::filesystem::path& file);

/// The same from memory. `name` serves messages, and lets content without any magic be a TGA.
///
/// Throws InputError where the format is unknown, the content is damaged or truncated, uses a
/// feature that is not supported, or declares sides outside [1, 65536], more than 2^28 texels or
/// more pixel data than its bytes can hold; MachineError where memory runs out.
[[nodiscard]] image::Image decode_image(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// The image as a file in memory: PNG (unorm8, unorm16), TIFF (unorm8, unorm16, float32) or EXR
/// (half, float32).
///
/// Integers: values are clamped to [0, 1] and rounded to the nearest code, NaN becomes 0. Floats
/// are stored as they are; half rounds to nearest even and overflows to infinity. Two channels
/// become grey+alpha in PNG, an unspecified extra sample in TIFF, R and G in EXR.
///
/// Throws InputError where the format cannot hold the depth, or the image has no 1 to 4 channels
/// or a size decode_image would refuse; MachineError where encoding fails or memory runs out.
[[nodiscard]] std::vector<std::byte> encode_image(const image::Image& image, image::Depth depth,
                                                  ImageFormat format,
                                                  Compression compression = Compression::fast);

/// Encodes and writes whole or not at all; the extension decides: .png, .tif, .tiff or .exr.
///
/// Throws InputError for another extension and as encode_image and write_file do; MachineError
/// where the file cannot be written.
void write_image(const std::filesystem::path& file, const image::Image& image, image::Depth depth,
                 Compression compression = Compression::fast);

/// What write_image would refuse before it has an image: extension, depth, missing or unwritable
/// folder. Call it before long work. Throws as write_image does.
void check_image_output(const std::filesystem::path& file, image::Depth depth);

} // namespace surfgrad::io
