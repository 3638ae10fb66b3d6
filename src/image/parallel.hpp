#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace surfgrad::image {

/// Runs body(i) for every i below count, on all threads. Each writes to places of its own and reads what
/// none writes, so that the outcome does not depend on who runs what.
///
/// texels_each  about how much work an i is: a task is worth starting for some ten thousand texels
template <class Body>
void in_parallel(std::size_t count, std::size_t texels_each, const Body& body) {
  const std::size_t grain = std::max<std::size_t>(1, 32768 / std::max<std::size_t>(texels_each, 1));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& block) {
                      for (std::size_t i = block.begin(); i != block.end(); ++i) body(i);
                    });
}

} // namespace surfgrad::image
