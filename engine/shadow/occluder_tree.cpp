#include "engine/shadow/occluders.h"

#include "engine/model/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <embree3/rtcore.h>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace pmdsim {
namespace {

// What Embree builds; its memory belongs to the RTCBVH.
struct BuiltNode {
  std::array<BuiltNode *, 2> children{}; // of an inner node
  std::array<RTCBounds, 2> bounds{};     // of its children
  std::optional<unsigned> occluder;      // of a leaf
};

template <typename T>
T *allocate(RTCThreadLocalAllocator allocator) {
  return new (rtcThreadLocalAlloc(allocator, sizeof(T), alignof(T))) T;
}

void *create_node(RTCThreadLocalAllocator allocator, unsigned, void *) {
  return allocate<BuiltNode>(allocator);
}

void set_children(void *node, void **children, unsigned, void *) {
  static_cast<BuiltNode *>(node)->children = {static_cast<BuiltNode *>(children[0]),
                                              static_cast<BuiltNode *>(children[1])};
}

void set_bounds(void *node, const RTCBounds **bounds, unsigned, void *) {
  static_cast<BuiltNode *>(node)->bounds = {*bounds[0], *bounds[1]};
}

void *create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive *primitives, std::size_t,
                  void *) {
  auto *leaf = allocate<BuiltNode>(allocator);
  leaf->occluder = primitives->primID;
  return leaf;
}

float rounded_down(float a) { return std::nextafter(a, -std::numeric_limits<float>::infinity()); }
float rounded_up(float a) { return std::nextafter(a, std::numeric_limits<float>::infinity()); }

RTCBuildPrimitive primitive_of(const shader::Occluder &occluder, unsigned index) {
  const glm::vec4 low = glm::min(glm::min(occluder.a_hi, occluder.b_hi), occluder.c_hi);
  const glm::vec4 high = glm::max(glm::max(occluder.a_hi, occluder.b_hi), occluder.c_hi);
  return {rounded_down(low.x), rounded_down(low.y), rounded_down(low.z), 0,
          rounded_up(high.x),  rounded_up(high.y),  rounded_up(high.z),  index};
}

class Layout {
public:
  explicit Layout(std::span<const shader::Occluder> occluders) : occluders_(occluders) {}

  // The node and all below it.
  void add(const BuiltNode &built, const RTCBounds &bounds) {
    const std::size_t at = tree_.nodes.size();
    tree_.nodes.push_back({bounds.lower_x, bounds.lower_y, bounds.lower_z, 0, bounds.upper_x, bounds.upper_y,
                           bounds.upper_z, shader::no_occluder});
    if (built.occluder) {
      tree_.nodes[at].occluder = static_cast<std::uint32_t>(tree_.occluders.size());
      tree_.occluders.push_back(occluders_[*built.occluder]);
    } else {
      for (std::size_t i = 0; i < 2; ++i)
        add(*built.children[i], built.bounds[i]);
    }
    tree_.nodes[at].skip = static_cast<std::uint32_t>(tree_.nodes.size());
  }

  OccluderTree take() { return std::move(tree_); }

private:
  std::span<const shader::Occluder> occluders_;
  OccluderTree tree_;
};

RTCBounds bounds_of(std::span<const RTCBuildPrimitive> primitives) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  RTCBounds all{infinity, infinity, infinity, 0, -infinity, -infinity, -infinity, 0};
  for (const RTCBuildPrimitive &primitive : primitives) {
    all.lower_x = std::min(all.lower_x, primitive.lower_x);
    all.lower_y = std::min(all.lower_y, primitive.lower_y);
    all.lower_z = std::min(all.lower_z, primitive.lower_z);
    all.upper_x = std::max(all.upper_x, primitive.upper_x);
    all.upper_y = std::max(all.upper_y, primitive.upper_y);
    all.upper_z = std::max(all.upper_z, primitive.upper_z);
  }
  return all;
}

RTCBuildArguments arguments_for(RTCBVH bvh, std::vector<RTCBuildPrimitive> &primitives) {
  RTCBuildArguments arguments = rtcDefaultBuildArguments();
  arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
  arguments.maxBranchingFactor = 2;
  arguments.maxDepth = 128;
  arguments.minLeafSize = 1;
  arguments.maxLeafSize = 1;
  arguments.bvh = bvh;
  arguments.primitives = primitives.data();
  arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
  arguments.createNode = create_node;
  arguments.setNodeChildren = set_children;
  arguments.setNodeBounds = set_bounds;
  arguments.createLeaf = create_leaf;
  return arguments;
}

} // namespace

OccluderTree build_tree(const std::vector<shader::Occluder> &occluders) {
  if (occluders.empty())
    return {};
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(occluders.size());
  for (const shader::Occluder &occluder : occluders)
    primitives.push_back(primitive_of(occluder, static_cast<unsigned>(primitives.size())));
  const RTCBounds all = bounds_of(primitives);
  const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice(nullptr),
                                                                         rtcReleaseDevice);
  const std::unique_ptr<RTCBVHTy, decltype(&rtcReleaseBVH)> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
  const RTCBuildArguments arguments = arguments_for(bvh.get(), primitives);
  const auto *root = static_cast<const BuiltNode *>(rtcBuildBVH(&arguments));
  if (!root)
    throw Error(ExitCode::out_of_memory, "shadows: expected enough memory for the tree over " +
                                             std::to_string(occluders.size()) + " triangles");
  Layout layout(occluders);
  layout.add(*root, all);
  return layout.take();
}

} // namespace pmdsim
