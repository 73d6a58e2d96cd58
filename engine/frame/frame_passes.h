#pragma once
// All that the frames of one sensor, its light and scene need on the device.

#include "engine/error_budget/plan.h"
#include "engine/frame/spot_check.h"
#include "engine/frame/uniform_pixels_pass.h"
#include "engine/light/accumulate_pass.h"
#include "engine/model/accuracy.h"
#include "engine/model/shadows.h"
#include "engine/sampling/strip_memory.h"
#include "engine/shadow/tile_shadow_pass.h"
#include "engine/signal/read_back.h"
#include "engine/signal/resolve_pass.h"
#include "engine/view/id_raster_pass.h"
#include "engine/view/lens_search_pass.h"
#include "engine/view/points_pass.h"

#include <optional>
#include <variant>

namespace pmdsim {

// What is measured, and how well. The references outlive the preparation only.
struct FrameRequest {
  const Scene &scene;
  const Sensor &sensor;
  const std::vector<Illuminator> &illuminators;
  Backscatter backscatter;
  Shadows shadows;
  Accuracy accuracy;
};

// The passes of a frame in which few diodes or one place may stand in for many.
struct ListedPasses {
  PixelLists lists;
  ShortWay short_way;
  std::optional<ShortWay> few_places; // of list_few
  std::optional<PointsPass> points;   // where not every sample's point is made
  bool has_lit;                       // pixels in list_lit, which the two below sum
  AccumulatePass accumulate;          // stand-ins
  ResolvePass resolve;
};

struct FramePasses {
  Sensor sensor;
  Signal signal;
  std::vector<PlannedStrip> strips;
  SceneBuffers scene;
  StripBuffers buffers;
  VisibilityPass visibility;
  std::variant<std::monostate, PointsPass, SearchPass> points; // of every sample, without and with distortion
  Shadows shadows;
  Accuracy accuracy;
  DiodeGroups groups; // of all diodes
  std::vector<LitWindow> windows;
  std::optional<LitPass> lit;         // nothing where every diode reaches whatever is seen
  std::optional<ListedPasses> listed; // nothing where every sample is summed in the same way
  bool has_rest;                      // samples that the two below sum: list_rest, or all
  AccumulatePass accumulate;
  ResolvePass resolve;
  std::optional<TruthOfRecords> truth; // nothing where it comes in channels
  std::optional<ExactCheck> check;
  AccuracyReport report; // what is known before the frame
};

// Device memory of passes that are done with, for those that come next.
struct SpareMemory {
  StripBuffers buffers;
  std::optional<RasterImages> images;
};

SpareMemory release_memory(FramePasses &&passes);

// As the `attempt`-th of frame_plans has it. Throws Error: out_of_memory, accuracy.
FramePasses prepare_passes(const vulkan::Device &device, const SimulatorOptions &options,
                           const FrameRequest &request, std::uint32_t attempt, TextureCache &textures,
                           SpareMemory &&spare);

} // namespace pmdsim
