#pragma once
// The passes and the memory that a frame's path asks for, made once for all frames of one sensor, its light
// and scene.

#include "engine/frame/frame_facts.h"
#include "engine/frame/frame_path.h"
#include "engine/frame/spot_check.h"
#include "engine/frame/uniform_pixels_pass.h"
#include "engine/light/accumulate_pass.h"
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

// A class of pixels summed sample by sample.
struct ClassPasses {
  AccumulatePass sum;
  ResolvePass resolve;
};

// Passes of pixels that are sorted into classes.
struct SortedPasses {
  PixelLists lists;
  ShortWay uniform; // sorts, and sums PixelsOf::uniform
  std::optional<ShortWay> refined;
  std::optional<PointsPass> points; // where not every sample's point is made
};

struct FramePasses {
  FramePath path;
  Sensor sensor;
  Signal signal;
  std::vector<PlannedStrip> strips;
  SceneBuffers scene;
  StripBuffers buffers;
  VisibilityPass raster;
  std::variant<std::monostate, PointsPass, SearchPass> points; // of every sample, without and with distortion
  DiodeGroups groups;                                          // of all sources
  std::vector<LitWindow> windows;                              // one where there are no visibility bits
  std::optional<LitPass> shadow;
  std::optional<SortedPasses> sorted;
  std::optional<ClassPasses> all, unshadowed, rest; // as PixelsOf
  std::optional<TruthOfRecords> truth;              // nothing where it comes in channels
  std::optional<ExactCheck> check;
  AccuracyReport report; // what is known before the frame
};

// Device memory of passes that are done with, for those that come next.
struct SpareMemory {
  StripBuffers buffers;
  std::optional<RasterImages> images;
};

// As the `attempt`-th of frame_plans has it. Throws Error: out_of_memory, accuracy.
FramePasses make_passes(const vulkan::Device &device, const SimulatorOptions &options,
                        const FrameRequest &request, std::uint32_t attempt, TextureCache &textures,
                        SpareMemory &&spare);

} // namespace pmdsim
