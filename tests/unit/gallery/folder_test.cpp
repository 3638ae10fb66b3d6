// Where the gallery goes, and what a folder that holds part of one shows.

#include "diagnostic/error.hpp"
#include "gallery/gallery.hpp"
#include "support/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace fs = std::filesystem;

namespace surfgrad::gallery {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::vector<Figure>& two_figures() {
  static const std::vector<Figure> figures{{"one", "One", "", {{"a", "", ""}, {"b", "", ""}}},
                                           {"two", "Two", "", {{"a", "", ""}}}};
  return figures;
}

File file(const char* name) { return {name, {std::byte{1}, std::byte{2}}}; }

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(GalleryFolder, IsMadeAndFilled) {
  const test::TemporaryFolder folder;
  const fs::path output = folder.path() / "new";
  check_folder(output);
  EXPECT_THAT(folder.files(), IsEmpty()); // looking leaves nothing behind
  write(output, two_figures(), {file("one-a.png"), file("one-b.png"), file("two-a.png")}, {});
  EXPECT_EQ(fs::file_size(output / "one-b.png"), 2U);
  EXPECT_THAT(text_of(output / "index.html"), HasSubstr("two-a.png"));
  write(output / "", two_figures(), {}, {}); // again, with a slash at the end
}

TEST(GalleryFolder, PageShowsFiguresWhosePicturesAreAllThere) {
  const test::TemporaryFolder folder;
  write(folder.path(), two_figures(), {file("one-a.png"), file("two-a.png")}, {});
  EXPECT_THAT(text_of(folder.path() / "index.html"), Not(HasSubstr("one-a.png"))); // one-b.png is missing
  write(folder.path(), two_figures(), {file("one-b.png")}, {});
  const std::string html = text_of(folder.path() / "index.html");
  EXPECT_THAT(html, HasSubstr("one-a.png"));
  EXPECT_THAT(html, HasSubstr("two-a.png"));
  EXPECT_THAT(folder.files(), ElementsAre("index.html", "one-a.png", "one-b.png", "two-a.png"));
}

TEST(GalleryFolder, PageComesLast) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "one-b.png"); // no picture can be written there
  EXPECT_THROW(write(folder.path(), two_figures(), {file("one-a.png"), file("one-b.png")}, {}), InputError);
  EXPECT_THAT(folder.files(), ElementsAre("one-a.png", "one-b.png"));
}

TEST(GalleryFolder, RefusesFilesAndMissingParents) {
  const test::TemporaryFolder folder;
  folder.write("taken", "text");
  EXPECT_THROW(check_folder(folder.path() / "taken"), InputError);
  EXPECT_THROW(check_folder(folder.path() / "none" / "gallery"), InputError);
  fs::create_directory(folder.path() / "index.html");
  EXPECT_THROW(check_folder(folder.path()), InputError); // the page's name is taken by a folder
}

} // namespace
} // namespace surfgrad::gallery
