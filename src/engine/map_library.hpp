#pragma once

#include "image/cube_map.hpp"
#include "image/height_field.hpp"
#include "image/image.hpp"
#include "image/map.hpp"
#include "image/sampler.hpp"
#include "stack/bump_map.hpp"
#include "stack/map.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace surfgrad::engine {

[[nodiscard]] image::Wrap wrap_of(stack::Wrap wrap);

/// Turns images into sampled maps, each combination once, and counts what was odd about them.
class MapLibrary {
 public:
  using Find = std::function<const image::Image&(const std::filesystem::path&)>;
  using FindExpendable = std::function<image::Image*(const std::filesystem::path&)>;

  /// find        returns the image of a file named in a layer; it stays alive until the map is made
  /// document    what messages say named the files; may be empty
  /// expendable  returns it if nobody reads it after the layer that asks, and null else: its texels go as
  /// they
  ///             become slopes
  explicit MapLibrary(Find find, std::filesystem::path document = {}, FindExpendable expendable = {})
      : find_(std::move(find)), document_(std::move(document)), expendable_(std::move(expendable)) {}

  // These throw InputError where the image has too few channels.

  /// A tangent-space normal map as slopes; with Filter::normal as it is encoded.
  std::shared_ptr<const image::Map> slopes(const stack::FileName& file, stack::Channels channels,
                                           stack::Green green,
                                           stack::Filter filter = stack::Filter::trilinear);
  /// A derivative map as slopes.
  std::shared_ptr<const image::Map> derivatives(const stack::FileName& file,
                                                const stack::DerivativeCode& code, stack::Green green);
  /// One channel's heights, and their slopes in height per whole map.
  std::shared_ptr<const image::Map> heights(const stack::FileName& file, stack::MaskChannel channel);
  std::shared_ptr<const image::Map> height_slopes(const stack::FileName& file, stack::MaskChannel channel,
                                                  image::Wraps wraps);
  /// A cube map of normals: one file of all faces, or six.
  std::shared_ptr<const image::CubeMap> cube(const std::vector<stack::FileName>& files);
  /// An object- or world-space normal map as directions.
  std::shared_ptr<const image::Map> directions(const stack::FileName& file, stack::Green green);
  /// One channel as weights.
  std::shared_ptr<const image::Map> weights(const stack::FileName& file, stack::MaskChannel channel);
  /// One channel as heights within [0, 1], made ready for rays.
  std::shared_ptr<const image::TwoSidedField> relief(const stack::FileName& file, stack::MaskChannel channel);

  /// A normal map with texels that point into the surface (z <= 0), which no height field has.
  struct InwardTexels {
    std::filesystem::path file;
    std::int64_t count;
    std::int64_t of;
  };
  [[nodiscard]] const std::vector<InwardTexels>& inward_texels() const { return inward_; }

 private:
  /// The map of this name, made when it is first asked for, of at most so many components.
  template <class Make>
  std::shared_ptr<const image::Map> made_once(const std::string& kind, const stack::FileName& file,
                                              int components, const Make& make);
  /// Who named a file, for a message about it.
  [[nodiscard]] std::string named_by(const stack::FileName& file) const;
  void require_size(const image::Image& image, int most_texels, int components,
                    const stack::FileName& file) const;
  void require_channel(const image::Image& image, stack::MaskChannel channel,
                       const stack::FileName& file) const;
  void require_channels(const image::Image& image, int least, const stack::FileName& file,
                        const char* what) const;

  /// What gives an image's rows back once they are read, if nobody else reads it. Only for the one map that
  /// its layer makes of it.
  [[nodiscard]] image::RowsRead giving_back(const std::filesystem::path& file) const;

  Find find_;
  std::filesystem::path document_;
  FindExpendable expendable_;
  std::map<std::string, std::shared_ptr<const image::Map>> maps_;
  std::map<std::vector<std::filesystem::path>, std::shared_ptr<const image::CubeMap>> cubes_;
  std::map<std::string, std::shared_ptr<const image::TwoSidedField>> reliefs_;
  std::vector<InwardTexels> inward_;
};

} // namespace surfgrad::engine
