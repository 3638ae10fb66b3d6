#include "oiio_sampler.hpp"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/texture.h>

#include <cmath>
#include <stdexcept>

namespace surfgrad::bench {

struct OiioSampler::System {
  OIIO::TextureSystem* textures = OIIO::TextureSystem::create(false);
  OIIO::TextureSystem::TextureHandle* map = nullptr;
  int size = 0;

  ~System() { OIIO::TextureSystem::destroy(textures); }
};

OiioSampler::OiioSampler(const SlopePyramid& map, const std::filesystem::path& folder)
    : system_(std::make_unique<System>()) {
  const int size = map.levels[0].size;
  const std::string file = (folder / "slopes.tx").string();
  OIIO::ImageBuf image(OIIO::ImageSpec(size, size, 2, OIIO::TypeDesc::FLOAT),
                       const_cast<vec2<float>*>(map.levels[0].texels.data())); // it only reads
  OIIO::ImageSpec config;
  config.attribute("maketx:filtername", "box");
  if (!OIIO::ImageBufAlgo::make_texture(OIIO::ImageBufAlgo::MakeTxTexture, image, file, config))
    throw std::runtime_error("OpenImageIO: " + OIIO::geterror());
  OIIO::TextureSystem& textures = *system_->textures;
  textures.attribute("max_memory_MB", 2000.0F);
  system_->map = textures.get_texture_handle(OIIO::ustring(file));
  system_->size = size;
}

OiioSampler::~OiioSampler() = default;

std::string OiioSampler::version() { return OIIO_VERSION_STRING; }

void OiioSampler::sample(Filtering filtering, const LookupList& lookups, int begin, int end,
                         Samples& results) const {
  namespace Tex = OIIO::Tex;
  OIIO::TextureSystem& textures = *system_->textures;
  OIIO::TextureSystem::Perthread* const thread = textures.get_perthread_info();
  OIIO::TextureOptBatch options;
  for (int i = 0; i < Tex::BatchWidth; ++i) {
    options.sblur[i] = options.tblur[i] = options.rblur[i] = 0;
    options.swidth[i] = options.twidth[i] = options.rwidth[i] = 1;
  }
  options.swrap = options.twrap = Tex::Wrap::Periodic;
  options.interpmode = Tex::InterpMode::Bilinear;
  options.anisotropic = anisotropy;
  options.mipmode = filtering == Filtering::bilinear    ? Tex::MipMode::NoMIP
                    : filtering == Filtering::trilinear ? Tex::MipMode::Trilinear
                                                        : Tex::MipMode::Aniso;
  const float texel = 1.0F / static_cast<float>(system_->size);
  const float stretch = filtering == Filtering::anisotropic ? anisotropy : 1;
  alignas(Tex::BatchAlign) float dsdx[Tex::BatchWidth];
  alignas(Tex::BatchAlign) float dtdy[Tex::BatchWidth];
  alignas(Tex::BatchAlign) const float none[Tex::BatchWidth] = {};
  alignas(Tex::BatchAlign) float result[2 * Tex::BatchWidth];
  for (int first = begin; first < end; first += Tex::BatchWidth) {
    for (int i = 0; i < Tex::BatchWidth; ++i) {
      // It blends levels by the width of the footprint, not by its logarithm: this width has the weight
      // that the lod asks for.
      const float width = (1 + lookups.lod[static_cast<std::size_t>(first + i)]) * texel;
      dsdx[i] = stretch * width;
      dtdy[i] = width;
    }
    textures.texture(system_->map, thread, options, Tex::RunMaskOn, lookups.s.data() + first,
                     lookups.t.data() + first, dsdx, none, none, dtdy, 2, result);
    std::copy_n(result, Tex::BatchWidth, results.first.data() + first);
    std::copy_n(result + Tex::BatchWidth, Tex::BatchWidth, results.second.data() + first);
  }
}

} // namespace surfgrad::bench
