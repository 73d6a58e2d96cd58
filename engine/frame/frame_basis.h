#pragma once
// The basis of everything that is made for a frame.

#include "engine/error_budget/plan.h"
#include "engine/frame/frame_facts.h"
#include "engine/frame/frame_path.h"
#include "engine/light/accumulate_pass.h"

#include <vector>

namespace pmdsim {

struct FrameBasis : PassSetup {
  const FrameRequest &request;
  const FrameFacts &facts;
  const FramePlan &plan;
  const FramePath &path;
  const std::vector<PlannedStrip> &strips;
  const std::vector<SourceWindow> &windows; // of visibility bits
};

} // namespace pmdsim
