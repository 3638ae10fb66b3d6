#include "stage/bands.hpp"

#include "diagnostic/error.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

namespace surfgrad::stage {

BandSink into(image::Image& picture) {
  return [next = picture.texels.end()](const image::Image& band) mutable {
    next -= static_cast<std::ptrdiff_t>(band.texels.size());
    std::copy(band.texels.begin(), band.texels.end(), next);
  };
}

void for_each_band(int count, const Report& report, const std::function<image::Image(int)>& make,
                   const BandSink& take) {
  std::atomic<bool> stop{false};
  int next = count;
  int done = 0;
  // One more than there are threads: none waits while a band is taken.
  const auto under_way = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()) + 1;
  tbb::parallel_pipeline(under_way,
                         tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order,
                                                     [&](tbb::flow_control& control) {
                                                       if (next == 0 || stop) {
                                                         control.stop();
                                                         return 0;
                                                       }
                                                       return --next;
                                                     }) &
                             tbb::make_filter<int, image::Image>(tbb::filter_mode::parallel, make) &
                             tbb::make_filter<image::Image, void>(
                                 tbb::filter_mode::serial_in_order, [&](const image::Image& band) {
                                   if (stop) return;
                                   take(band);
                                   ++done;
                                   if (report.progress && !report.progress(static_cast<double>(done) / count))
                                     stop = true;
                                 }));
  if (stop) throw Cancelled();
}

} // namespace surfgrad::stage
