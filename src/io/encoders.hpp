#pragma once

// Internal to src/io: one encoder a format, and what they share. Use io/image_writer.hpp.

#include "image/codes.hpp"
#include "io/byte_sink.hpp"
#include "io/image_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>

namespace surfgrad::io::codec {

/// Some rows of an image, counted as files do: row 0 is the topmost.
class Rows {
 public:
  Rows(const image::Image& image, int bottom, int count) : image_(&image), bottom_(bottom), count_(count) {}

  [[nodiscard]] int count() const { return count_; }
  /// width * channels floats, until another row is asked for.
  [[nodiscard]] std::span<const float> operator[](int from_top) {
    row_.resize(image_->index(image_->width, 0));
    const int y = bottom_ + count_ - 1 - from_top;
    return {image_->texels.read(image_->index(0, y), row_.size(), row_.data()), row_.size()};
  }

 private:
  const image::Image* image_;
  int bottom_;
  int count_;
  std::vector<float> row_{};
};

/// What has been asked for, checked: a shape within the limits of codecs.hpp, a depth the format holds.
struct Order {
  ImageShape shape;
  image::Depth depth;
  Compression compression;
};

/// Turns rows into the bytes of one file as they come, and keeps no more of them than the format packs
/// together. Throws MachineError where the library fails, std::bad_alloc where memory runs out, and
/// what the sink throws. A failed encoder can only be destroyed; it may then still write to the sink.
class Encoder {
 public:
  Encoder() = default;
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  virtual ~Encoder() = default;

  virtual void encode(Rows& rows) = 0;
  /// After the last row.
  virtual void finish() = 0;
};

[[nodiscard]] std::unique_ptr<Encoder> make_png_encoder(const Order& order, ByteSink& sink);
[[nodiscard]] std::unique_ptr<Encoder> make_tiff_encoder(const Order& order, ByteSink& sink);
[[nodiscard]] std::unique_ptr<Encoder> make_exr_encoder(const Order& order, ByteSink& sink);

/// A sink for libraries that no exception may pass through: it is kept and thrown by check().
class QuietSink {
 public:
  explicit QuietSink(ByteSink& sink) : sink_(&sink) {}

  /// False from the first failure on.
  [[nodiscard]] bool write(std::span<const std::byte> bytes) noexcept {
    return attempt([&] {
      sink_->write(bytes);
      if (sink_->position() > size_) size_ = sink_->position();
    });
  }
  [[nodiscard]] bool seek(std::uint64_t position) noexcept {
    return attempt([&] { sink_->seek(position); });
  }
  [[nodiscard]] std::uint64_t position() const { return sink_->position(); }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  void check() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  template <class Work>
  bool attempt(const Work& work) noexcept {
    if (failure_) return false;
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
    }
    return !failure_;
  }

  ByteSink* sink_;
  std::uint64_t size_ = 0;
  std::exception_ptr failure_{};
};

using image::to_codes;

} // namespace surfgrad::io::codec
