#include "lost_detail_output.hpp"

#include "bake/normal_statistics.hpp"
#include "bake/roughness.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "map_options.hpp"
#include "options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace surfgrad::cli {
namespace {

namespace fs = std::filesystem;

image::Depth depth_of(const fs::path& file) { return depth_for(file, "", image::Depth::unorm8); }

} // namespace

void LostDetailOutput::add_options(CLI::App& verb) {
  verb.add_option("--roughness", roughness_,
                  "also write the roughness that the detail lost within each texel amounts to, on top of\n"
                  "--base-roughness; wants --samples of 2 or more, or --mips. 8 bits, floats in EXR")
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_option(
          "--anisotropy", anisotropy_,
          "also write its direction and strength as KHR_materials_anisotropy has them; --roughness is\n"
          "then that across the direction")
      ->check(not_empty())
      ->type_name("FILE");
  verb.add_option(
          "--base-roughness", base_,
          "roughness of the surface between the bumps: a number from 0 to 1, or a map over the UV set\n"
          "(the green channel of three, as in glTF, else the first)")
      ->capture_default_str()
      ->type_name("VALUE|FILE");
  verb.add_flag(
      "--mips", is_mips_wanted_,
      "also write the mip levels of the map and of the roughness: NAME_mip1.png and so on, of mean\n"
      "normals, with the detail that each level loses in its roughness");
}

void LostDetailOutput::check(const OutputNames& names, const std::vector<std::string>& scenes) const {
  names.check("--roughness", roughness_.string(), scenes);
  names.check("--anisotropy", anisotropy_.string(), scenes);
}

void LostDetailOutput::rename(const std::function<fs::path(const std::string&)>& file_for) {
  roughness_ = file_for(roughness_.string());
  anisotropy_ = file_for(anisotropy_.string());
}

void LostDetailOutput::check(const bake::Options& job, const fs::path& map) const {
  if (!anisotropy_.empty() && roughness_.empty())
    throw CLI::ValidationError("--anisotropy", "goes with --roughness, which holds the rest of it");
  if (!is_wanted()) return;
  if (job.space != bake::Space::tangent)
    throw CLI::ValidationError(is_mips_wanted_ ? "--mips" : "--roughness", "is for --space tangent");
  if (!roughness_.empty() && job.samples == 1 && !is_mips_wanted_)
    throw CLI::ValidationError("--roughness", "is what the samples of a texel differ by: give --samples 2 or "
                                              "more, or --mips");
  claim(map, std::max(job.width, job.height), [&](const std::string& option, const fs::path& file) {
    check_output(file, option == "--mips" ? job.depth : depth_of(file));
  });
  check_memory({job.width, job.height}, 82); // sums, their levels and a picture
}

void LostDetailOutput::read_base() {
  if (is_wanted()) base_read_ = base_roughness_of(base_);
}

void LostDetailOutput::claim(const fs::path& map, int side,
                             const std::function<void(const std::string&, const fs::path&)>& claim) const {
  const int levels = is_mips_wanted_ ? std::bit_width(static_cast<unsigned>(side)) : 1;
  for (int level = 0; level < levels; ++level) {
    if (level > 0) claim("--mips", file_of_level(map, level));
    if (!roughness_.empty()) claim("--roughness", file_of_level(roughness_, level));
    if (!anisotropy_.empty()) claim("--anisotropy", file_of_level(anisotropy_, level));
  }
}

void LostDetailOutput::write(const scene::Scene& scene, const bake::Options& job, const fs::path& map,
                             io::Compression compression, bool quiet) {
  if (!is_wanted()) return;
  Console console("measuring detail", quiet);
  const bake::NormalStatistics normals = bake::normal_statistics(scene, job, {console.report().progress, {}});
  const auto write = [&](const fs::path& file, const image::Image& picture, image::Depth depth) {
    const Unbroken whole_file;
    stop_if_interrupted();
    io::write_image(file, picture, depth, compression);
    files_.push_back(file);
  };
  const int levels = is_mips_wanted_ ? normals.level_count() : 1;
  for (int level = 0; level < levels; ++level) {
    if (level > 0) write(file_of_level(map, level), bake::normal_level(normals, level, job), job.depth);
    if (roughness_.empty()) continue;
    image::Image roughness = bake::roughness_map(normals, level, *base_read_, job, !anisotropy_.empty());
    write(file_of_level(roughness_, level), roughness, depth_of(roughness_));
    // A model takes it without direction.
    if (level == 0)
      written_ = anisotropy_.empty() ? std::move(roughness)
                                     : bake::roughness_map(normals, level, *base_read_, job, false);
    if (anisotropy_.empty()) continue;
    write(file_of_level(anisotropy_, level), bake::anisotropy_map(normals, level, *base_read_, job),
          depth_of(anisotropy_));
  }
}

} // namespace surfgrad::cli
