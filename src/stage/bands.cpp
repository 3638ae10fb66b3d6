#include "stage/bands.hpp"

#include "diagnostic/error.hpp"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace surfgrad::stage {

void copy_values(const image::Image& image, int bottom, int rows, float* to) {
  const std::size_t count = image.index(0, rows);
  const float* values = image.texels.read(image.index(0, bottom), count, to);
  if (values != to) std::copy_n(values, count, to);
}

void copy_values(const image::Image& image, float* to) { copy_values(image, 0, image.height, to); }

BandSink into(image::Image& picture) {
  return [next = picture.texels.floats().end()](const image::Image& band) mutable {
    next -= static_cast<std::ptrdiff_t>(band.texels.size());
    copy_values(band, &*next);
  };
}

void reshape(image::Image& image, int width, int height, int channels) {
  image.width = width;
  image.height = height;
  image.channels = channels;
  image.depth = image::Depth::float32;
  image.texels.floats().resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                               static_cast<std::size_t>(channels));
}

namespace {

/// Bands that were taken, for those that are to be made: fresh memory costs more than what goes into it.
class Spares {
 public:
  [[nodiscard]] std::shared_ptr<image::Image> get() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (spares_.empty()) return std::make_shared<image::Image>();
    std::shared_ptr<image::Image> spare = std::move(spares_.back());
    spares_.pop_back();
    return spare;
  }
  void give(std::shared_ptr<image::Image> band) {
    const std::lock_guard<std::mutex> lock(mutex_);
    spares_.push_back(std::move(band));
  }

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<image::Image>> spares_;
};

} // namespace

void for_each_band(int count, const Report& report, const BandMaker& make, const BandSink& take) {
  using Band = std::shared_ptr<image::Image>;
  Spares spares;
  std::atomic<bool> stop{false};
  int next = count;
  std::atomic<int> done{0};
  std::mutex reporting;
  const auto ask = [&] { // inside the lock: reports never go back
    if (report.progress && !report.progress(static_cast<double>(done) / count)) stop = true;
  };
  // Whoever finds the callback busy leaves it to a later one.
  const GoOn go_on = [&] {
    if (const std::unique_lock<std::mutex> lock(reporting, std::try_to_lock); lock && !stop) ask();
    if (stop) throw Cancelled();
  };
  // One is taken while others are made. A band is made by several threads: few suffice.
  const std::size_t threads =
      std::min(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
               static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  const std::size_t under_way = std::min<std::size_t>(threads, 3) + 1;
  tbb::parallel_pipeline(
      under_way,
      tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) {
        if (next == 0 || stop) {
          control.stop();
          return 0;
        }
        return --next;
      }) & tbb::make_filter<int, Band>(tbb::filter_mode::parallel, [&](int i) {
        Band band = spares.get();
        make(i, *band, go_on);
        return band;
      }) & tbb::make_filter<Band, void>(tbb::filter_mode::serial_in_order, [&](Band band) {
        if (stop) return;
        take(*band);
        spares.give(std::move(band));
        ++done;
        const std::lock_guard<std::mutex> lock(reporting);
        ask();
      }));
  if (stop) throw Cancelled();
}

} // namespace surfgrad::stage
