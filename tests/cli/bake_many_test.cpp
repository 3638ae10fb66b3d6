// Many scenes in one call of `surfgrad bake`, in several calls that share them, and again.

#include "cli/program.hpp"
#include "io/image_file.hpp"
#include "support/file_size_limit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace surfgrad {
namespace {

namespace fs = std::filesystem;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Scenes of a quad, each bumped differently: a.json, b.json ...
std::vector<std::string> write_scenes(const Folder& folder, int count) {
  folder.write("q.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    names.push_back(std::string(1, static_cast<char>('a' + i)) + ".json");
    folder.write(names.back(),
                 R"({ "surfgrad": 1, "mesh": "q.obj", "layers": [{ "type": "noise", "scale": 0.0)" +
                     std::to_string(i + 1) + " }] }");
  }
  return names;
}

/// A mesh in the tiles 1001, 1002, 1011 and 1012 under a map of two by two texels.
void write_udim_scene(const Folder& folder) {
  folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                        "vt 0.5 0.5\nvt 1.5 0.5\nvt 1.5 1.5\nvt 0.5 1.5\nf 1/1 2/2 3/3 4/4\n");
  folder.write("u.json", R"({ "surfgrad": 1, "mesh": "m.obj",
    "layers": [{ "type": "normal_map", "map": "map.png" }] })");
  image::Image map = image::make_image(2, 2, 3, image::Depth::unorm8);
  map.texels = {0.5f, 0.5f, 1, 0.7f, 0.5f, 0.9f, 0.5f, 0.3f, 0.9f, 0.4f, 0.4f, 0.9f};
  io::write_image(folder.path() / "map.png", map, image::Depth::unorm8);
}

Outcome bake(const Folder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "bake");
  arguments.insert(arguments.end(), {"--size", "32"});
  return run_program(arguments, folder.path());
}

/// Runs it quietly and for machines.
nlohmann::json summary(const Folder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--json", "-q"});
  const Outcome run = bake(folder, std::move(arguments));
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.error, IsEmpty());
  return nlohmann::json::parse(run.out);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// Every file of a folder and what it holds.
std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> result;
  for (const std::string& name : names_in(folder)) result[name] = text_of(folder / name);
  return result;
}

TEST(BakeMany, NamesTheMapsAfterTheScenes) {
  const Folder folder;
  write_scenes(folder, 2);
  const auto told = summary(folder, {"a.json", "b.json", "--out-dir", "deep/out"});
  EXPECT_THAT(names_in(folder.path() / "deep/out"), ElementsAre("a_normal.png", "b_normal.png"));
  EXPECT_EQ(told["scenes"][1]["scene"], "b.json");
  EXPECT_EQ(told["scenes"][1]["output"], "deep/out/b_normal.png");
  // As each alone.
  summary(folder, {"b.json", "-o", "alone.png"});
  EXPECT_EQ(text_of(folder.path() / "alone.png"), text_of(folder.path() / "deep/out/b_normal.png"));
  EXPECT_NE(text_of(folder.path() / "alone.png"), text_of(folder.path() / "deep/out/a_normal.png"));
  // Other outputs are named alike.
  summary(folder, {"a.json", "b.json", "-o", "<NAME>_n.png", "--gltf", "<NAME>.glb", "--roughness",
                   "<NAME>_r.png", "--samples", "2", "--out-dir", "all"});
  EXPECT_THAT(names_in(folder.path() / "all"),
              ElementsAre("a.glb", "a_n.png", "a_r.png", "b.glb", "b_n.png", "b_r.png"));
}

TEST(BakeMany, NamesThatDoNotTellTheScenesApartAreRefused) {
  const Folder folder;
  write_scenes(folder, 2);
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    const Outcome run = bake(folder, std::move(arguments));
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.error, HasSubstr(why));
  };
  refused({"a.json", "b.json", "-o", "n.png"}, "--output: \"n.png\" would be written 2 times");
  refused({"a.json", "b.json", "--out-dir", "o", "--gltf", "n.glb"}, "--gltf: \"n.glb\" would be written 2");
  refused({"a.json", "./a.json", "--out-dir", "o"}, "would be written for a.json and for ./a.json");
  refused({"a.json", "b.json"}, "--output or --out-dir");
  EXPECT_THAT(folder.files(), ElementsAre("a.json", "b.json", "q.obj"));
}

TEST(BakeMany, WhatFailsIsToldAtTheEndAndTheRestIsDone) {
  const Folder folder;
  write_scenes(folder, 3);
  folder.write("b.json", "{ \"surfgrad\": 2 }");
  const Outcome run = bake(folder, {"a.json", "b.json", "c.json", "none.json", "--out-dir", "o", "-q"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(names_in(folder.path() / "o"), ElementsAre("a_normal.png", "c_normal.png"));
  EXPECT_THAT(run.error, HasSubstr("b.json:1: "));
  EXPECT_THAT(run.error, HasSubstr("none.json: no such file"));
  EXPECT_TRUE(run.error.ends_with("surfgrad: 2 of 4 scenes failed\n")) << run.error;
  const Outcome told = bake(folder, {"a.json", "b.json", "--out-dir", "o", "--json"});
  EXPECT_THAT(std::string(nlohmann::json::parse(told.out)["scenes"][1]["error"]), HasSubstr("b.json:1: "));
  // What one scene alone cannot write.
  fs::create_directory(folder.path() / "o" / "taken.png");
  folder.write("taken.json", text_of(folder.path() / "a.json"));
  const Outcome taken = bake(folder, {"taken.json", "c.json", "-o", "<NAME>.png", "--out-dir", "o"});
  EXPECT_EQ(taken.status, 1);
  EXPECT_THAT(taken.error, HasSubstr("taken.png: is a folder"));
  EXPECT_TRUE(fs::is_regular_file(folder.path() / "o" / "c.png"));
}

TEST(BakeMany, FullDiskFailsTheMapsThatDoNotFitAndLeavesTheOldOnes) {
  const Folder folder;
  write_scenes(folder, 2);
  folder.write("flat.json", R"({ "surfgrad": 1, "mesh": "q.obj", "layers": [] })");
  summary(folder, {"a.json", "-o", "a_normal.png"});
  const std::string old = text_of(folder.path() / "a_normal.png");
  summary(folder, {"flat.json", "-o", "flat_normal.png", "--padding", "0"});
  ASSERT_LT(fs::file_size(folder.path() / "flat_normal.png"), old.size());
  fs::remove(folder.path() / "flat_normal.png");
  Outcome run;
  {
    const test::FileSizeLimit limit(old.size() - 1);
    run = bake(folder, {"a.json", "flat.json", "--out-dir", ".", "-q", "--padding", "0"});
  }
  EXPECT_EQ(run.status, 3);
  EXPECT_THAT(run.error, HasSubstr("a.json: ./a_normal.png: cannot write"));
  EXPECT_THAT(run.error, HasSubstr("1 of 2 scenes failed"));
  EXPECT_EQ(text_of(folder.path() / "a_normal.png"), old);
  EXPECT_THAT(folder.files(),
              ElementsAre("a.json", "a_normal.png", "b.json", "flat.json", "flat_normal.png", "q.obj"));
  // A device is no place for a file that appears whole or not at all.
  const Outcome device = bake(folder, {"flat.json", "-o", "/dev/full", "--depth", "8"});
  EXPECT_EQ(device.status, 1);
  EXPECT_THAT(device.error, HasSubstr("/dev/full: "));
}

TEST(BakeIfChanged, LeavesAloneWhatIsThereAsItWasMade) {
  const Folder folder;
  write_udim_scene(folder);
  folder.write("o.json", R"({ "surfgrad": 1, "mesh": "m.obj", "layers": [
    { "type": "normal_map", "map": "map.png", "scale": 0.5 }, { "type": "normal_map", "map": "map.png" }] })");
  const std::vector<std::string> command{"o.json", "-o",          "n.png", "--if-changed", "--samples",
                                         "2",      "--roughness", "r.png", "--gltf",       "m.glb"};
  const auto is_baked = [&](std::vector<std::string> arguments) {
    return !summary(folder, std::move(arguments)).contains("unchanged");
  };
  EXPECT_TRUE(is_baked(command));
  const auto made = contents(folder.path());
  EXPECT_TRUE(made.contains("n.png.bake-record"));
  EXPECT_FALSE(is_baked(command));
  const auto with = [&](const std::string& option, const std::string& value) {
    std::vector<std::string> changed = command;
    changed.insert(changed.end(), {option, value});
    return changed;
  };
  EXPECT_FALSE(is_baked(with("--threads", "1")));
  EXPECT_TRUE(is_baked(with("--padding", "3")));
  EXPECT_TRUE(is_baked(command));
  // Each file that it was made from or that it made.
  for (const std::string name : {"o.json", "m.obj", "map.png", "n.png", "r.png", "m.glb"}) {
    if (name == "map.png") {
      image::Image map = io::read_image(folder.path() / name);
      map.texels = {0.5f, 0.5f, 1, 0.7f, 0.5f, 0.9f, 0.5f, 0.3f, 0.9f, 0.4f, 0.4f, 0.8f};
      io::write_image(folder.path() / name, map, image::Depth::unorm8);
    } else {
      std::ofstream(folder.path() / name, std::ios::app) << "\n";
    }
    EXPECT_TRUE(is_baked(command)) << name;
    EXPECT_FALSE(is_baked(command)) << name;
  }
  fs::remove(folder.path() / "r.png");
  EXPECT_TRUE(is_baked(command));
  // Another scene of the same content is another job.
  folder.write("p.json", text_of(folder.path() / "o.json"));
  std::vector<std::string> other = command;
  other[0] = "p.json";
  EXPECT_TRUE(is_baked(other));
}

TEST(BakeIfChanged, BakesAnewBesideARecordThatCannotBeRead) {
  const Folder folder;
  write_scenes(folder, 1);
  for (const std::string record :
       {"", "{", "[1, 2]", R"({ "job": 3 })", R"({ "job": {}, "inputs": 1 })", "\xff\xfe"}) {
    summary(folder, {"a.json", "-o", "n.png", "--if-changed"});
    const std::string whole = text_of(folder.path() / "n.png.bake-record");
    folder.write("n.png.bake-record", record);
    const Outcome run = bake(folder, {"a.json", "-o", "n.png", "--if-changed"});
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.out, HasSubstr("wrote n.png")) << record;
    EXPECT_EQ(text_of(folder.path() / "n.png.bake-record"), whole);
    const bool is_of_another_job = record.starts_with("{ \"job\"");
    if (!is_of_another_job) {
      EXPECT_THAT(run.error, HasSubstr("n.png.bake-record: is no record of a bake; baking anew")) << record;
    }
  }
  fs::remove(folder.path() / "n.png.bake-record");
  fs::create_directory(folder.path() / "n.png.bake-record");
  const Outcome run = bake(folder, {"a.json", "-o", "n.png", "--if-changed"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("n.png.bake-record: is a folder"));
}

TEST(BakeIfChanged, GoesOnAfterAKillWithWhatIsNotDone) {
  const Folder folder;
  std::vector<std::string> command = write_scenes(folder, 6);
  command.insert(command.end(), {"--out-dir", "o", "--if-changed", "--size", "800"});
  const fs::path out = folder.path() / "o";
  std::vector<std::string> arguments = command;
  arguments.insert(arguments.begin(), "bake");
  Running program(arguments, folder.path());
  while (!program.ended() && !fs::exists(out / "b_normal.png.bake-record")) {
  }
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().signal, SIGKILL);
  std::map<std::string, std::string> whole;
  for (const auto& [name, content] : contents(out))
    if (!name.ends_with(".partial")) whole[name] = content; // all that a kill may leave behind
  arguments.insert(arguments.end(), {"--json", "-q"});
  const Outcome again = run_program(arguments, folder.path());
  EXPECT_EQ(again.status, 0) << again.error;
  const auto scenes = nlohmann::json::parse(again.out)["scenes"];
  EXPECT_TRUE(scenes[0].contains("unchanged"));
  EXPECT_TRUE(scenes[1].contains("unchanged"));
  EXPECT_FALSE(scenes[5].contains("unchanged"));
  for (const auto& [name, content] : whole) EXPECT_EQ(text_of(out / name), content) << name;
  for (const std::string name : {"a", "b", "c", "d", "e", "f"})
    EXPECT_EQ(io::read_image(out / (name + "_normal.png")).width, 800);
}

TEST(BakeShard, SharesTogetherDoTheWhole) {
  const Folder folder;
  write_udim_scene(folder);
  std::vector<std::string> scenes = write_scenes(folder, 3);
  scenes.insert(scenes.begin() + 1, "u.json");
  for (const std::string pattern : {"<NAME>.png", "<NAME>.<UDIM>.png"}) {
    for (const int count : {2, 7}) {
      const auto shard = [&](const std::string& share, const std::string& out) {
        std::vector<std::string> arguments = scenes;
        arguments.insert(arguments.end(), {"-o", pattern, "--out-dir", out, "--shard", share});
        return summary(folder, arguments);
      };
      const std::string id = pattern.size() > 10 ? "t" : "p";
      const std::string all = id + "all" + std::to_string(count);
      shard("1/1", all);
      std::map<std::string, std::string> parts;
      std::size_t largest = 0;
      for (int i = 1; i <= count; ++i) {
        const std::string share = std::to_string(i) + "/" + std::to_string(count);
        const std::string part = id + "part" + std::to_string(i) + "of" + std::to_string(count);
        shard(share, part);
        const auto made = contents(folder.path() / part);
        largest = std::max(largest, made.size());
        for (const auto& [name, content] : made) EXPECT_TRUE(parts.try_emplace(name, content).second) << name;
      }
      const auto whole = contents(folder.path() / all);
      EXPECT_EQ(parts, whole) << pattern << " in " << count;
      EXPECT_LE(largest, whole.size() / static_cast<std::size_t>(count) + 2); // of tiles and of scenes
    }
  }
}

TEST(BakeShard, SharesThatAreNoneAreRefused) {
  const Folder folder;
  write_scenes(folder, 1);
  for (const std::string share :
       {"3/2", "0/2", "1", "1/", "/2", "a/b", "1/0", "-1/2", "1/2/3", "1.5/2", ""}) {
    const Outcome run = bake(folder, {"a.json", "-o", "n.png", "--shard", share});
    EXPECT_EQ(run.status, 2) << share;
    EXPECT_THAT(run.error, HasSubstr("--shard: \"" + share + "\" is no share of the work")) << share;
    EXPECT_THAT(folder.files(), ElementsAre("a.json", "q.obj"));
  }
}

TEST(BakeShard, ScriptForAJobArrayDoesTheWhole) {
  const Folder folder;
  write_udim_scene(folder);
  write_scenes(folder, 3);
  summary(folder, {"a.json", "b.json", "c.json", "u.json", "-o", "<NAME>.<UDIM>.png", "--out-dir", "whole"});
  const std::string script = (fs::path(SURFGRAD_SOURCE_DIR) / "examples/job_array/bake.sbatch").string();
  for (const std::string task : {"1", "2", "3"}) {
    const std::string command = "cd '" + folder.path().string() +
                                "' && SURFGRAD='" SURFGRAD_PROGRAM "' SLURM_ARRAY_TASK_ID=" + task + " '" +
                                script + "' 3 ?.json -o '<NAME>.<UDIM>.png' --out-dir array --size 32 -q";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(fs::exists(folder.path() / "array/c.1001.png"), task == "3");
  }
  auto array = contents(folder.path() / "array");
  std::erase_if(array, [](const auto& file) { return file.first.ends_with(".bake-record"); });
  EXPECT_EQ(array, contents(folder.path() / "whole"));
}

TEST(BakeMany, EachFileIsWrittenOnceHoweverItIsSpelled) {
  const Folder folder;
  write_scenes(folder, 1);
  folder.write("a_r.json", text_of(folder.path() / "a.json"));
  fs::create_symlink("a.png", folder.path() / "link.png");
  const auto before = folder.files();
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    const Outcome run = bake(folder, std::move(arguments));
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.error, HasSubstr(why));
    EXPECT_EQ(folder.files(), before);
  };
  refused({"a.json", "-o", "a.png", "--samples", "2", "--roughness", "./a.png"},
          "is already written by --output");
  refused({"a.json", "-o", "a.png", "--samples", "2", "--roughness", "link.png"},
          "is already written by --output");
  refused({"a.json", "-o", "b.png", "--mips", "--roughness", "b_mip1.png"},
          "\"b_mip1.png\" is already written by");
  refused({"a.json", "a_r.json", "-o", "<NAME>.png", "--samples", "2", "--roughness", "<NAME>_r.png"},
          "is already written by --roughness for a.json");
}

TEST(BakeMany, NothingThatIsReadIsReplaced) {
  const Folder folder;
  write_udim_scene(folder);
  folder.write(
      "u.json",
      R"({ "surfgrad": 1, "mesh": "q.obj", "layers": [{ "type": "normal_map", "map": "map.png" }] })");
  write_scenes(folder, 1);
  folder.write("map.json", text_of(folder.path() / "a.json"));
  io::write_image(folder.path() / "base.png", image::make_image(4, 4, 1), image::Depth::unorm8);
  const std::string map = text_of(folder.path() / "map.png");
  const std::string base = text_of(folder.path() / "base.png");
  const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
    const Outcome run = bake(folder, std::move(arguments));
    EXPECT_EQ(run.status, 1) << run.error;
    EXPECT_THAT(run.error, HasSubstr(why));
    EXPECT_EQ(text_of(folder.path() / "map.png"), map);
    EXPECT_EQ(text_of(folder.path() / "base.png"), base);
  };
  refused({"u.json", "-o", "map.png"}, "map.png: would replace a file of the scene");
  refused({"u.json", "map.json", "-o", "<NAME>.png"},
          "map.png: is a file of u.json, and would be written for map.json");
  refused({"a.json", "-o", "base.png", "--mips", "--base-roughness", "base.png"},
          "base.png: would replace a file of the scene");
  refused(
      {"a.json", "-o", "n.png", "--samples", "2", "--roughness", "base.png", "--base-roughness", "base.png"},
      "base.png: would replace a file of the scene");
}

TEST(BakeIfChanged, FollowsLinksAsTheSystemDoes) {
  const Folder folder;
  for (const char* made : {"a", "a/scenes", "a/maps", "b", "b/maps"})
    fs::create_directory(folder.path() / made);
  fs::create_directory_symlink("../a/scenes", folder.path() / "b/link");
  write_udim_scene(folder);
  folder.write("a/scenes/s.json", R"({ "surfgrad": 1, "mesh": "../../m.obj",
    "layers": [{ "type": "normal_map", "map": "../maps/n.png" }] })");
  // Behind the link ".." is a, not b: the same map lies where its name alone leads.
  for (const char* copy : {"a/maps/n.png", "b/maps/n.png"})
    fs::copy_file(folder.path() / "map.png", folder.path() / copy);
  const std::vector<std::string> command{"b/link/s.json", "-o", "n.png", "--if-changed"};
  summary(folder, command);
  EXPECT_TRUE(summary(folder, command).contains("unchanged"));
  image::Image map = io::read_image(folder.path() / "map.png");
  map.texels.floats()[0] = 0.6f;
  io::write_image(folder.path() / "a/maps/n.png", map, image::Depth::unorm8);
  EXPECT_FALSE(summary(folder, command).contains("unchanged"));
  // What is to be verified is baked.
  std::vector<std::string> verified = command;
  verified.emplace_back("--verify");
  EXPECT_TRUE(summary(folder, verified).contains("verified"));
}

TEST(BakeMany, TileThatFailsLeavesTheOthersToBeDone) {
  const Folder folder;
  write_udim_scene(folder);
  fs::create_directory(folder.path() / "n.1002.png");
  const Outcome run = bake(folder, {"u.json", "-o", "n.<UDIM>.png", "--json"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.error, HasSubstr("n.1002.png: is a folder"));
  EXPECT_THAT(run.error, HasSubstr("1 of 4 tiles failed"));
  const auto tiles = nlohmann::json::parse(run.out)["tiles"];
  ASSERT_EQ(tiles.size(), 4u);
  EXPECT_TRUE(tiles[1].contains("error"));
  EXPECT_EQ(tiles[3]["output"], "n.1012.png");
  EXPECT_TRUE(fs::is_regular_file(folder.path() / "n.1012.png"));
}

} // namespace
} // namespace surfgrad
