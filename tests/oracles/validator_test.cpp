// Files that surfgrad writes, before the Khronos glTF validator.

#include "io/file.hpp"
#include "io/model_file.hpp"
#include "io/model_tangents.hpp"
#include "oracles/hard_meshes.hpp"
#include "oracles/oracle.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace surfgrad {
namespace {

using testing::HasSubstr;

/// What the validator finds wrong with the model after tangents were added.
std::string errors_with_tangents(const std::filesystem::path& model) {
  const test::TemporaryFolder folder;
  return test::validator_errors(folder.write("out.glb", io::add_tangents(model).glb));
}

TEST(KhronosValidator, FindsErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::validator_errors(
                  folder.write("a.gltf", "{ \"asset\": { \"version\": \"2.0\" }, \"nodes\": [] }")),
              HasSubstr("EMPTY_ENTITY"));
}

TEST(KhronosValidator, FindsNoErrorInTangentsOfHardMeshes) {
  for (const test::HardMesh& mesh : test::hard_meshes()) {
    if (mesh.name == "wild normals") continue; // which the format forbids before any tangent
    const test::TemporaryFolder folder;
    io::Model model;
    model.meshes = {mesh.mesh};
    model.materials.push_back({.name = "clay"});
    model.objects.push_back({"thing", 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    io::write_model(folder.path() / "in.glb", model);
    EXPECT_EQ(test::validator_errors(folder.path() / "in.glb"), "") << mesh.name;
    EXPECT_EQ(errors_with_tangents(folder.path() / "in.glb"), "") << mesh.name;
  }
}

TEST(KhronosValidator, FindsNoNewErrorInTangentsOfTheSharedMeshes) {
  const std::filesystem::path meshes = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";
  if (!std::filesystem::exists(meshes)) GTEST_SKIP() << "no shared assets at " << meshes;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(meshes)) {
    const std::filesystem::path extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf" && extension != ".obj") continue;
    if (entry.path().stem() == "goathead" || entry.path().stem() == "spot_low_resolution") continue; // no UVs
    ++files;
    SCOPED_TRACE(entry.path().string());
    EXPECT_EQ(errors_with_tangents(entry.path()), "");
  }
  EXPECT_GE(files, 22);
}

} // namespace
} // namespace surfgrad
