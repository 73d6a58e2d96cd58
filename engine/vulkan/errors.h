#pragma once
// Vulkan's failures as our errors, so that nothing outside this folder names a Vulkan type.

#include "engine/model/error.h"

#include <string>
#include <type_traits>
#include <utility>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

// Runs `work` and turns what Vulkan throws into an Error: out of memory, device lost (or failed in a way that
// has no name), or no usable device. Any other exception is a mistake of ours and stays a std::exception.
template <typename Work>
auto checked(Work &&work) -> decltype(work()) {
  try {
    return std::forward<Work>(work)();
  } catch (const vk::OutOfHostMemoryError &error) {
    throw Error(ExitCode::out_of_memory, std::string("out of host memory: ") + error.what());
  } catch (const vk::OutOfDeviceMemoryError &error) {
    throw Error(ExitCode::out_of_memory, std::string("out of device memory: ") + error.what());
  } catch (const vk::DeviceLostError &error) {
    throw Error(ExitCode::device_lost, std::string("the device was lost: ") + error.what());
  } catch (const vk::IncompatibleDriverError &) {
    throw Error(ExitCode::no_device, "no Vulkan device: no driver answered; expected one with Vulkan 1.3");
  } catch (const vk::InitializationFailedError &error) {
    throw Error(ExitCode::no_device, std::string("the Vulkan device does not start: ") + error.what());
  } catch (const vk::MemoryMapFailedError &error) {
    throw Error(ExitCode::out_of_memory, std::string("device memory cannot be mapped: ") + error.what());
  } catch (const vk::TooManyObjectsError &error) {
    throw Error(ExitCode::out_of_memory, std::string("too many allocations on the device: ") + error.what());
  } catch (const vk::OutOfPoolMemoryError &error) {
    throw Error(ExitCode::out_of_memory, std::string("out of the device's pool memory: ") + error.what());
  } catch (const vk::SystemError &error) { // a device that answers so is of no more use than a lost one
    throw Error(ExitCode::device_lost, std::string("the device failed: ") + error.what());
  }
}

} // namespace pmdsim::vulkan
