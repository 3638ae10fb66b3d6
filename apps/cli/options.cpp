#include "options.hpp"

#include "diagnostic/error.hpp"
#include "io/extension.hpp"
#include "resources.hpp"
#include "simd/isa.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace surfgrad::cli {
namespace {

// A square of this side has 2^28 pixels, the most that images read and pictures rendered may have.
constexpr int largest_side = 16384;

/// A whole number from 1 to `largest`, in digits alone.
bool parse_count(std::string_view text, int largest, int& count) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc() && end == text.data() + text.size() && count >= 1 && count <= largest;
}

CLI::Validator number_of_threads() {
  return CLI::Validator(
      [](std::string& text) {
        const int most = usable_cores();
        int threads = 0;
        if (parse_count(text, most, threads)) return std::string();
        return fmt::format("\"{}\" is not a number of threads that this process may use; {}, or leave it out "
                           "to use all",
                           text, most == 1 ? "use 1" : fmt::format("use 1 to {}", most));
      },
      "");
}

std::string gibibytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

} // namespace

void add_job_options(CLI::App& verb, int& threads, bool& quiet, bool& json) {
  verb.add_option("--threads", threads, "threads to use, no more than there are cores (default: all)")
      ->check(number_of_threads())
      ->type_name("N");
  verb.add_flag("-q,--quiet", quiet, "no progress bar, warnings or summary (but --json)");
  verb.add_flag("--json", json, "summary as one line of JSON, even with --quiet");
}

void add_compress_option(CLI::App& verb, io::Compression& compression) {
  const std::map<std::string, io::Compression> names{{"fast", io::Compression::fast},
                                                     {"small", io::Compression::small}};
  verb.add_option("--compress", compression, "fast (default), or small: slower to write")
      ->transform(one_of(names))
      ->type_name("NAME")
      ->option_text("NAME");
}

void add_depth_option(CLI::App& verb, std::string& depth, const std::string& integer_bits) {
  verb.add_option("--depth", depth,
                  "8, 16, half or float (default: " + integer_bits + " for PNG and TIFF, float for EXR)")
      ->check(CLI::IsMember({"8", "16", "half", "float"}).description(""))
      ->type_name("BITS");
}

void add_picture_options(CLI::App& verb, CommonOptions& options, const std::string& integer_bits) {
  verb.add_option("--size", options.size, "side in pixels, or WIDTHxHEIGHT")
      ->capture_default_str()
      ->type_name("N");
  add_depth_option(verb, options.depth, integer_bits);
  add_compress_option(verb, options.compression);
  add_device_options(verb, options.device);
  add_job_options(verb, options.threads, options.quiet, options.json);
}

void add_common_options(CLI::App& verb, CommonOptions& options, const std::string& integer_bits) {
  verb.add_option("SCENE", options.scene,
                  "stack document (.json) or model (.gltf, .glb, .obj); without it the built-in demo")
      ->check(not_empty());
  verb.add_option("-o,--output", options.output, "file to write; the extension decides the format")
      ->required()
      ->check(not_empty())
      ->type_name("FILE");
  add_picture_options(verb, options, integer_bits);
}

Size parse_size(const std::string& text) {
  const std::size_t x = text.find('x');
  Size size{};
  const bool square = x == std::string::npos;
  if (parse_count(text.substr(0, x), largest_side, size.width) &&
      (square || parse_count(std::string_view(text).substr(x + 1), largest_side, size.height))) {
    if (square) size.height = size.width;
    return size;
  }
  throw CLI::ValidationError("--size", "\"" + text +
                                           "\" is not a size; use N or WIDTHxHEIGHT, each from 1 to " +
                                           std::to_string(largest_side));
}

void check_memory(const Size& size, std::uint64_t bytes_a_pixel) {
  const auto pixels = static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
  const std::uint64_t most = usable_memory();
  if (pixels * bytes_a_pixel <= most) return;
  const double scale = std::sqrt(static_cast<double>(most / bytes_a_pixel) / static_cast<double>(pixels));
  throw MachineError(fmt::format(
      "--size {}x{}: the picture alone takes {} of memory, but there are {}; try {}x{}", size.width,
      size.height, gibibytes(pixels * bytes_a_pixel), gibibytes(most),
      std::max(1, static_cast<int>(scale * size.width)), std::max(1, static_cast<int>(scale * size.height))));
}

scene::Scene open_scene(const CommonOptions& options, const Report& report) {
  scene::Scene scene =
      options.scene.empty() ? scene::demo_scene() : scene::load_scene(options.scene, report.at_the_start());
  stop_if_interrupted();
  return scene;
}

OutputFile::OutputFile(std::filesystem::path output, const io::ImageShape& shape, image::Depth depth,
                       io::Compression compression)
    : output_(std::move(output)), shape_(shape), depth_(depth), compression_(compression) {}

void OutputFile::write(const image::Image& band) {
  stop_if_interrupted();
  if (!writer_) {
    no_temporary_left_.emplace();
    writer_.emplace(output_, shape_, depth_, compression_);
  }
  writer_->write_rows(band);
}

void OutputFile::commit() {
  stop_if_interrupted();
  writer_->commit();
  writer_.reset();
  no_temporary_left_.reset();
}

void check_output(const std::filesystem::path& output, image::Depth depth) {
  const Unbroken probe;
  io::check_image_output(output, depth);
}

void check_is_no_input(const scene::Scene& scene, const std::filesystem::path& output,
                       const std::string& option) {
  const auto check = [&](const std::filesystem::path& input) {
    std::error_code ignored; // what does not exist yet, or is built in, is no other file
    if (std::filesystem::equivalent(input, output, ignored))
      throw InputError({.file = output,
                        .problem = "would replace a file of the scene",
                        .remedy = "give " + option + " another name"});
  };
  check(scene.source);
  check(scene.model);
  for (const auto& [file, image] : scene.images) check(file);
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

void on_threads(int threads, const std::function<void()>& work) {
  static_cast<void>(simd::current_isa());
  const auto limit = static_cast<std::size_t>(threads > 0 ? threads : usable_cores());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, limit);
  work();
}

} // namespace surfgrad::cli
