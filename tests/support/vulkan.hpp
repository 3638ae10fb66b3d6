#pragma once

/// Tests on a Vulkan device (support/software_driver.hpp). Each fails on anything that the validation layer
/// says. Memory that the processor reads holds anything but zeros before it is written.

#include "gpu/device.hpp"
#include "support/software_driver.hpp"
#include "support/vulkan_faults.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <memory>

namespace surfgrad::test {

class VulkanTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    choose_software_driver();
    if (!dirty_memory) dirty_memory = std::make_unique<VulkanFaults>("fill");
    if (!shared) shared = std::make_unique<gpu::Device>(gpu::DeviceOptions{.validate = true});
  }
  static void TearDownTestSuite() {
    shared.reset();
    dirty_memory.reset();
  }
  static const gpu::Device& device() { return *shared; }

  void SetUp() override { before_ = device().messages().size(); }
  void TearDown() override {
    const auto messages = device().messages();
    for (std::size_t i = before_; i < messages.size(); ++i) ADD_FAILURE() << messages[i];
  }

 private:
  inline static std::unique_ptr<VulkanFaults> dirty_memory;
  inline static std::unique_ptr<gpu::Device> shared;
  std::size_t before_ = 0;
};

} // namespace surfgrad::test
