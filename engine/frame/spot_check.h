#pragma once
// A random set of a frame's pixels, evaluated again with every sample and every diode: what the frame is off
// by.

#include "engine/light/accumulate_pass.h"
#include "engine/model/accuracy.h"
#include "engine/model/measurement.h"
#include "engine/signal/resolve_pass.h"
#include "engine/view/points_pass.h"

#include <optional>
#include <vector>

namespace pmdsim {

class ExactCheck {
public:
  struct Scope {
    Precision precision; // of `groups`, which hold every diode
    bool makes_points;   // else the sample's points are there
    bool painted;
  };
  // The pixels are the same for every frame of a resolution.
  ExactCheck(const vulkan::Device &device, const Sensor &sensor, const std::vector<PlannedStrip> &strips,
             const Signal &signal, const SumModel &model, DiodeGroups groups, const SimulatorOptions &options,
             const Scope &scope);

  std::size_t pixels() const { return pixels_; }
  const DiodeGroups &groups() const { return groups_; }
  const AccumulatePass &sum() const { return sum_; }
  const ResolvePass &resolve() const { return resolve_; }
  const vulkan::Buffer &list() const { return list_; }

  // Makes the list of the strip's pixels and their samples' points; after it comes the sum, then the
  // channels.
  void record_points(const vk::raii::CommandBuffer &commands, std::size_t strip, const PlannedStrip &planned,
                     const StripBuffers &buffers, const SceneBuffers &scene) const;
  // Largest difference of the measured strip from the channels that were read back.
  void compare(std::size_t strip, const PlannedStrip &planned, const StripBuffers &buffers,
               const Measurement &measured, AccuracyReport &report) const;

private:
  Signal signal_;
  std::size_t pixels_;
  std::vector<std::vector<std::uint32_t>> of_strip_; // pixels, counted within the strip
  DiodeGroups groups_;
  vulkan::Buffer list_;
  std::optional<PointsPass> points_;
  AccumulatePass sum_;
  ResolvePass resolve_;
};

} // namespace pmdsim
