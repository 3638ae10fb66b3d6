#pragma once

#include "stage/backend.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace surfgrad::cli {

/// What composes a job's pixels, as the user asks for it.
struct DeviceOptions {
  std::string device = "cpu"; ///< or "vulkan", "vulkan:1" ...
  int max_tile = 0;           ///< most pixels along a side of a device's tiles; 0: as the device likes it
};

/// --device and --max-tile.
void add_device_options(CLI::App& verb, DeviceOptions& options);

/// --list-devices, which prints them and ends the program.
void add_device_list(CLI::App& program);

/// The device that was asked for, open for as long as this lives.
class ChosenDevice {
 public:
  /// throws  MachineError where it is not there or lacks something
  explicit ChosenDevice(const DeviceOptions& options);
  ~ChosenDevice();
  ChosenDevice(const ChosenDevice&) = delete;
  ChosenDevice& operator=(const ChosenDevice&) = delete;

  /// Null for the processor.
  [[nodiscard]] const stage::Backend* backend() const;
  /// "cpu", or the driver's name of the device.
  [[nodiscard]] std::string name() const;

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

} // namespace surfgrad::cli
