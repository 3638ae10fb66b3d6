/// Devices: which there are, which is chosen, and what is said where none can be used.

#include "diagnostic/error.hpp"
#include "gpu/buffer.hpp"
#include "gpu/result.hpp"
#include "support/vulkan.hpp"

#include <string>

namespace surfgrad::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

using Devices = VulkanTest;

template <class F>
std::string machine_error(const F& f) {
  try {
    f();
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no MachineError";
}

TEST_F(Devices, AreListedInTheOrderOfPreference) {
  const auto devices = gpu::list_devices();
  ASSERT_FALSE(devices.empty());
  EXPECT_EQ(devices[0].name, device().info().name);
  EXPECT_EQ(devices[0].lacks, "");
  EXPECT_THAT(devices[0].driver, HasSubstr("Vulkan 1."));
  const std::vector<std::string> order{"discrete", "integrated", "virtual", "processor", "other"};
  std::size_t last = 0;
  for (const gpu::DeviceInfo& each : devices) {
    if (!each.lacks.empty()) break;
    const auto rank =
        static_cast<std::size_t>(std::find(order.begin(), order.end(), each.kind) - order.begin());
    ASSERT_LT(rank, order.size()) << each.kind;
    EXPECT_LE(last, rank);
    last = rank;
  }
}

TEST_F(Devices, ThatAreNotThereAreNotReplacedByOthers) {
  EXPECT_THAT(machine_error([] { gpu::Device({.number = 99}); }), HasSubstr("cannot use Vulkan device 99"));
  EXPECT_THAT(machine_error([] { gpu::Device({.number = -1}); }), HasSubstr("cannot use Vulkan device -1"));
}

TEST_F(Devices, ThatLackALimitNameIt) {
  EXPECT_EQ(gpu::lacks(device().limits()), "");
  VkPhysicalDeviceLimits forged = device().limits();
  forged.maxPerStageDescriptorStorageBuffers = 4; // the least that Vulkan allows
  EXPECT_EQ(gpu::lacks(forged), "maxPerStageDescriptorStorageBuffers of 6 or more: it has 4");
  forged = device().limits();
  forged.maxComputeWorkGroupInvocations = 32;
  EXPECT_EQ(gpu::lacks(forged), "maxComputeWorkGroupInvocations of 64 or more: it has 32");
}

TEST_F(Devices, WithoutADriverAreAMachineErrorInOneLine) {
  const std::string driver = std::getenv("VK_ICD_FILENAMES");
  setenv("VK_ICD_FILENAMES", "/nowhere.json", 1);
  ::testing::internal::CaptureStderr();
  const std::string listing = machine_error([] { (void)gpu::list_devices(); });
  const std::string opening = machine_error([] { gpu::Device device; });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "the loader prints beside the message";
  setenv("VK_ICD_FILENAMES", driver.c_str(), 1);
  for (const std::string& message : {listing, opening})
    EXPECT_THAT(message, AllOf(HasSubstr("no Vulkan driver is installed"), Not(HasSubstr("\n"))));
}

TEST_F(Devices, ThatFailSayHow) {
  const auto message = [](VkResult result) {
    return machine_error([=] { gpu::check(result, "render a tile"); });
  };
  EXPECT_THAT(message(VK_ERROR_DEVICE_LOST), HasSubstr("cannot render a tile: the device was lost"));
  EXPECT_THAT(message(VK_ERROR_OUT_OF_DEVICE_MEMORY), HasSubstr("not enough memory on the device"));
  EXPECT_THAT(message(VK_ERROR_FEATURE_NOT_PRESENT), HasSubstr("the driver lacks a feature"));
  EXPECT_THAT(message(VK_ERROR_UNKNOWN), HasSubstr("the driver failed (VkResult -13)"));
  EXPECT_EQ(message(VK_SUCCESS), "no MachineError");
}

TEST_F(Devices, WithoutEnoughMemorySaySo) {
  const gpu::Device unwatched; // the validation layer has its own opinion of such sizes
  EXPECT_THAT(machine_error([&] { gpu::Buffer(unwatched, std::size_t{1} << 60, gpu::Residence::device); }),
              HasSubstr("allocate 1152921504606846976 bytes"));
}

TEST_F(Devices, AreWatchedByTheValidationLayer) {
  const gpu::Device watched({.validate = true});
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = 0; // what Vulkan forbids
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(watched.get(), &info, nullptr, &buffer) == VK_SUCCESS)
    vkDestroyBuffer(watched.get(), buffer, nullptr);
  EXPECT_THAT(watched.messages(), Contains(HasSubstr("VUID-VkBufferCreateInfo-size-00912")));
}

} // namespace
} // namespace surfgrad::test
