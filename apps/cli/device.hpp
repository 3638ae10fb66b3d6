#pragma once

#include "stage/backend.hpp"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <memory>
#include <string>

namespace surfgrad::cli {

class Console;

/// How a device filters maps: as the engine does, or through its samplers.
enum class Filter { exact, hardware };

/// What composes a job's pixels, as the user asks for it.
struct DeviceOptions {
  std::string device = "cpu"; ///< or "vulkan", "vulkan:1" ...
  int max_tile = 0;           ///< most pixels along a side of a device's tiles; 0: as the device likes it
  Filter filter = Filter::exact;
};

/// --device, --filter and --max-tile.
void add_device_options(CLI::App& verb, DeviceOptions& options);

/// --list-devices, which prints them and ends the program.
void add_device_list(CLI::App& program);

/// The device that was asked for, open for as long as this lives.
class ChosenDevice {
 public:
  /// throws  MachineError where it is not there or lacks something; CLI::ValidationError where the processor
  /// is
  ///         to filter by hardware
  explicit ChosenDevice(const DeviceOptions& options);
  ~ChosenDevice();
  ChosenDevice(const ChosenDevice&) = delete;
  ChosenDevice& operator=(const ChosenDevice&) = delete;

  /// Null for the processor.
  [[nodiscard]] const stage::Backend* backend() const;
  /// "cpu", or the driver's name of the device.
  [[nodiscard]] std::string name() const;

  /// How the maps of the job were filtered, when it is done.
  struct Filtered {
    std::string filter = "exact";
    std::size_t maps = 0, sampled = 0; ///< hardware: of all materials, and those that it filtered
    double bound_deg = 0;              ///< largest angle between normals and those of exact filters
  };
  [[nodiscard]] Filtered filtered() const;

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

/// Says what hardware filtered, and how far normals may be off for it; of exact filters nothing.
void say_filtered(const ChosenDevice::Filtered& filtered, Console& console);

} // namespace surfgrad::cli
