#include "commands.hpp"
#include "console.hpp"
#include "gallery/gallery.hpp"
#include "interrupt.hpp"
#include "options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace surfgrad::cli {
namespace {

struct GalleryCommand {
  std::string folder;
  std::string size = "512";
  std::string only;
  std::string assets;
  io::Compression compression = io::Compression::fast;
  int threads = 0;
  bool quiet = false;
  bool json = false;
};

/// The figure asked for, or all of them.
std::vector<gallery::Figure> chosen(const std::vector<gallery::Figure>& all, const std::string& only) {
  if (only.empty()) return all;
  std::string names;
  for (const gallery::Figure& figure : all) {
    if (figure.id == only) return {figure};
    names += (names.empty() ? "" : ", ") + figure.id;
  }
  throw CLI::ValidationError("--only", "\"" + only + "\" is not a figure; there are " + names);
}

void run(const GalleryCommand& command) {
  const Size size = parse_size(command.size);
  const gallery::Options job{.width = size.width, .height = size.height, .compression = command.compression};
  check_memory(size);
  const std::filesystem::path folder = command.folder;
  {
    const Unbroken probe;
    gallery::check_folder(folder);
  }
  Console console("drawing", command.quiet);
  on_threads(command.threads, [&] {
    const Report report = console.report();
    const std::vector<gallery::Figure> all = gallery::figures(command.assets, report);
    const std::vector<gallery::Figure> figures = chosen(all, command.only);
    const gallery::Drawn drawn = gallery::draw(figures, job, report);
    {
      const Unbroken whole_gallery;
      stop_if_interrupted();
      gallery::write(folder, all, drawn.pictures, job);
    }
    const std::string page = (folder / "index.html").string();
    if (command.json) {
      console.say_json({{"output", page},
                        {"width", size.width},
                        {"height", size.height},
                        {"figures", figures.size()},
                        {"pictures", drawn.pictures.size()},
                        {"degenerate_samples", drawn.degenerate}});
      return;
    }
    console.say(
        fmt::format("wrote {} ({} pictures, {}x{})", page, drawn.pictures.size(), size.width, size.height));
  });
}

} // namespace

void add_gallery_command(CLI::App& program) {
  auto command = std::make_shared<GalleryCommand>();
  CLI::App& verb =
      *program.add_subcommand("gallery", "Draw every kind of bump beside older ways, as one HTML page");
  std::string names;
  for (const gallery::Figure& figure : gallery::figures({})) names += "\n  " + figure.id;
  verb.footer("The page is DIR/index.html; its pictures lie beside it. Everything shown is built in.\n"
              "Nothing is written before all pictures are drawn, and the page is written last.\n\n"
              "Figures:" +
              names +
              "\n  models (with --assets)\n\n"
              "Examples:\n"
              "  surfgrad gallery -o gallery                          all of it, about a minute\n"
              "  surfgrad gallery -o gallery --only blending          one figure drawn anew\n"
              "  surfgrad gallery -o gallery --assets models          and one's own models");
  verb.add_option("-o,--output", command->folder, "folder to write; made where it is missing")
      ->required()
      ->check(not_empty())
      ->type_name("DIR");
  verb.add_option("--only", command->only,
                  "draw this figure alone; the page keeps the others whose pictures are in DIR")
      ->check(not_empty())
      ->type_name("NAME");
  verb.add_option("--assets", command->assets,
                  "show the models with normal maps of this folder, too (.gltf, .glb, .obj)")
      ->check(not_empty())
      ->type_name("DIR");
  verb.add_option("--size", command->size, "side of each picture in pixels, or WIDTHxHEIGHT")
      ->capture_default_str()
      ->type_name("N");
  add_compress_option(verb, command->compression);
  add_job_options(verb, command->threads, command->quiet, command->json);
  verb.callback([command] { run(*command); });
}

} // namespace surfgrad::cli
