#pragma once
// The pipelines that a device has compiled. Drivers take tens to hundreds of milliseconds for a frame's, and
// the next frame asks for the same ones.

#include "engine/vulkan/specialization.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

struct Pipeline {
  vk::raii::PipelineLayout layout = nullptr;
  vk::raii::Pipeline pipeline = nullptr;
};

struct PipelineKey {
  const std::uint32_t *spirv; // lives as long as the program
  Specialization constants;
  vk::Format drawn{}; // of graphics pipelines

  auto operator<=>(const PipelineKey &) const = default;
};

class PipelineCache {
public:
  // The pipeline of such a shader; `make` compiles it where it is not known yet.
  std::shared_ptr<const Pipeline> get(const PipelineKey &key, const std::function<Pipeline()> &make);

private:
  std::map<PipelineKey, std::shared_ptr<const Pipeline>> pipelines_;
};

} // namespace pmdsim::vulkan
