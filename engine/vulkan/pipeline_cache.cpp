#include "engine/vulkan/pipeline_cache.h"

namespace pmdsim::vulkan {
namespace {

// Constants follow the scene, so a scene in motion asks for other pipelines now and then.
constexpr std::size_t capacity = 64;

} // namespace

std::shared_ptr<const Pipeline> PipelineCache::get(const PipelineKey &key,
                                                   const std::function<Pipeline()> &make) {
  if (const auto known = pipelines_.find(key); known != pipelines_.end())
    return known->second;
  if (pipelines_.size() >= capacity)
    std::erase_if(pipelines_, [](const auto &entry) { return entry.second.use_count() == 1; });
  return pipelines_[key] = std::make_shared<const Pipeline>(make());
}

} // namespace pmdsim::vulkan
