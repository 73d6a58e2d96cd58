#pragma once
// How a frame is measured: its passes as a list, strip by strip.

#include "engine/frame/frame_passes.h"

#include <functional>
#include <optional>
#include <string>

namespace pmdsim {

class Frame {
public:
  // As the `attempt`-th of frame_plans has it. Throws Error: out_of_memory, accuracy.
  Frame(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request,
        std::uint32_t attempt, TextureCache &textures, SpareMemory &&spare);

  const FramePath &path() const { return on_.path; }

  // Compiles what the driver leaves to a first dispatch.
  void warm_up(vulkan::PassRecorder &recorder) const;
  // Into `memory`, whatever that holds; the same bits at every call. `progress` hears how much is done, 0 to
  // 1, and may throw. Throws Error: out_of_memory, device_lost, input (more light returns than a float
  // holds).
  Measurement measure(vulkan::PassRecorder &recorder, Measurement &&memory,
                      const std::function<void(double)> &progress, const ExposureNumber &number) const;
  // Why some pixels of the last frame may be off by more than was asked for, if so; and why those that shall
  // not be, are, as far as they were checked.
  std::optional<std::string> beyond_bound() const;
  std::optional<std::string> beyond_check(const Measurement &measured) const;
  // Whether a pixel that float is not exact enough for has been summed as exactly as can be.
  bool is_most_exact() const;

  // After it the frame is of no use any more.
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
