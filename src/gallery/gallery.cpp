#include "gallery/gallery.hpp"

#include "diagnostic/error.hpp"
#include "gallery/figures.hpp"
#include "gallery/models.hpp"
#include "gallery/page.hpp"
#include "io/file.hpp"
#include "io/image_file.hpp"
#include "render/render.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>
#include <system_error>

namespace fs = std::filesystem;

namespace surfgrad::gallery {
namespace {

/// The fraction done over many jobs that run at once, as one callback sees it.
class Progress {
 public:
  Progress(std::size_t jobs, const Report& report) : done_(jobs), report_(report) {}

  /// Sets one job's fraction. Whether to go on.
  bool operator()(std::size_t job, double fraction) {
    const std::lock_guard<std::mutex> lock(mutex_);
    done_[job] = fraction;
    double sum = 0;
    for (const double d : done_) sum += d;
    if (!stop_ && report_.progress) stop_ = !report_.progress(sum / static_cast<double>(done_.size()));
    return !stop_;
  }

 private:
  std::mutex mutex_{};
  std::vector<double> done_;
  const Report& report_;
  bool stop_ = false;
};

const char* const page_name = "index.html";

bool all_pictures_are_in(const fs::path& folder, const Figure& figure) {
  return std::all_of(figure.panels.begin(), figure.panels.end(), [&](const Panel& panel) {
    std::error_code ignored; // what cannot be looked at cannot be shown
    return fs::is_regular_file(folder / picture_name(figure, panel), ignored);
  });
}

} // namespace

std::vector<Figure> built_in_figures() {
  const auto maps = std::make_shared<Maps>();
  std::vector<Figure> all;
  for (const auto group : {volume_figures, detail_figures, projection_figures, tiling_figures, decal_figures,
                           height_figures, displacement_figures, blending_figures, basis_figures,
                           morphing_figures, back_face_figures, transform_figures}) {
    std::vector<Figure> figures = group(maps);
    std::move(figures.begin(), figures.end(), std::back_inserter(all));
  }
  return all;
}

std::vector<Figure> figures(const fs::path& assets, const Report& report) {
  std::vector<Figure> all = built_in_figures();
  if (!assets.empty()) all.push_back(model_figure(assets, report));
  return all;
}

Drawn draw(const std::vector<Figure>& figures, const Options& options, const Report& report) {
  std::vector<std::pair<const Figure*, const Panel*>> jobs;
  for (const Figure& figure : figures)
    for (const Panel& panel : figure.panels) jobs.emplace_back(&figure, &panel);
  const render::Options look{.width = options.width, .height = options.height, .samples = options.samples};

  Drawn drawn;
  drawn.pictures.resize(jobs.size());
  std::atomic<std::int64_t> degenerate{0};
  Progress progress(jobs.size(), report);
  tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
    // Isolated: a thread that waits for the last rows of one picture must not begin another, or
    // all pictures would be in memory at once.
    tbb::this_task_arena::isolate([&] {
      const auto& [figure, panel] = jobs[i];
      const Report of_this{.progress = [&](double fraction) { return progress(i, fraction); }};
      const render::Picture picture = render::render(panel->scene(), look, of_this);
      degenerate += picture.degenerate;
      drawn.pictures[i] = {
          picture_name(*figure, *panel),
          io::encode_image(picture.image, image::Depth::unorm8, io::ImageFormat::png, options.compression)};
    });
  });
  drawn.degenerate = degenerate;
  return drawn;
}

void check_folder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error)) {
    io::check_writable(folder / page_name);
    return;
  }
  if (fs::exists(folder, error))
    throw InputError({.file = folder,
                      .problem = "is a file",
                      .remedy = "give the name of a folder, which may exist or not"});
  // A folder that is to be made needs what a file in its place would need.
  const fs::path bare = folder.has_filename() ? folder : folder.parent_path();
  io::check_writable(bare);
}

void write(const fs::path& folder, const std::vector<Figure>& figures, const std::vector<File>& pictures,
           const Options& options) {
  check_folder(folder);
  std::error_code error;
  fs::create_directory(folder.has_filename() ? folder : folder.parent_path(), error);
  if (error)
    throw MachineError(fmt::format("{}: cannot make this folder: {}", folder.string(), error.message()));
  for (const File& file : pictures) io::write_file(folder / file.name, file.bytes);
  std::vector<Figure> shown;
  std::copy_if(figures.begin(), figures.end(), std::back_inserter(shown),
               [&](const Figure& figure) { return all_pictures_are_in(folder, figure); });
  const std::string html = page(shown, options.width, options.height);
  io::write_file(folder / page_name, std::as_bytes(std::span(html)));
}

} // namespace surfgrad::gallery
