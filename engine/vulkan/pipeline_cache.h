#pragma once
// The pipelines that a device has compiled. Drivers take tens to hundreds of milliseconds for a frame's, and
// the next frame asks for the same ones.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

// Specialization constants: the value of constant_id i stands at index i.
using Specialization = std::vector<std::uint32_t>;

struct Pipeline {
  vk::raii::PipelineLayout layout = nullptr;
  vk::raii::Pipeline pipeline = nullptr;
};

class PipelineCache {
public:
  // The pipeline of this shader, which lives as long as the program, with these constants; `make` compiles it
  // where it is not known yet.
  std::shared_ptr<const Pipeline> get(const std::uint32_t *spirv, const Specialization &constants,
                                      const std::function<Pipeline()> &make);

private:
  std::map<std::pair<const std::uint32_t *, Specialization>, std::shared_ptr<const Pipeline>> pipelines_;
};

} // namespace pmdsim::vulkan
