// Models of a user's folder in the gallery.

#include "diagnostic/error.hpp"
#include "gallery/gallery.hpp"
#include "gallery/models.hpp"
#include "support/temporary_folder.hpp"
#include "unit/scene/scene_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace surfgrad::gallery {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(GalleryModels, ShowThoseWithNormalMapsAndWarnAboutTheUnreadable) {
  const scene::test::SceneFolder files; // holds OBJ files without maps, too
  const auto folder = files.write_gltf(0).parent_path();
  files.write("broken.glb", "no model");
  std::vector<std::string> warnings;
  const Figure figure =
      model_figure(folder, {.warning = [&](std::string_view text) { warnings.emplace_back(text); }});
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("broken.glb")));
  ASSERT_EQ(figure.panels.size(), 2U);
  EXPECT_EQ(figure.panels[0].id, "quad");
  EXPECT_EQ(figure.panels[0].label, "quad.gltf");
  EXPECT_FALSE(figure.panels[0].scene().materials[0].layers.empty());
  EXPECT_TRUE(figure.panels[1].scene().materials[0].layers.empty());
  const Drawn drawn = draw({figure}, {.width = 16, .height = 16, .samples = 1});
  EXPECT_NE(drawn.pictures[0].bytes, drawn.pictures[1].bytes);
  EXPECT_EQ(figures(folder).size(), figures({}).size() + 1);
}

TEST(GalleryModels, RefusesFoldersThatHoldNone) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(static_cast<void>(model_figure(folder.path(), {})), InputError);
  EXPECT_THROW(static_cast<void>(model_figure(folder.path() / "none", {})), InputError);
  EXPECT_THROW(static_cast<void>(model_figure(folder.write("file.obj", "v 0 0 0\n"), {})), InputError);
}

} // namespace
} // namespace surfgrad::gallery
