// The page as text: what it names, and that nothing in it can be taken for markup.

#include "gallery/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>

namespace surfgrad::gallery {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> attributes(const std::string& html, const std::string& name) {
  std::vector<std::string> values;
  const std::regex pattern(" " + name + "=\"([^\"]*)\"");
  for (std::sregex_iterator at(html.begin(), html.end(), pattern), end; at != end; ++at)
    values.push_back((*at)[1]);
  return values;
}

std::vector<Figure> two_figures() {
  return {{"one", "One", "First.", {{"a", "A", "See a.", Way::right}, {"b", "B", "See b.", Way::older, "a"}}},
          {"two", "Two", "Second.", {{"a", "A", "See it."}}}};
}

TEST(Page, ShowsEveryPictureOnceInOrderAndNothingElse) {
  const std::string html = page(two_figures(), 64, 48);
  EXPECT_THAT(attributes(html, "src"), ElementsAre("one-a.png", "one-b.png", "two-a.png"));
  EXPECT_THAT(attributes(html, "href"), ElementsAre("#one", "#two", "one-a.png", "one-b.png", "two-a.png"));
  EXPECT_THAT(attributes(html, "alt"), ElementsAre("One: A", "One: B", "Two: A"));
  EXPECT_THAT(html, HasSubstr(R"(width="64" height="48")"));
}

TEST(Page, IsStaticAndStandsAlone) {
  const std::string html = page(two_figures(), 64, 48);
  EXPECT_THAT(html, testing::StartsWith("<!DOCTYPE html>\n"));
  for (const char* foreign : {"<script", "http:", "https:", "@import", "url("})
    EXPECT_THAT(html, Not(HasSubstr(foreign)));
}

TEST(Page, BadgesFollowTheWay) {
  const std::string html = page(two_figures(), 64, 48);
  EXPECT_THAT(html, HasSubstr(R"(<span class="way right">right</span><strong>A</strong>)"));
  EXPECT_THAT(html, HasSubstr(R"(<span class="way older">older way</span><strong>B</strong>)"));
  EXPECT_THAT(html, HasSubstr("<figcaption><strong>A</strong>")); // a choice has none
}

TEST(Page, EscapesWhateverText) {
  EXPECT_EQ(escaped(R"(a<b>&"c'd)"), "a&lt;b&gt;&amp;&quot;c&#39;d");
  const std::string nasty = "\"><script>'&";
  const std::string html = page({{"f", nasty, nasty, {{"p", nasty, nasty}}}}, 8, 8);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&quot;&gt;&lt;script&gt;&#39;&amp;"));
}

TEST(Page, EveryElementThatOpensCloses) {
  const std::string html = page(two_figures(), 64, 48);
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z][a-z0-9]*)[^>]*>");
  for (std::sregex_iterator at(html.begin(), html.end(), tag), end; at != end; ++at) {
    const std::string name = (*at)[2];
    if (name == "meta" || name == "img" || name == "br") continue; // these never close
    if ((*at)[1].length() == 0) {
      open.push_back(name);
    } else {
      ASSERT_FALSE(open.empty());
      ASSERT_EQ(open.back(), name);
      open.pop_back();
    }
  }
  EXPECT_TRUE(open.empty());
}

} // namespace
} // namespace surfgrad::gallery
