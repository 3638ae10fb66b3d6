// What lab.hpp declares.

#include "engine/compose.hpp"
#include "simd/emulated_lanes.hpp"

namespace surfgrad::engine {

template Composition<double> compose(const Program&, const raster::Fragment<double>&, BackFaces,
                                     const Placement&);
template Composition<float> compose(const Program&, const raster::Fragment<float>&, BackFaces,
                                    const Placement&);
template Composition<simd::EmulatedFloat>
compose(const Program&, const raster::Fragment<simd::EmulatedFloat>&, BackFaces, const Placement&);

} // namespace surfgrad::engine
