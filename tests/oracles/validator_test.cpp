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
#include <vector>

namespace surfgrad {
namespace {

using testing::HasSubstr;

TEST(KhronosValidator, FindsErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::validator_errors(
                  {folder.write("a.gltf", "{ \"asset\": { \"version\": \"2.0\" }, \"nodes\": [] }")}),
              HasSubstr("EMPTY_ENTITY"));
}

TEST(KhronosValidator, FindsNoErrorInTangentsOfHardMeshes) {
  const test::TemporaryFolder folder;
  std::vector<std::filesystem::path> files;
  for (const test::HardMesh& mesh : test::hard_meshes()) {
    if (mesh.name == "wild normals") continue; // which the format forbids before any tangent
    io::Model model;
    model.meshes = {mesh.mesh};
    model.materials.push_back({.name = "clay"});
    model.objects.push_back({"thing", 0, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    const std::filesystem::path plain = folder.path() / (mesh.name + ".glb");
    io::write_model(plain, model);
    files.push_back(plain);
    files.push_back(folder.write(mesh.name + " with tangents.glb", io::add_tangents(plain).glb));
  }
  EXPECT_EQ(test::validator_errors(files), "");
}

TEST(KhronosValidator, FindsNoErrorInTangentsOfTheSharedMeshes) {
  const std::filesystem::path meshes = std::filesystem::path(SURFGRAD_SHARED_DIR) / "assets" / "mesh";
  if (!std::filesystem::exists(meshes)) GTEST_SKIP() << "no shared assets at " << meshes;
  const test::TemporaryFolder folder;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(meshes)) {
    const std::filesystem::path& model = entry.path();
    if (model.extension() != ".glb" && model.extension() != ".gltf" && model.extension() != ".obj") continue;
    if (model.stem() == "goathead" || model.stem() == "spot_low_resolution") continue; // no UVs
    SCOPED_TRACE(model.string());
    files.push_back(folder.write(model.stem().string() + ".glb", io::add_tangents(model).glb));
  }
  EXPECT_GE(files.size(), 22u);
  EXPECT_EQ(test::validator_errors(files), "");
}

} // namespace
} // namespace surfgrad
