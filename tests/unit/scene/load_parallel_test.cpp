// The files of a scene are read several at a time: the same scene, the same error, and it can be stopped.

#include "diagnostic/error.hpp"
#include "scene/scene.hpp"
#include "scene_folder.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

namespace surfgrad::scene {
namespace {

/// A stack of as many normal maps as there are names.
std::string stack_of(const std::vector<std::string>& maps, const std::string& mesh = "quad.obj") {
  std::string text = R"({ "surfgrad": 1, "mesh": ")" + mesh + "\",\n  \"layers\": [";
  for (const std::string& map : maps)
    text += (&map == maps.data() ? "\n" : ",\n") + (R"(    { "type": "normal_map", "map": ")" + map + "\" }");
  return text + " ] }";
}

template <class Work>
void for_every_number_of_threads(const Work& work) {
  for (const std::size_t threads : {1, 2, 4})
    for (int again = 0; again < 10; ++again) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      SCOPED_TRACE(std::to_string(threads) + " threads");
      work();
    }
}

std::string error_of(const std::filesystem::path& file) {
  try {
    (void)load_scene(file);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LoadInParallel, GivesTheSameSceneForAnyNumberOfThreads) {
  const test::SceneFolder folder;
  const auto file = folder.write(
      "s.json", stack_of({"maps/a.png", "maps/b.png", "maps/a.png", "./maps/b.png", "maps/own.png"}));
  const Scene first = load_scene(file);
  EXPECT_EQ(first.images.size(), 4u); // a name written in two ways is two names
  for_every_number_of_threads([&] {
    const Scene again = load_scene(file);
    ASSERT_EQ(again.images.size(), first.images.size());
    for (const auto& [name, image] : first.images) EXPECT_EQ(again.image(name).texels, image->texels);
  });
}

TEST(LoadInParallel, OfSeveralErrorsTheFirstOfTheDocumentIsTold) {
  const test::SceneFolder folder;
  // The first is the slowest to be found: the others fail before it is read.
  io::write_image(folder.write("slow.png", ""), image::make_image(700, 700, 3), image::Depth::unorm16);
  std::filesystem::resize_file(folder.write("unused", "").parent_path() / "slow.png", 2000);
  const auto slow =
      folder.write("slow.json", stack_of({"maps/a.png", "slow.png", "gone.png", "maps/b.png", "lost.png"}));
  const auto mesh = folder.write("mesh.json", stack_of({"gone.png", "lost.png"}, "none.obj"));
  for_every_number_of_threads([&] {
    EXPECT_NE(error_of(slow).find("slow.png: (named by slow.json:4: layers[1].map)"), std::string::npos)
        << error_of(slow);
    EXPECT_NE(error_of(mesh).find("none.obj"), std::string::npos) << error_of(mesh);
  });
}

TEST(LoadInParallel, AMistakeInTheDocumentComesBeforeFilesNamedAfterIt) {
  const test::SceneFolder folder;
  const auto file = folder.write("s.json", R"({ "surfgrad": 1, "mesh": "quad.obj",
    "materials": { "sikn": [ { "type": "normal_map", "map": "maps/a.png" } ],
                   "skin": [ { "type": "normal_map", "map": "gone.png" } ] } })");
  for_every_number_of_threads([&] {
    EXPECT_NE(error_of(file).find("no material of this name"), std::string::npos) << error_of(file);
  });
}

TEST(LoadInParallel, AsksBetweenFilesByOneThreadAtATimeAndStopsWhenTold) {
  const test::SceneFolder folder;
  folder.write_gltf(0);
  const auto file =
      folder.write("s.json", stack_of({"maps/a.png", "maps/b.png", "maps/own.png"}, "quad.gltf"));
  for_every_number_of_threads([&] {
    std::atomic<int> inside{0}, asked{0};
    Report report;
    report.progress = [&](double fraction) {
      EXPECT_EQ(++inside, 1);
      EXPECT_EQ(fraction, 0.0);
      ++asked;
      std::this_thread::sleep_for(std::chrono::microseconds(300)); // for another to come in
      --inside;
      return true;
    };
    (void)load_scene(file, report);
    EXPECT_GE(asked, 5); // before the model, its image and three more
    for (int allowed = 0; allowed < asked; ++allowed) {
      std::atomic<int> left{allowed};
      report.progress = [&](double) { return left-- > 0; };
      EXPECT_THROW((void)load_scene(file, report), Cancelled) << allowed;
    }
  });
}

} // namespace
} // namespace surfgrad::scene
