#include "diagnostic/error.hpp"
#include "io/encoders.hpp"

#include <fmt/format.h>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <half.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <optional>
#include <stdexcept>
#include <vector>

namespace surfgrad::io::codec {
namespace {

class SinkStream : public Imf::OStream {
 public:
  explicit SinkStream(ByteSink& target) : OStream(""), sink(target) {}

  void write(const char source[], int count) override {
    if (!sink.write(std::as_bytes(std::span(source, static_cast<std::size_t>(count))))) fail();
  }
  std::uint64_t tellp() override { return sink.position(); }
  void seekp(std::uint64_t position) override {
    if (!sink.seek(position)) fail();
  }

  QuietSink sink; ///< the library swallows what fails while it closes a file: check this one

 private:
  [[noreturn]] static void fail() { throw std::runtime_error("cannot write"); }
};

/// The library's exceptions as ours.
template <class Work>
void translate(const SinkStream& stream, const Work& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    stream.sink.check();
    throw MachineError(fmt::format("cannot encode EXR: {}", error.what()));
  }
  stream.sink.check();
}

template <class Sample>
class ExrEncoder : public Encoder {
 public:
  ExrEncoder(const Order& order, Imf::PixelType type, ByteSink& sink)
      : stream_(sink), type_(type), width_(order.shape.width), channels_(order.shape.channels) {
    translate(stream_, [&] {
      Imf::Header header(order.shape.width, order.shape.height);
      header.compression() = Imf::ZIP_COMPRESSION;
      // Level 6 takes three times as long as level 1 to save a twentieth to an eighth.
      header.zipCompressionLevel() = order.compression == Compression::fast ? 1 : 6;
      for (int i = 0; i < channels_; ++i) header.channels().insert(channel_name(i), Imf::Channel(type_));
      constexpr int no_threads = 0; // callers decide about threads, not the library
      file_.emplace(stream_, header, no_threads);
    });
  }

  void encode(Rows& rows) override {
    translate(stream_, [&] {
      // As many as the library packs together: copies of a tall band would double its memory.
      constexpr int rows_a_copy = 16;
      for (int first = 0; first < rows.count(); first += rows_a_copy)
        encode(rows, first, std::min(rows_a_copy, rows.count() - first));
    });
  }

  void finish() override {
    translate(stream_, [&] { file_.reset(); }); // completes the table of offsets
  }

 private:
  [[nodiscard]] const char* channel_name(int channel) const {
    static constexpr std::array<std::array<const char*, 4>, 4> names{
        {{"Y"}, {"R", "G"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
    return names[channels_ - 1][channel];
  }

  void encode(Rows& rows, int first, int count) {
    samples_.clear();
    for (int y = first; y < first + count; ++y)
      for (const float value : rows[y]) samples_.push_back(Sample(value));
    const Imath::Box2i window({0, next_row_}, {width_ - 1, next_row_ + count - 1});
    const std::size_t texel_bytes = sizeof(Sample) * static_cast<std::size_t>(channels_);
    Imf::FrameBuffer source;
    for (int i = 0; i < channels_; ++i)
      source.insert(channel_name(i), Imf::Slice::Make(type_, samples_.data() + i, window, texel_bytes,
                                                      texel_bytes * static_cast<std::size_t>(width_)));
    file_->setFrameBuffer(source);
    file_->writePixels(count);
    next_row_ += count;
  }

  SinkStream stream_;
  Imf::PixelType type_;
  int width_;
  int channels_;
  int next_row_ = 0;
  std::vector<Sample> samples_{};
  std::optional<Imf::OutputFile> file_{};
};

} // namespace

std::unique_ptr<Encoder> make_exr_encoder(const Order& order, ByteSink& sink) {
  if (order.depth == image::Depth::half) return std::make_unique<ExrEncoder<half>>(order, Imf::HALF, sink);
  return std::make_unique<ExrEncoder<float>>(order, Imf::FLOAT, sink);
}

} // namespace surfgrad::io::codec
