// Images that lie on a buffer.

#include "engine/vulkan/image.h"
#include "tests/vulkan/lavapipe.h"

#include <catch2/catch.hpp>

using namespace pmdsim::vulkan;

namespace {

// Whether there is an image of 16 bytes a pixel on a buffer with room for `rows` of its rows.
bool lies_on_buffer(const Device &device, vk::Extent2D extent, std::uint32_t rows) {
  const Buffer buffer(device, vk::DeviceSize{16} * extent.width * rows,
                      vk::BufferUsageFlagBits::eStorageBuffer, Memory::device);
  return Image::on_buffer(device, extent, vk::Format::eR32G32B32A32Uint,
                          vk::ImageUsageFlagBits::eColorAttachment, buffer)
      .has_value();
}

} // namespace

TEST_CASE(
    "on lavapipe an image lies on a buffer where its rows have no gaps and there is room for fours of them") {
  const Instance instance(pmdsim::Validation::none);
  int tested = 0;
  for (auto &physical : instance.devices()) {
    if (!pmdsim::test::is_lavapipe(physical))
      continue;
    ++tested;
    const Device device(instance, physical);
    CHECK(lies_on_buffer(device, {640, 640}, 640));
    CHECK(lies_on_buffer(device, {252, 190}, 192));
    CHECK_FALSE(lies_on_buffer(device, {252, 190}, 190));
    CHECK_FALSE(lies_on_buffer(device, {253, 192}, 200)); // gaps
    CHECK_FALSE(lies_on_buffer(device, {40000, 4}, 4));   // no such image
  }
  if (tested == 0)
    WARN("no lavapipe: nothing tested");
}
