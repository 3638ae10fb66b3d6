#pragma once

/// The stack: a JSON document of bump layers, read into structs whose every value is in its range.
/// docs/stack-format.md describes the document, docs/stack.schema.json is its schema.

#include "stack/displace.hpp"
#include "stack/layers/decal.hpp"
#include "stack/layers/derivative_map.hpp"
#include "stack/layers/height_map.hpp"
#include "stack/layers/noise.hpp"
#include "stack/layers/normal_map.hpp"
#include "stack/layers/object_normal_map.hpp"
#include "stack/layers/parallax.hpp"
#include "stack/layers/planar.hpp"
#include "stack/layers/resolve.hpp"
#include "stack/layers/triplanar.hpp"
#include "stack/view.hpp"

#include <map>
#include <variant>
#include <vector>

namespace surfgrad::stack {

/// One alternative a layer kind: this list is what the parser knows.
using Layer = std::variant<NormalMapLayer, DerivativeMapLayer, HeightMapLayer, ObjectNormalMapLayer,
                           NoiseLayer, PlanarLayer, TriplanarLayer, DecalLayer, ParallaxLayer, ResolveLayer>;

/// The layers of one material of the mesh.
struct MaterialLayers {
  int line = 0;      ///< where its list begins
  std::string key{}; ///< e.g. `materials.skin`
  std::vector<Layer> layers{};
};

struct Stack {
  /// Version of the format that this program reads; older ones are read for ever, newer ones refused.
  static constexpr int format_version = 1;
  static constexpr std::string_view format_name = "stack";

  std::filesystem::path file{}; ///< the document, as it was named
  std::optional<FileName> mesh{};
  MorphWeights morph{};
  std::optional<Displace> displace{};
  std::optional<BackFaces> back_faces{}; ///< absent: as the mesh's material says
  bool has_layers = false;               ///< whether the document has `layers`, be it an empty list
  std::vector<Layer> layers{};           ///< for every material that `materials` does not name
  std::map<std::string, MaterialLayers> materials{};
  Camera camera{};
  Lights lights{};

  static const Fields<Stack>& fields();
};

/// Reads a stack document.
///
/// text     the document's bytes: UTF-8 (a byte order mark is allowed), LF or CRLF line ends
/// name     how the user named it, for messages and Stack::file. File names inside stay as written.
/// throws   InputError with the line and the key path for anything that is not a valid document: not
///          JSON, an unknown or repeated key, a wrong type, a value out of range, a newer version.
/// limits   64 levels of nesting and a million values.
[[nodiscard]] Stack parse_stack(std::string_view text, const std::filesystem::path& name);

} // namespace surfgrad::stack
