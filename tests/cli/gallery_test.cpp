// `surfgrad gallery` as its users meet it.

#include "cli/program.hpp"
#include "io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

namespace surfgrad {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::set<std::string> pictures_named_by(const std::string& html) {
  std::set<std::string> names;
  for (std::size_t at = 0; (at = html.find("src=\"", at)) != std::string::npos;) {
    at += 5;
    names.insert(html.substr(at, html.find('"', at) - at));
  }
  return names;
}

TEST(Gallery, HelpNamesTheFiguresAndGivesExamples) {
  const Folder folder;
  const Outcome help = run_program({"gallery", "--help"}, folder.path());
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("Examples:"));
  EXPECT_THAT(help.out, HasSubstr("figure-2"));
}

TEST(Gallery, PageListsEveryPictureAndNothingElse) {
  const Folder folder;
  const Outcome run = run_program({"gallery", "-o", "g", "--size", "24x16"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("wrote g/index.html ("));
  EXPECT_THAT(run.error, IsEmpty());
  EXPECT_THAT(folder.files(), ElementsAre("g"));
  std::set<std::string> written;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "g"))
    written.insert(entry.path().filename());
  EXPECT_EQ(written.erase("index.html"), 1U);
  EXPECT_GT(written.size(), 20U);
  EXPECT_EQ(written, pictures_named_by(text_of(folder.path() / "g/index.html")));
  for (const std::string& name : written) {
    const image::Image picture = io::read_image(folder.path() / "g" / name);
    EXPECT_EQ(picture.width, 24);
    EXPECT_EQ(picture.height, 16);
  }
}

TEST(Gallery, OneFigureIsDrawnAnewAndTheOthersStay) {
  const Folder folder;
  const auto draw = [&](const std::string& figure) {
    const Outcome run =
        run_program({"gallery", "-o", "g", "--size", "16", "--only", figure, "--json"}, folder.path());
    EXPECT_EQ(run.status, 0) << run.error;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 1);
    EXPECT_THAT(run.out, HasSubstr("\"figures\":1"));
    EXPECT_THAT(run.out, HasSubstr("\"degenerate_samples\":0"));
  };
  draw("back-faces");
  EXPECT_THAT(text_of(folder.path() / "g/index.html"), Not(HasSubstr("figure-2-a.png")));
  draw("figure-2");
  const std::string page = text_of(folder.path() / "g/index.html");
  EXPECT_THAT(page, HasSubstr("figure-2-a.png"));
  EXPECT_THAT(page, HasSubstr("back-faces-flip.png"));
}

TEST(Gallery, UsageErrorsExitWith2) {
  const Folder folder;
  const std::vector<std::vector<std::string>> wrong{{"gallery"},
                                                    {"gallery", "-o", ""},
                                                    {"gallery", "-o", "g", "--only", "figure-9"},
                                                    {"gallery", "-o", "g", "--only", "models"},
                                                    {"gallery", "-o", "g", "--size", "0"},
                                                    {"gallery", "-o", "g", "--assets", ""},
                                                    {"gallery", "scene.json", "-o", "g"}};
  for (const auto& arguments : wrong) {
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 2) << testing::PrintToString(arguments) << run.error;
    EXPECT_FALSE(run.error.empty());
  }
  const Outcome unknown = run_program({"gallery", "-o", "g", "--only", "figure-9"}, folder.path());
  EXPECT_THAT(unknown.error, HasSubstr("blending")); // says which there are
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(Gallery, FoldersThatCannotBeUsedAreRefusedBeforeTheWork) {
  const Folder folder;
  folder.write("file", "text");
  const std::vector<std::vector<std::string>> wrong{{"gallery", "-o", "file"},
                                                    {"gallery", "-o", "none/g"},
                                                    {"gallery", "-o", "g", "--assets", "none"},
                                                    {"gallery", "-o", "g", "--assets", "file"},
                                                    {"gallery", "-o", "g", "--assets", "."}};
  for (const auto& arguments : wrong) {
    const Outcome run = run_program(arguments, folder.path());
    EXPECT_EQ(run.status, 1) << testing::PrintToString(arguments) << run.error;
    EXPECT_EQ(std::count(run.error.begin(), run.error.end(), '\n'), 1) << run.error;
  }
  EXPECT_THAT(folder.files(), ElementsAre("file"));
}

TEST(Gallery, AnInterruptDuringTheDrawingLeavesNothing) {
  const Folder folder;
  // One thread takes many times as long as the pause.
  Running program({"gallery", "-o", "g", "--size", "1024", "--threads", "1"}, folder.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().signal, SIGINT);
  EXPECT_THAT(folder.files(), IsEmpty());
}

} // namespace
} // namespace surfgrad
