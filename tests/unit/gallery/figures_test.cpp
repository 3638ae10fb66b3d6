// Every figure of the gallery as data and as pictures.

#include "diagnostic/error.hpp"
#include "gallery/figures.hpp"
#include "gallery/gallery.hpp"
#include "io/image_file.hpp"
#include "render/render.hpp"
#include "stage/stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace surfgrad::gallery {
namespace {

const Panel* find(const Figure& figure, const std::string& id) {
  for (const Panel& panel : figure.panels)
    if (panel.id == id) return &panel;
  return nullptr;
}

TEST(Figures, HaveNamesThatFilesAndAddressesCanBear) {
  std::set<std::string> names;
  for (const Figure& figure : built_in_figures()) {
    EXPECT_THAT(figure.id, testing::MatchesRegex("[a-z0-9-]+"));
    EXPECT_FALSE(figure.title.empty());
    EXPECT_GT(figure.caption.size(), 40U) << figure.id;
    EXPECT_GE(figure.panels.size(), 2U) << figure.id << " has nothing to be compared with";
    for (const Panel& panel : figure.panels) {
      EXPECT_THAT(panel.id, testing::MatchesRegex("[a-z0-9-]+"));
      EXPECT_FALSE(panel.label.empty()) << figure.id;
      EXPECT_GT(panel.look.size(), 20U) << figure.id << ": says what to look at";
      EXPECT_TRUE(names.insert(picture_name(figure, panel)).second) << picture_name(figure, panel);
    }
  }
}

TEST(Figures, OlderAndWrongWaysNameTheRightOne) {
  for (const Figure& figure : built_in_figures())
    for (const Panel& panel : figure.panels) {
      const bool lesser = panel.way == Way::older || panel.way == Way::wrong;
      EXPECT_EQ(lesser, !panel.against.empty()) << picture_name(figure, panel);
      if (!lesser) continue;
      const Panel* right = find(figure, panel.against);
      ASSERT_NE(right, nullptr) << picture_name(figure, panel) << " names " << panel.against;
      EXPECT_EQ(right->way, Way::right) << picture_name(figure, panel);
    }
}

TEST(Figures, ShowUnitNormalsOnASurfaceThatIsNowhereDegenerate) {
  for (const Figure& figure : built_in_figures())
    for (const Panel& panel : figure.panels) {
      const render::Picture seen =
          render::render(panel.scene(), {.width = 48, .height = 48, .aov = render::Aov::normal});
      // A figure fills a good part of its picture; a culled sheet an eighth of it.
      EXPECT_GT(seen.covered, 48 * 48 / 12) << picture_name(figure, panel);
      EXPECT_EQ(seen.degenerate, 0) << picture_name(figure, panel);
      std::int64_t unit = 0;
      for (std::size_t i = 0; i < seen.image.texels.size(); i += 3) {
        const image::Texels& n = seen.image.texels;
        // Normalised in float: 3 eps (normalize_or_zero).
        if (std::abs(std::hypot(double(n[i]), double(n[i + 1]), double(n[i + 2])) - 1) < 3.6e-7) ++unit;
      }
      EXPECT_EQ(unit, seen.covered) << picture_name(figure, panel);
    }
}

/// Mean difference in codes of 255 over the whole picture.
double mean_difference(const image::Image& a, const image::Image& b) {
  if (a.texels.size() != b.texels.size()) return NAN;
  double sum = 0;
  for (std::size_t i = 0; i < a.texels.size(); ++i)
    sum += std::abs(static_cast<double>(a.texels[i]) - static_cast<double>(b.texels[i]));
  return 255 * sum / static_cast<double>(a.texels.size());
}

// A quarter to a half of a picture is background. A mean of two codes over all of it is a difference of
// about four on the surface, where shading differs by tens in some places and by nothing in others.
constexpr double seen_at_a_glance = 2.0;

TEST(Figures, DifferAtAGlanceWhereOneIsOlderOrWrongAndAgreeWhereTheyShould) {
  const std::vector<Figure> figures = built_in_figures();
  std::map<std::string, image::Image> pictures;
  for (const File& file : draw(figures, {.width = 64, .height = 64, .samples = 2}).pictures)
    pictures[file.name] = io::decode_image(file.bytes, file.name);
  double least = 255;
  std::string where;
  for (const Figure& figure : figures)
    for (const Panel& panel : figure.panels) {
      if (panel.against.empty()) continue;
      const double difference =
          mean_difference(pictures.at(picture_name(figure, panel)),
                          pictures.at(picture_name(figure, *find(figure, panel.against))));
      EXPECT_GT(difference, seen_at_a_glance) << picture_name(figure, panel);
      if (difference < least) {
        least = difference;
        where = picture_name(figure, panel);
      }
    }
  std::printf("  least difference %.2f codes: %s\n", least, where.c_str());

  const auto differ = [&](const std::string& a, const std::string& b) {
    return mean_difference(pictures.at(a), pictures.at(b));
  };
  // Choices are to be told apart, too, if on a part of the surface; but for maps that agree about what
  // is flat, and heights that grow with their object.
  for (const Figure& figure : figures) {
    if (figure.id == "blending-flat" || figure.id == "scaled-heights") continue;
    for (const Panel& a : figure.panels)
      for (const Panel& b : figure.panels) {
        if (a.way != Way::choice || b.way != Way::choice || !(a.id < b.id)) continue;
        const std::string pair[] = {picture_name(figure, a), picture_name(figure, b)};
        EXPECT_GT(differ(pair[0], pair[1]), seen_at_a_glance / 2) << pair[0] << " " << pair[1];
      }
  }
  // Two frames for the same map; two spaces of the same shape (one baked through a tangent space and
  // 16-bit codes, then filtered as slopes instead of directions).
  EXPECT_LT(differ("bases-vertex.png", "bases-derived.png"), 0.5);
  EXPECT_LT(differ("spaces-tangent.png", "spaces-object.png"), 0.7);
  EXPECT_LT(differ("morphing-derived.png", "morphing-recomputed.png"), 1.0);
  // A flat layer changes nothing but by its own code: 32768 / 65535 is not quite one half.
  EXPECT_LT(differ("blending-flat-surface-gradient.png", "blending-flat-whiteout.png"), 0.02);
  EXPECT_LT(differ("blending-flat-surface-gradient.png", "blending-flat-reoriented.png"), 0.02);
}

TEST(Figures, OcclusionIsThePictureOfTheDisplacedMeshAwayFromItsBorder) {
  std::vector<Figure> figures = built_in_figures();
  const auto parallax = std::ranges::find(figures, "parallax", &Figure::id);
  ASSERT_NE(parallax, figures.end());
  // The middle of the picture: stones of two courses, seen whole.
  const auto middle_of = [&](const char* id) {
    const scene::Scene scene = find(*parallax, id)->scene();
    const image::Image all = render::render(scene, {.width = 96, .height = 96, .samples = 2}).image;
    image::Image part = image::make_image(40, 30, 3);
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x)
        for (int c = 0; c < 3; ++c) part.at(x, y, c) = all.at(28 + x, 33 + y, c);
    return part;
  };
  const image::Image displaced = middle_of("displaced");
  const auto apart = [&](const char* id) {
    const double difference = mean_difference(middle_of(id), displaced);
    std::printf("  %-9s %.2f codes\n", id, difference);
    return difference;
  };
  const double occlusion = apart("occlusion");
  // All of it lies in the joints, a pixel wide: parallax reads their heights from the mip level of a pixel,
  // the mesh from the finest; and it takes the sheet for flat over the way of a ray.
  EXPECT_LT(occlusion, 2.5);
  for (const char* other : {"bump", "offset", "limited"}) EXPECT_GT(apart(other), 3 * occlusion) << other;
}

TEST(Figures, HeightsInUnitsOfTheObjectGrowWithIt) {
  std::vector<Figure> figures = built_in_figures();
  const auto scaled = std::ranges::find(figures, "scaled-heights", &Figure::id);
  ASSERT_NE(scaled, figures.end());
  const auto picture = [&](const char* id) {
    return render::render(find(*scaled, id)->scene(), {.width = 64, .height = 64, .samples = 2}).image;
  };
  const image::Image small = picture("small");
  // The frame grows with the ball by a power of two: but for rounding it is the same computation.
  EXPECT_LT(mean_difference(picture("object"), small), 0.01);
  EXPECT_GT(mean_difference(picture("scene"), small), seen_at_a_glance);
}

/// Whether a pixel is background, or one of its eight neighbours is.
bool at_the_outline(const image::Image& coverage, int x, int y) {
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, coverage.height - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, coverage.width - 1); ++i)
      if (coverage.at(i, j, 0) == 0 && coverage.at(i, j, 1) == 0 && coverage.at(i, j, 2) == 0) return true;
  return false;
}

TEST(Figures, DecalsAreSeenWhole) {
  const std::vector<Figure> figures = built_in_figures();
  const auto found =
      std::find_if(figures.begin(), figures.end(), [](const Figure& f) { return f.id == "decals"; });
  ASSERT_NE(found, figures.end());
  constexpr int size = 96;
  const render::Options normals{.width = size, .height = size, .aov = render::Aov::normal};
  for (const Panel& panel : found->panels) {
    scene::Scene scene = panel.scene();
    const image::Image with = render::render(scene, normals).image;
    scene.materials[0].layers.clear();
    const image::Image without = render::render(scene, normals).image;
    int changed = 0;
    int at_outline = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        double difference = 0;
        for (int c = 0; c < 3; ++c)
          difference = std::max(difference, std::abs(double(with.at(x, y, c)) - double(without.at(x, y, c))));
        if (difference < 0.02) continue; // a degree: nothing that shading shows
        ++changed;
        if (at_the_outline(without, x, y)) ++at_outline;
      }
    EXPECT_GT(changed, size * size / 20) << panel.id;
    EXPECT_EQ(at_outline, 0) << panel.id;
  }
}

TEST(Figures, OnlyThoseThatAreToGoWrongMakeTheStageWarn) {
  // Given tangents that contradict the texture; RNM turns steep details past the horizon.
  const std::set<std::string> expected{"bases-careless.png", "mirrored-wrong.png", "blending-reoriented.png"};
  std::set<std::string> warned;
  for (const Figure& figure : built_in_figures())
    for (const Panel& panel : figure.panels) {
      const scene::Scene scene = panel.scene();
      const auto note = [&](std::string_view) { warned.insert(picture_name(figure, panel)); };
      const stage::Stage stage(scene, {0, 0, 0}, {}, {.warning = note});
    }
  EXPECT_EQ(warned, expected);
}

TEST(Figures, SameBytesOnAnyNumberOfThreads) {
  // Fresh maps each time: they, too, are made by whoever comes first. The first figure bakes one.
  const auto bytes = [](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<std::vector<std::byte>> all;
    for (const File& file :
         draw({built_in_figures().front()}, {.width = 40, .height = 40, .samples = 1}).pictures)
      all.push_back(file.bytes);
    return all;
  };
  const auto one = bytes(1);
  EXPECT_EQ(one, bytes(2));
  EXPECT_EQ(one, bytes(5));
}

TEST(Figures, ProgressNeverRunsBackAndEndsAtOne) {
  std::vector<double> fractions;
  const std::vector<Figure> some{built_in_figures().front()};
  static_cast<void>(draw(some, {.width = 16, .height = 16, .samples = 1}, {.progress = [&](double fraction) {
                           fractions.push_back(fraction);
                           return true;
                         }}));
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1);
}

TEST(Figures, DrawingStopsWhenAskedTo) {
  const std::vector<Figure> some{built_in_figures().front()};
  EXPECT_THROW(static_cast<void>(draw(some, {.width = 16, .height = 16, .samples = 1},
                                      {.progress = [](double) { return false; }})),
               Cancelled);
}

} // namespace
} // namespace surfgrad::gallery
