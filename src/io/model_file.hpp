#pragma once

#include "diagnostic/error.hpp"
#include "diagnostic/report.hpp"
#include "io/model.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace surfgrad::io {

/// What a reader of models may be told.
struct ModelOptions {
  /// Weight i goes to morph target i of every mesh that has one, in place of the file's; targets beyond
  /// the list keep theirs. Finite, of any sign; no more than the mesh with most targets has.
  std::vector<double> morph_weights{};
  /// Asked, with the fraction 0, whether to go on between the images that are decoded.
  Report report{};
};

/// More morph weights than any mesh of the model has targets: a mistake of whoever gives them.
class TooManyWeights : public InputError {
 public:
  using InputError::InputError;
};

/// Reads a glTF 2.0 model (.gltf, .glb) or a Wavefront OBJ. The content decides between the two
/// forms of glTF, the file's extension about OBJ, which has no mark of its own.
///
/// glTF  One mesh a primitive of triangles, strips or fans; points and lines are left out. One object
///       a (node, primitive) of the default scene, else of the first, else of all nodes. Texture
///       coordinates become (u, 1 - v) and KHR_texture_transform follows; TANGENT is kept with its w
///       as the tangent space of the UV set that the normal texture uses, else of the first. Missing
///       normals become flat ones (and TANGENT is dropped, as the format asks); missing materials
///       `default`. Morph targets are applied to positions, normals and TANGENT with the weights of
///       the options, else of the node, else of the mesh; objects of one mesh with different weights get
///       meshes of their own. Skins and animations are ignored: the mesh stands as modelled.
///       Only normal textures' images are read, none outside the model's folder.
/// OBJ   One mesh, one object. Polygons become fans around their first corner; corners are welded by
///       (v, vt, vn). Corners without vn get angle-weighted smooth normals over the positions. A UV
///       set exists as soon as one face has vt; corners without vt are then at (0, 0), where no
///       texture tilts the surface. Materials are the names of usemtl, visible from both sides, for the
///       format knows none; .mtl files are not read.
///
/// errors  InputError names the file, the accessor or line, and what would be right; TooManyWeights;
///         Cancelled where the report asks to stop.
[[nodiscard]] Model read_model(const std::filesystem::path& file, const ModelOptions& options = {});

/// Formats that can be written: the two forms of glTF 2.0.
enum class ModelFormat { glb, gltf };

/// The model as a file in memory; `gltf` holds its buffer as base64. It keeps every mesh with its
/// vertices in their order, every object with its name and transform (sheared ones too, as they are), the
/// names of the materials and whether they are double-sided. Images are not written, nor references
/// to them: a material arrives without its normal texture, for a stack document to dress it by name.
///
/// Texture coordinates become (u, 1 - t); read again they are within 2^-23 * max(1, |t|) of what they were,
/// all else is the same bit for bit. A mesh of several materials is one of several primitives.
/// Tangents are written where the mesh has them for UV set 0 (the format has room for no others): a
/// vertex whose triangles disagree about its tangent is doubled, others follow behind the last.
/// Names that are not UTF-8 get U+FFFD in place of the bytes that are wrong.
///
/// errors  InputError for vertices or transforms that are not finite (named) and for a file above 4 GiB
///         (glb) or 1 GiB (gltf); MachineError where memory runs out; std::invalid_argument for a
///         model that breaks its own promises.
[[nodiscard]] std::vector<std::byte> encode_model(const Model& model, ModelFormat format);

/// Encodes and writes whole or not at all; the extension decides: .glb or .gltf.
///
/// errors  InputError for another extension; as encode_model and write_file
void write_model(const std::filesystem::path& file, const Model& model);

/// What write_model would refuse before it has a model: extension, missing or unwritable folder.
/// Call it before long work. Throws as write_model does.
void check_model_output(const std::filesystem::path& file);

} // namespace surfgrad::io
