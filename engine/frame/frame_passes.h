#pragma once
// The passes of a frame as a written list, and the memory in which they meet, as the frame's path asks for
// them; made once for all frames of one sensor, its light and scene.

#include "engine/frame/frame_facts.h"
#include "engine/frame/frame_graph.h"
#include "engine/frame/frame_path.h"
#include "engine/frame/spot_check.h"
#include "engine/view/id_raster_pass.h"

#include <memory>
#include <optional>
#include <vector>

namespace pmdsim {

struct FrameMemory {
  StripBuffers buffers;
  SceneBuffers scene;
};

struct FramePasses {
  FramePath path;
  Sensor sensor;
  Modulation modulation;
  std::vector<PlannedStrip> strips;
  std::size_t windows;                         // of visibility bits; 1 where there are none
  std::shared_ptr<const SourceGroups> sources; // all of them
  std::unique_ptr<FrameMemory> memory;
  std::shared_ptr<IdRasterPass> raster; // nothing where the host draws
  std::optional<SpotCheck> check;
  AccuracyReport report; // what is known before the frame
  FrameGraph graph{};
  FrameGraph check_graph{ids | points | visibility_bits | visibility_counts}; // over a strip that is stored
};

// Device memory of passes that are done with, for those that come next.
struct SpareMemory {
  StripBuffers buffers;
  std::optional<RasterImages> images;
};

// Made by the `attempt`-th of frame_plans plans. Throws Error: out_of_memory, accuracy.
FramePasses make_passes(const vulkan::Device &device, const SimulatorOptions &options,
                        const FrameRequest &request, std::uint32_t attempt, TextureCache &textures,
                        SpareMemory &&spare);

} // namespace pmdsim
