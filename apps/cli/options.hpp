#pragma once

#include "image/image.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

namespace surfgrad::cli {

/// Options of the verbs that read a scene and write an image, spelled the same everywhere.
struct CommonOptions {
  std::string scene; ///< empty: the built-in demo
  std::string output;
  std::string size = "1024";
  std::string depth; ///< "", "8", "16", "half" or "float"
  int threads = 0;   ///< 0: as many as the machine has
  bool quiet = false;
  bool json = false;
};

/// What every verb takes: threads (0: as many as the machine has), and how much it says.
void add_job_options(CLI::App& verb, int& threads, bool& quiet, bool& json);

/// integer_bits is what the verb writes into PNG and TIFF unless told otherwise.
void add_common_options(CLI::App& verb, CommonOptions& options, const std::string& integer_bits);

struct Size {
  int width;
  int height;
};
/// "1024" or "1920x1080". Throws CLI::ValidationError (exit status 2) for anything else.
[[nodiscard]] Size parse_size(const std::string& text);

[[nodiscard]] scene::Scene open_scene(const CommonOptions& options);

/// Precision to write: what the user asked for, else the best the format is commonly read in.
/// depth is "", "8", "16", "half" or "float"; integer_default serves PNG and TIFF.
[[nodiscard]] image::Depth depth_for(const std::filesystem::path& output, const std::string& depth,
                                     image::Depth integer_default);

/// Encodes and writes the whole image or nothing. Throws Cancelled where an interrupt came before the
/// writing, else as io::write_image does. The extension and depth have passed io::check_image_output.
void write_unless_interrupted(const std::filesystem::path& output, const image::Image& image,
                              image::Depth depth);

/// io::check_image_output, with nothing left behind by an interrupt.
void check_output(const std::filesystem::path& output, image::Depth depth);

/// Refuses the empty text that an unset shell variable leaves.
[[nodiscard]] CLI::Validator not_empty();

/// Runs work on the number of threads asked for.
template <class Work>
void on_threads(int threads, const Work& work);

} // namespace surfgrad::cli

#include <tbb/global_control.h>
#include <tbb/info.h>

namespace surfgrad::cli {

template <class Work>
void on_threads(int threads, const Work& work) {
  const auto limit = threads > 0 ? static_cast<std::size_t>(threads)
                                 : static_cast<std::size_t>(tbb::info::default_concurrency());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, limit);
  work();
}

} // namespace surfgrad::cli
