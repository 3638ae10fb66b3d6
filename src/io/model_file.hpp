#pragma once

#include "io/model.hpp"

#include <filesystem>

namespace surfgrad::io {

/// Reads a glTF 2.0 model (.gltf, .glb) or a Wavefront OBJ. The content decides between the two
/// forms of glTF, the file's extension about OBJ, which has no mark of its own.
///
/// glTF  One mesh a primitive of triangles, strips or fans; points and lines are left out. One object
///       a (node, primitive) of the default scene, else of the first, else of all nodes. Texture
///       coordinates become (u, 1 - v) and KHR_texture_transform follows; TANGENT is kept with its w
///       as the tangent space of the UV set that the normal texture uses, else of the first. Missing
///       normals become flat ones (and TANGENT is dropped, as the format asks); missing materials
///       `default`. Skins, morph targets and animations are ignored: the mesh stands as modelled.
///       Only normal textures' images are read, none outside the model's folder.
/// OBJ   One mesh, one object. Polygons become fans around their first corner; corners are welded by
///       (v, vt, vn). Corners without vn get angle-weighted smooth normals over the positions. A UV
///       set exists as soon as one face has vt; corners without vt are then at (0, 0), where no
///       texture tilts the surface. Materials are the names of usemtl, visible from both sides, for the
///       format knows none; .mtl files are not read.
///
/// errors  InputError names the file, the accessor or line, and what would be right.
[[nodiscard]] Model read_model(const std::filesystem::path& file);

} // namespace surfgrad::io
