/// Race: map tools on a map of 4096x4096, against bounds instead of peers.
///
/// Method  Heights become normals and normals heights in memory, files left out. A simple conversion is raced
/// against
///         reading and writing the same files with nothing in between.

#include "io/image_file.hpp"
#include "io/image_writer.hpp"
#include "maps/convert.hpp"
#include "maps/recode.hpp"
#include "race.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

namespace surfgrad::bench {
namespace {

namespace fs = std::filesystem;

/// Waves and noise, as heights.
image::Image make_heights(int side) {
  std::mt19937 random(7);
  image::Image heights = image::make_image(side, side, 1, image::Depth::unorm16);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double phase = 2 * std::numbers::pi / side;
      heights.at(x, y, 0) =
          static_cast<float>(0.5 + 0.3 * std::sin(phase * (5 * x + 3 * y)) * std::sin(phase * 40 * y) +
                             1e-7 * static_cast<double>(random() % 100000));
    }
  return heights;
}

double median_wall(const Result& result) {
  std::vector<double> walls;
  for (const Time& time : result.rounds) walls.push_back(time.wall);
  return median(walls);
}

void race_in_memory(const Request& request, const image::Image& heights, const image::Image& normals) {
  const maps::Form height{.kind = maps::Kind::height};
  for (const int threads : request.threads) {
    const Heat heat{.race = "maps",
                    .title = fmt::format("{}x{} in memory", heights.width, heights.height),
                    .unit = "texel",
                    .items = double{1.0 * heights.width} * heights.height,
                    .threads = threads,
                    .rounds = request.rounds};
    limited_to(threads, [&] {
      const std::vector<Result> results =
          run(heat, {{"height to normal",
                      [&] { return timed([&] { (void)maps::convert(heights, {.from = height}, "h"); }); }},
                     {"normal to height, repeated",
                      [&] { return timed([&] { (void)maps::convert(normals, {.to = height}, "n"); }); }},
                     {"normal to height, clamped", [&] {
                        return timed([&] {
                          (void)maps::convert(normals, {.to = height, .border = maps::Border::clamp}, "n");
                        });
                      }}});
      if (threads != 2 || request.quick) return;
      report_value(heat, "height to normal", median_wall(results[0]), "s", {0.5, true});
      report_value(heat, "normal to height, repeated", median_wall(results[1]), "s", {6, true});
      report_value(heat, "normal to height, clamped", median_wall(results[2]), "s", {6, true});
    });
  }
}

/// As `surfgrad convert` does what changes codes alone: written while it is made.
void convert_file(const fs::path& from, const fs::path& to, const maps::Conversion& conversion) {
  const image::Image map = io::read_image(from);
  const maps::Recoding recoding = maps::Recoding::of(map, conversion, from).value();
  io::ImageWriter writer(to, {map.width, map.height, recoding.channels()}, conversion.depth);
  constexpr int band_rows = 64;
  for (int top = map.height; top > 0; top -= band_rows)
    writer.write_rows(recoding.rows(std::max(0, top - band_rows), std::min(band_rows, top)));
  writer.commit();
}

void race_with_files(const Request& request, const image::Image& normals) {
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("surfgrad_bench_{}", std::random_device{}());
  fs::create_directory(folder);
  const fs::path from = folder / "from.png";
  const fs::path to = folder / "to.png";
  io::write_image(from, normals, image::Depth::unorm8);
  struct Work {
    const char* title;
    maps::Conversion conversion;
  };
  Work flip{"green flip of 8 bits, with files", {.depth = image::Depth::unorm8}};
  flip.conversion.to.green = stack::Green::down;
  for (const Work& work : {flip, Work{"8 to 16 bits, with files", {}}}) {
    const Heat heat{.race = "maps",
                    .title = work.title,
                    .unit = "texel",
                    .items = double{1.0 * normals.width} * normals.height,
                    .threads = 2,
                    .rounds = request.rounds};
    const image::Depth depth = work.conversion.depth;
    const std::vector<Result> results =
        run(heat, {{"read and write alone",
                    [&] { return timed([&] { io::write_image(to, io::read_image(from), depth); }); }},
                   {"convert", [&] { return timed([&] { convert_file(from, to, work.conversion); }); }}});
    report_ratio(heat, "convert over reading and writing, on the wall",
                 times_faster(results[1], results[0], Clock::wall), {1.1, true});
  }
  fs::remove_all(folder);
}

void race(const Request& request) {
  const image::Image heights = make_heights(request.quick ? 512 : 4096);
  const image::Image normals = maps::convert(heights, {.from = {.kind = maps::Kind::height}}, "h").map;
  race_in_memory(request, heights, normals);
  race_with_files(request, normals);
}

} // namespace
} // namespace surfgrad::bench

int main(int argc, char** argv) { surfgrad::bench::race(surfgrad::bench::parse_request(argc, argv)); }
