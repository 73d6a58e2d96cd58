#pragma once
// What `render` has of one setup and of variants.

#include "host/capture/capture.h"
#include "host/command_line/options.h"

#include <cstddef>
#include <nlohmann/json.hpp>

namespace pmdsim {

// A frame of --json. Beside its own files it names the manifest, which says how to read them.
nlohmann::ordered_json frame_told(const nlohmann::ordered_json &of_sensor, const FrameSequence &sequence);

std::size_t bytes_of_rendered_frame(const Capture &capture);

// `render` of several setups, or of variants.
void run_variants(const Options &options);

} // namespace pmdsim
