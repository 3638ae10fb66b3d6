#include "options.hpp"

#include "io/extension.hpp"

#include "interrupt.hpp"
#include "io/image_file.hpp"

#include <charconv>

namespace surfgrad::cli {
namespace {

// A square of this side has 2^28 pixels, the most that images read and pictures rendered may have.
constexpr int largest_side = 16384;

bool parse_side(std::string_view text, int& side) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), side);
  return error == std::errc() && end == text.data() + text.size() && side >= 1 && side <= largest_side;
}

} // namespace

void add_job_options(CLI::App& verb, int& threads, bool& quiet, bool& json) {
  verb.add_option("--threads", threads, "threads to use; 0 means all")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  verb.add_flag("-q,--quiet", quiet, "no progress bar, warnings or summary (but --json)");
  verb.add_flag("--json", json, "summary as one line of JSON, even with --quiet");
}

void add_common_options(CLI::App& verb, CommonOptions& options, const std::string& integer_bits) {
  verb.add_option("SCENE", options.scene,
                  "stack document (.json) or model (.gltf, .glb, .obj); without it the built-in demo")
      ->check(not_empty());
  verb.add_option("-o,--output", options.output, "file to write; the extension decides the format")
      ->required()
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_option("--size", options.size, "side in pixels, or WIDTHxHEIGHT")
      ->capture_default_str()
      ->type_name("N");
  verb.add_option("--depth", options.depth,
                  "8, 16, half or float (default: " + integer_bits + " for PNG and TIFF, float for EXR)")
      ->check(CLI::IsMember({"8", "16", "half", "float"}).description(""))
      ->type_name("BITS");
  add_job_options(verb, options.threads, options.quiet, options.json);
}

Size parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  Size size{};
  const bool square = x == std::string::npos;
  if (parse_side(text.substr(0, x), size.width) &&
      (square || parse_side(std::string_view(text).substr(x + 1), size.height))) {
    if (square) size.height = size.width;
    return size;
  }
  throw CLI::ValidationError("--size", "\"" + text +
                                           "\" is not a size; use N or WIDTHxHEIGHT, each from 1 to " +
                                           std::to_string(largest_side));
}

scene::Scene open_scene(const CommonOptions& options) {
  scene::Scene scene = options.scene.empty() ? scene::demo_scene() : scene::load_scene(options.scene);
  stop_if_interrupted();
  return scene;
}

void write_unless_interrupted(const std::filesystem::path& output, const image::Image& image,
                              image::Depth depth) {
  const Unbroken whole_file;
  stop_if_interrupted();
  io::write_image(output, image, depth);
}

void check_output(const std::filesystem::path& output, image::Depth depth) {
  const Unbroken probe;
  io::check_image_output(output, depth);
}

CLI::Validator not_empty() {
  return CLI::Validator([](std::string& text) { return text.empty() ? "must not be empty" : ""; }, "");
}

image::Depth depth_for(const std::filesystem::path& output, const std::string& depth,
                       image::Depth integer_default) {
  if (depth == "8") return image::Depth::unorm8;
  if (depth == "16") return image::Depth::unorm16;
  if (depth == "half") return image::Depth::half;
  if (depth == "float") return image::Depth::float32;
  return io::lower_extension(output) == ".exr" ? image::Depth::float32 : integer_default;
}

} // namespace surfgrad::cli
