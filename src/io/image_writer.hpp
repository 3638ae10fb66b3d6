#pragma once

#include "image/image.hpp"
#include "io/image_file.hpp"

#include <filesystem>
#include <memory>

namespace surfgrad::io {

namespace codec {
class Encoder;
}
class OutputFile;

/// Writes an image band by band, so that no more than a band of it need be in memory. The bytes are
/// those of write_image, whatever the bands.
///
/// The file appears with commit(), whole; without it nothing is left behind and an old file stays as it
/// was. The temporary file beside the target exists as long as the writer does. Any thread may call it,
/// one at a time; it encodes on that thread.
class ImageWriter {
 public:
  /// Throws as write_image does for an image of this shape.
  ImageWriter(const std::filesystem::path& file, const ImageShape& shape, image::Depth depth,
              Compression compression = Compression::fast);
  ImageWriter(const ImageWriter&) = delete;
  ImageWriter& operator=(const ImageWriter&) = delete;
  ~ImageWriter();

  /// Encodes and writes the next rows, from the top of the picture downwards; row 0 of the band is its
  /// bottom row. The second form takes the rows [bottom, bottom + count) of the image it is given.
  ///
  /// Throws MachineError where encoding or writing fails, std::invalid_argument for a band of another
  /// width, channel count or with rows too many. A writer that threw can only be destroyed.
  void write_rows(const image::Image& band);
  void write_rows(const image::Image& image, int bottom, int count);

  /// After the last row. Throws MachineError where writing fails, std::logic_error where rows are missing.
  void commit();

 private:
  std::filesystem::path name_; ///< for messages
  ImageShape shape_;
  int rows_left_;
  std::unique_ptr<OutputFile> file_;
  std::unique_ptr<codec::Encoder> encoder_; ///< destroyed before the file it writes to
};

} // namespace surfgrad::io
