#include "device.hpp"

#include "console.hpp"
#include "diagnostic/error.hpp"
#include "options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iostream>
#include <map>
#include <numbers>

#if SURFGRAD_GPU
#include "gpu/backend.hpp"
#endif

namespace surfgrad::cli {
namespace {

constexpr const char* processor = "cpu";
constexpr std::string_view vulkan = "vulkan";
/// A tile of this side has about as many pixels as the largest devices compute at a time, and takes some 90
/// MiB of each thread's memory; it grows with the square.
constexpr int most_tile_side = 512;

/// The number behind "vulkan:", 0 for "vulkan" alone; -1 for anything else.
int number_of(std::string_view device) {
  if (device == vulkan) return 0;
  if (!device.starts_with("vulkan:")) return -1;
  device.remove_prefix(vulkan.size() + 1);
  int number = 0;
  const auto [end, error] = std::from_chars(device.data(), device.data() + device.size(), number);
  return error == std::errc() && end == device.data() + device.size() && number >= 0 ? number : -1;
}

CLI::Validator known_device() {
  return CLI::Validator(
      [](std::string& text) {
        if (text == processor || number_of(text) >= 0) return std::string();
        return fmt::format("\"{}\" is not a device; use cpu, vulkan or, of several, vulkan:N (surfgrad "
                           "--list-devices)",
                           text);
      },
      "");
}

} // namespace

void add_device_options(CLI::App& verb, DeviceOptions& options) {
  CLI::Option* const device =
      verb.add_option(
              "--device", options.device,
              "what composes the normals: cpu (default), vulkan, or vulkan:N of surfgrad --list-devices")
          ->check(known_device())
          ->type_name("NAME")
          ->option_text("NAME");
  const std::map<std::string, Filter> filters{{"exact", Filter::exact}, {"hardware", Filter::hardware}};
  verb.add_option(
          "--filter", options.filter,
          "how a Vulkan device filters maps: exact (default), as the processor does, or hardware, by\n"
          "its samplers: faster, and the summary says how far normals may be off for it")
      ->transform(one_of(filters))
      ->needs(device)
      ->type_name("NAME")
      ->option_text("NAME");
  verb.add_option("--max-tile", options.max_tile,
                  fmt::format("most pixels along a side of what a device is given at a time, 1 to {}",
                              most_tile_side))
      ->check(CLI::Range(1, most_tile_side).description(""))
      ->needs(device)
      ->type_name("N")
      ->option_text("N");
}

static void require_samplers(const DeviceOptions& options) {
  if (options.device == processor && options.filter == Filter::hardware)
    throw CLI::ValidationError("--filter", "the processor has no hardware for it; use --device vulkan");
}

#if SURFGRAD_GPU

struct ChosenDevice::Open {
  gpu::Device device;
  Filter filter;
  gpu::Backend backend;

  explicit Open(const DeviceOptions& options)
      : device({.number = number_of(options.device)}), filter(options.filter),
        backend(device, options.max_tile > 0 ? options.max_tile : gpu::Backend::usual_tile_side, SIZE_MAX,
                {.filtering = options.filter == Filter::hardware ? gpu::Filtering::hardware
                                                                 : gpu::Filtering::exact}) {}
};

ChosenDevice::ChosenDevice(const DeviceOptions& options) {
  require_samplers(options);
  if (options.device != processor) open_ = std::make_unique<Open>(options);
}
const stage::Backend* ChosenDevice::backend() const { return open_ ? &open_->backend : nullptr; }
std::string ChosenDevice::name() const { return open_ ? open_->device.info().name : processor; }
ChosenDevice::Filtered ChosenDevice::filtered() const {
  if (!open_ || open_->filter == Filter::exact) return {};
  const gpu::FilterReport report = open_->backend.filter_report();
  return {"hardware", report.maps, report.sampled, report.largest_angle * 180 / std::numbers::pi};
}

static void print_vulkan_devices() {
  try {
    int number = 0;
    for (const gpu::DeviceInfo& each : gpu::list_devices())
      std::cout << fmt::format("vulkan:{}  {} ({}, {}){}\n", number++, each.name, each.kind, each.driver,
                               each.lacks.empty() ? "" : ": cannot be used, it lacks " + each.lacks);
  } catch (const MachineError& error) {
    complain(error.what());
  }
}

#else

struct ChosenDevice::Open {};

ChosenDevice::ChosenDevice(const DeviceOptions& options) {
  require_samplers(options);
  if (options.device != processor)
    throw MachineError("cannot use a Vulkan device: this program was built without (SURFGRAD_GPU=OFF)");
}
const stage::Backend* ChosenDevice::backend() const { return nullptr; }
std::string ChosenDevice::name() const { return processor; }
ChosenDevice::Filtered ChosenDevice::filtered() const { return {}; }

static void print_vulkan_devices() {}

#endif

void add_device_list(CLI::App& program) {
  program
      .add_flag_callback(
          "--list-devices",
          [] {
            std::cout << "cpu\n";
            print_vulkan_devices();
            throw CLI::Success();
          },
          "print what --device takes, and end")
      ->trigger_on_parse();
}

ChosenDevice::~ChosenDevice() = default;

/// A bound in two digits that holds still.
static std::string rounded_up(double bound) {
  if (bound >= 10) return fmt::format("{:.0f}", std::ceil(bound));
  if (bound <= 0) return "0";
  const double digit = std::pow(10.0, std::floor(std::log10(bound)) - 1);
  return fmt::format("{:.2g}", std::ceil(bound / digit) * digit);
}

void say_filtered(const ChosenDevice::Filtered& filtered, Console& console) {
  if (filtered.filter == "exact") return;
  console.say(fmt::format(
      "{} of {} maps filtered by hardware: normals at most {} degrees from those of exact filters",
      filtered.sampled, filtered.maps, rounded_up(filtered.bound_deg)));
}

} // namespace surfgrad::cli
