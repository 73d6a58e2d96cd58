#pragma once
// The short way: pixels of one surface that every diode lights, from their tags to their channels in one
// pass, at one place or, in a pass of its own, at four. The others are listed (pixel_lists.h).

#include "engine/error_budget/quadrature_bound.h"
#include "engine/light/accumulate_pass.h"
#include "engine/model/error_bound.h"
#include "engine/model/simulator_options.h"
#include "engine/sampling/pixel_lists.h"
#include "engine/view/surface_appearance.h"

namespace pmdsim {

struct ShortWayOptions {
  bool painted = false; // shapes have paint
  std::uint32_t places =
      0;                   // at which a pixel of several samples may be evaluated: none, 1, or 4 for list_few
  bool few_follow = false; // pixels for which one place is not enough are listed for four
  bool sums = true;        // false: the pass only lists pixels
  bool lists = true;       // false: it takes all, and none can break the promise
};

class ShortWay {
public:
  // `groups` stand in for all diodes. `lists` are those that it will be used with.
  ShortWay(const vulkan::Device &device, const Sensor &sensor, const DiodeGroups &groups,
           const LightExtent &extent, const SumModel &model, const Signal &signal, const Promise &promise,
           const SimulatorOptions &options, const ShortWayOptions &ways, const PixelLists &lists);

  // Needs the strip's tags and, where Signal::lit, how many diodes reach each sample. Of four places, `few`
  // is list_few, counted.
  void record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
              const StripBuffers &buffers, const SceneBuffers &scene,
              const vulkan::Buffer *few = nullptr) const;

private:
  shader::vec4 slope_;
  vulkan::Buffer chip_, diodes_, diagrams_, light_, work_;
  vulkan::ComputePipeline pipeline_;
};

} // namespace pmdsim
