#pragma once
// A buffer with its own memory.

#include "engine/vulkan/device.h"

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

enum class Memory {
  device, // fast for the device; shaders reach it by its address
  upload, // written by the host once
  read,   // read by the host
};

class Buffer {
public:
  Buffer() = default;
  // `bytes` may be 0, then nothing is allocated. Throws Error (out_of_memory), also beyond the device's
  // limit.
  Buffer(const Device &device, vk::DeviceSize bytes, vk::BufferUsageFlags usage, Memory memory);
  // Moving leaves handles valid; the mapping stays with the memory.
  Buffer(Buffer &&) = default;
  Buffer &operator=(Buffer &&) = default;

  vk::Buffer get() const { return *buffer_; }
  vk::DeviceSize bytes() const { return bytes_; }
  vk::DeviceMemory memory() const { return *memory_; } // the buffer's alone, from its beginning
  std::uint32_t memory_type() const { return memory_type_; }
  // The address of what lies `offset` bytes from its beginning, as shaders take it: low word, high word. Only
  // Memory::device has one.
  glm::uvec2 words(vk::DeviceSize offset = 0) const {
    const vk::DeviceAddress at = address_ + offset;
    return {static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(at >> 32)};
  }
  // True with upload and read; with device, too, where the host reads the device's memory as its own.
  bool is_mapped() const { return mapped_ != nullptr; }
  std::span<std::byte> mapped() const { return {mapped_, static_cast<std::size_t>(bytes_)}; }

  // The mapped memory, from its beginning, as values of T.
  template <class T>
  T *mapped_as() const {
    return reinterpret_cast<T *>(mapped_);
  }

private:
  vk::DeviceSize bytes_ = 0;
  std::uint32_t memory_type_ = 0;
  vk::raii::DeviceMemory memory_ = nullptr; // before the buffer: destroyed after it
  vk::raii::Buffer buffer_ = nullptr;
  vk::DeviceAddress address_ = 0;
  std::byte *mapped_ = nullptr;
};

// A device buffer that holds `data`, for shaders by its address and for whatever `usage` adds; waits until it
// is there.
Buffer upload(const Device &device, std::span<const std::byte> data, vk::BufferUsageFlags usage = {});
template <class T>
Buffer upload(const Device &device, const std::vector<T> &values) {
  return upload(device, std::as_bytes(std::span(values)));
}
template <class T>
Buffer upload_texels(const Device &device, const std::vector<T> &texels) {
  return upload(device, std::as_bytes(std::span(texels)), vk::BufferUsageFlagBits::eUniformTexelBuffer);
}

} // namespace pmdsim::vulkan
