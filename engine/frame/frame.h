#pragma once
// How a frame is measured: its passes as a list, strip by strip.

#include "engine/frame/frame_passes.h"

#include <functional>
#include <optional>
#include <string>

namespace pmdsim {

class Frame {
public:
  // Made by the `attempt`-th of frame_plans plans. Throws Error: out_of_memory, accuracy.
  Frame(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request,
        std::uint32_t attempt, TextureCache &textures, SpareMemory &&spare);

  const FramePath &path() const { return on_.path; }

  // Compiles what the driver leaves to a first dispatch.
  void warm_up(vulkan::PassRecorder &recorder) const;
  // Measures into `memory`, whatever that holds; the same bits at every call. `progress` is told the fraction
  // done, 0 to 1, and may throw. Throws Error: out_of_memory, device_lost, input (more light returns than a
  // float holds).
  Measurement measure(vulkan::PassRecorder &recorder, Measurement &&memory,
                      const std::function<void(double)> &progress, const ExposureNumber &number) const;
  // Why some pixels of the last frame may be off by more than was asked for; and why pixels that were checked
  // are, although they should not be. Nothing where none are.
  std::optional<std::string> beyond_bound() const;
  std::optional<std::string> beyond_check(const Measurement &measured) const;
  // Whether a pixel that float is not exact enough for has been summed as exactly as can be.
  bool is_most_exact() const;

  // The frame is of no use afterwards.
  SpareMemory release_memory() {
    return {std::move(on_.memory->buffers), on_.raster ? on_.raster->release_images() : std::nullopt};
  }

private:
  void clear_violations(vulkan::PassRecorder &recorder) const;
  void finish_visibility(Measurement &measurement) const;
  void finish_claims(Measurement &measurement) const;
  void check_strip(vulkan::PassRecorder &recorder, std::size_t strip, Measurement &measurement) const;

  SimulatorOptions options_;
  Shadows shadows_;
  Accuracy accuracy_;
  FramePasses on_;
};

} // namespace pmdsim
