#pragma once

#include "gpu/device.hpp"

#include <cstddef>
#include <span>

namespace surfgrad::gpu {

/// Where a buffer lies.
enum class Residence {
  device, ///< fast for shaders; reached through copies
  upload, ///< written by the processor
  result, ///< read by the processor
};

/// Storage on the device, for shaders (storage or uniform buffer) and for copies.
class Buffer {
 public:
  Buffer() = default;
  /// throws  MachineError where the device has not enough memory
  Buffer(const Device& device, std::size_t bytes, Residence residence);

  [[nodiscard]] VkBuffer get() const { return buffer_.get(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  /// The buffer in the processor's memory; empty for Residence::device. Writes are seen by commands that
  /// are submitted later; results are there once Device::run returns, if the commands end with a
  /// barrier (barrier_after_writes).
  [[nodiscard]] std::span<std::byte> mapped() const { return {mapped_, mapped_ != nullptr ? bytes_ : 0}; }

 private:
  Handle<VkDeviceMemory> memory_; // outlives the buffer bound to it; unmapped when freed
  Handle<VkBuffer> buffer_;
  std::size_t bytes_ = 0;
  std::byte* mapped_ = nullptr;
};

/// A buffer in the device's memory with these contents.
[[nodiscard]] Buffer make_device_buffer(const Device& device, std::span<const std::byte> contents);

/// Commands: what shaders and copies wrote before, shaders, copies and the host read after.
void barrier_after_writes(VkCommandBuffer commands);

} // namespace surfgrad::gpu
