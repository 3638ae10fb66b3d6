#pragma once

#include "diagnostic/report.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace surfgrad::io {

struct TangentOptions {
  /// The UV set of every mesh. Without it each takes the one that its normal texture uses, else the first.
  std::optional<std::size_t> uv_set{};
  Report report{};
};

/// A model with MikkTSpace tangents, as the bytes of a .glb file.
struct ModelWithTangents {
  std::vector<std::byte> glb{};
  std::size_t meshes = 0; ///< that have tangents now; a primitive of glTF is a mesh here
  std::size_t triangles = 0;
  std::size_t vertices = 0;
  std::size_t split_vertices = 0;     ///< of these, how many are there because corners of one vertex disagree
  std::size_t replaced = 0;           ///< meshes whose own tangents were replaced
  std::size_t without_uv = 0;         ///< meshes that stay as they are: they have no such UV set
  std::size_t arbitrary_tangents = 0; ///< corners where nothing is left of them: some unit vector
};

/// Reads a model (.gltf, .glb, .obj) and makes the attribute TANGENT of all its triangles:
/// mesh::generate_tangents of what read_model makes of them, so w is +1 where cross(normal, tangent) points
/// up in the texture. That is glTF's convention: v runs down there, and fed with v as it is MikkTSpace gives
/// the opposite w. Morphed meshes get those of their unmorphed shape.
///
/// glTF  All else is kept, known here or not: nodes, materials, images, animations, skins, extensions,
/// extras.
///       Only this changes: buffers become the one of the .glb, and images move into it. Strips and fans
///       become lists of triangles, sparse vertex data become full. Vertices whose corners need different
///       tangents are doubled with all their attributes, behind the others; vertices that no triangle uses
///       go. Meshes without NORMAL get the flat ones that the format prescribes. Tangents of morph targets
///       go: they would be differences to other tangents. Data for decoders of EXT_meshopt_compression and
///       KHR_draco_mesh_compression beside the plain data goes.
/// OBJ   As read_model and encode_model: no materials but their names.
///
/// errors  as read_model; InputError, naming the mesh, where it has no such UV set: any mesh where the set is
///         given, else only if none has one (a warning names those that are left out); for a result
///         beyond 4 GiB. Cancelled.
[[nodiscard]] ModelWithTangents add_tangents(const std::filesystem::path& model,
                                             const TangentOptions& options = {});

/// What can be said of a .glb that is to be written before it is made: InputError for another extension; as
/// check_writable. Call it before long work.
void check_glb_output(const std::filesystem::path& file);

} // namespace surfgrad::io
