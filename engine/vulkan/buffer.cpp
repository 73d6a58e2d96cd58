#include "engine/vulkan/buffer.h"

#include "engine/vulkan/commands.h"
#include "engine/vulkan/errors.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace pmdsim::vulkan {
namespace {

using Property = vk::MemoryPropertyFlagBits;

std::uint32_t choose_memory_type(const Device &device, std::uint32_t allowed, Memory memory) {
  const vk::MemoryPropertyFlags host = Property::eHostVisible | Property::eHostCoherent;
  switch (memory) {
  case Memory::device:
    return device.memory_type(allowed, Property::eDeviceLocal, {});
  case Memory::upload:
    return device.memory_type(allowed, host, host);
  case Memory::read:
    return device.memory_type(allowed, host | Property::eHostCached, host);
  }
  throw std::logic_error("unknown kind of memory");
}

} // namespace

Buffer::Buffer(const Device &device, vk::DeviceSize bytes, vk::BufferUsageFlags usage, Memory memory)
    : bytes_(bytes) {
  if (bytes == 0)
    return;
  const bool addressed = memory == Memory::device;
  if (addressed)
    usage |= vk::BufferUsageFlagBits::eShaderDeviceAddress;
  if ((usage & vk::BufferUsageFlagBits::eStorageBuffer) && bytes > device.limits().storage_bytes)
    throw Error(ExitCode::out_of_memory, "a storage buffer of " + std::to_string(bytes) +
                                             " bytes is beyond the device's limit of " +
                                             std::to_string(device.limits().storage_bytes));
  checked([&] {
    buffer_ = vk::raii::Buffer(device.get(), vk::BufferCreateInfo({}, bytes, usage));
    const vk::MemoryRequirements needs = buffer_.getMemoryRequirements();
    const vk::MemoryAllocateFlagsInfo flags(addressed ? vk::MemoryAllocateFlagBits::eDeviceAddress
                                                      : vk::MemoryAllocateFlags());
    memory_type_ = choose_memory_type(device, needs.memoryTypeBits, memory);
    memory_ = vk::raii::DeviceMemory(device.get(), vk::MemoryAllocateInfo(needs.size, memory_type_, &flags));
    buffer_.bindMemory(*memory_, 0);
    if (addressed)
      address_ = device.get().getBufferAddress(vk::BufferDeviceAddressInfo(*buffer_));
    if (!addressed || device.is_fast_for_the_host(memory_type_))
      mapped_ = static_cast<std::byte *>(memory_.mapMemory(0, bytes));
  });
}

Buffer upload(const Device &device, std::span<const std::byte> data, vk::BufferUsageFlags usage) {
  using Usage = vk::BufferUsageFlagBits;
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  constexpr std::size_t staging_bytes = std::size_t{16} << 20;
  Buffer target(device, data.size(), usage | Usage::eTransferDst, Memory::device);
  const Buffer staging(device, std::min(data.size(), staging_bytes), Usage::eTransferSrc, Memory::upload);
  Commands commands(device);
  for (std::size_t done = 0; done < data.size(); done += staging_bytes) {
    const std::size_t part = std::min(staging_bytes, data.size() - done);
    std::memcpy(staging.mapped().data(), data.data() + done, part);
    const auto &recorded = commands.begin();
    recorded.copyBuffer(staging.get(), target.get(), vk::BufferCopy(0, done, part));
    memory_barrier(recorded, Stage::eTransfer, Access::eTransferWrite,
                   Stage::eVertexAttributeInput | Stage::eVertexShader | Stage::eFragmentShader |
                       Stage::eComputeShader,
                   Access::eVertexAttributeRead | Access::eShaderStorageRead | Access::eShaderSampledRead);
    commands.submit_and_wait();
  }
  return target;
}

} // namespace pmdsim::vulkan
