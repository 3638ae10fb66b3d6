#pragma once

/// Other people's programs, which tell whether results are right. scripts/setup installs them.

#include "mesh/triangle_mesh.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace surfgrad::test {

/// A triangle list with every corner on its own, as mikktspace.mjs reads it.
[[nodiscard]] std::string corners_of(const mesh::TriangleMesh& mesh, std::size_t uv_set);

/// The tangents of the npm package `mikktspace`, one list a file of corners_of. Throws where it fails.
[[nodiscard]] std::vector<std::vector<vec4<float>>> package_tangents(const std::vector<std::string>& meshes);

/// What the Khronos validator finds wrong with glTF files: a line for each error; empty where there is none.
/// One call for many files: it takes longer to start than to judge. Throws where it has not judged all.
[[nodiscard]] std::string validator_errors(const std::vector<std::filesystem::path>& files);

} // namespace surfgrad::test
