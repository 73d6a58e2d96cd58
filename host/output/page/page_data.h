#pragma once
// A run's frames as a page carries them: a description in JSON, and blocks of packed values.

#include "host/output/page/page_plan.h"
#include "host/output/page/run_content.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

struct PageData {
  // Of each sensor {"name", "frames": for each {"frame", "entry": the manifest's, "columns", "rows": of the
  // values that are here, "channels", and what times_of() gives}}. A channel has "name", "unit", "kind"
  // ("f4", "f8", "u4": little-endian), "block": the number of its values, the words of words_of(), and of
  // floats "range" (of all but the outermost 0.5 % on either side), "extent" (least and greatest value; null
  // where there is none).
  nlohmann::ordered_json sensors;
  std::vector<std::string> blocks; // as packed() makes them
  std::size_t block_bytes = 0;
  PagePlan plan;
  std::size_t frames = 0;  // of the run, whichever sensor has most
  ChannelsByRank channels; // of the run's first frames
};

// What the blocks may take: as far as plan_for() can, and at all, as later frames may be larger than the
// first.
struct PageRoom {
  std::size_t wanted_bytes, most_bytes;
};

// `check` is called now and then; what it throws comes out.
// Throws Error (input) that names the file that cannot be read, or the run whose later frames are far too
// large.
PageData page_data(const RunContent &run, const PageRoom &room, const std::function<void()> &check);

} // namespace pmdsim
