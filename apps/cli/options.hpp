#pragma once

#include "device.hpp"
#include "diagnostic/report.hpp"
#include "image/image.hpp"
#include "interrupt.hpp"
#include "io/image_writer.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace surfgrad::cli {

/// Options of the verbs that read a scene and write an image, spelled the same everywhere.
struct CommonOptions {
  std::string scene; ///< empty: the built-in demo
  std::string output;
  std::string size = "1024";
  std::string depth; ///< "", "8", "16", "half" or "float"
  io::Compression compression = io::Compression::fast;
  int threads = 0; ///< 0: not given, as many as this process may use
  bool quiet = false;
  bool json = false;
  DeviceOptions device{};
};

/// What every verb takes: threads, from 1 to as many as this process may use (0 stands for the option
/// left out: all of them), and how much it says.
void add_job_options(CLI::App& verb, int& threads, bool& quiet, bool& json);

/// What the verbs that write images take.
void add_compress_option(CLI::App& verb, io::Compression& compression);

void add_depth_option(CLI::App& verb, std::string& depth, const std::string& integer_bits);

/// How a picture is made and written. integer_bits is what the verb writes into PNG and TIFF unless told
/// otherwise.
void add_picture_options(CLI::App& verb, CommonOptions& options, const std::string& integer_bits);

/// One scene, one file, and add_picture_options.
void add_common_options(CLI::App& verb, CommonOptions& options, const std::string& integer_bits);

struct Size {
  int width;
  int height;
};
/// "1024" or "1920x1080". Throws CLI::ValidationError (exit status 2) for anything else.
[[nodiscard]] Size parse_size(const std::string& text);

/// Throws MachineError, with a size that fits, where a picture of this one cannot fit in memory.
///
/// bytes_a_pixel  of what is held; a picture of three floats and what is seen there
void check_memory(const Size& size, std::uint64_t bytes_a_pixel = 16);

/// Throws Cancelled after an interrupt.
[[nodiscard]] scene::Scene open_scene(const CommonOptions& options, const Report& report);

/// Precision to write: what the user asked for, else the best the format is commonly read in.
/// depth is "", "8", "16", "half" or "float"; integer_default serves PNG and TIFF.
[[nodiscard]] image::Depth depth_for(const std::filesystem::path& output, const std::string& depth,
                                     image::Depth integer_default);

/// An image that is written while it is made. It appears whole or not at all, also after an interrupt.
class OutputFile {
 public:
  /// As for io::ImageWriter; the extension and depth have passed io::check_image_output. Nothing is opened
  /// before the first band.
  OutputFile(std::filesystem::path output, const io::ImageShape& shape, image::Depth depth,
             io::Compression compression);

  /// The next rows, from the top downwards. Throws Cancelled after an interrupt.
  void write(const image::Image& band);
  void commit();

 private:
  std::filesystem::path output_;
  io::ImageShape shape_;
  image::Depth depth_;
  io::Compression compression_;
  std::optional<Unbroken> no_temporary_left_; ///< outlives the writer
  std::optional<io::ImageWriter> writer_;
};

/// io::check_image_output, with nothing left behind by an interrupt.
void check_output(const std::filesystem::path& output, image::Depth depth);

/// Refuses a file to be written that the scene was read from: `shader rock.json -o rock` would write
/// rock.json. `option` is the one that names it.
void check_is_no_input(const scene::Scene& scene, const std::filesystem::path& output,
                       const std::string& option);

/// Refuses the empty text that an unset shell variable leaves.
[[nodiscard]] CLI::Validator not_empty();

/// Takes one of these words and no other, for the value that it stands for. To be given to transform().
template <class Enum>
[[nodiscard]] CLI::Validator one_of(const std::map<std::string, Enum>& words) {
  const auto value_of = [words](std::string& text) -> std::string {
    const auto word = words.find(text);
    if (word == words.end()) {
      std::string known;
      for (const auto& [name, value] : words) known += (known.empty() ? "" : ", ") + name;
      return "\"" + text + "\" is none of " + known;
    }
    text = std::to_string(static_cast<int>(word->second)); // as enumerations are read
    return "";
  };
  return CLI::Validator(value_of, "");
}

/// Runs work on the number of threads asked for; 0 is all that this process may use. Complains before the
/// work about an instruction set that is asked for and not there.
void on_threads(int threads, const std::function<void()>& work);

} // namespace surfgrad::cli
