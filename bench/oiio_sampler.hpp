#pragma once

#include "lookups.hpp"
#include "slope_pyramid.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace surfgrad::bench {

/// OpenImageIO's TextureSystem reading the same map through its batch interface: a tiled, mip-mapped float
/// file, as its makers advise, all of it in its cache.
class OiioSampler {
 public:
  /// folder  where the map's file may be written
  OiioSampler(const SlopePyramid& map, const std::filesystem::path& folder);
  ~OiioSampler();
  OiioSampler(const OiioSampler&) = delete;
  OiioSampler& operator=(const OiioSampler&) = delete;

  /// Lookups [begin, end), a multiple of 16. Any number of threads may call it.
  void sample(Filtering filtering, const LookupList& lookups, int begin, int end, Samples& results) const;

  [[nodiscard]] static std::string version();

 private:
  struct System;
  std::unique_ptr<System> system_;
};

} // namespace surfgrad::bench
