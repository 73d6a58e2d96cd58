#pragma once
// A frame as `render` leaves it: every channel of what was measured.

#include "host/capture/exposure.h"
#include "host/capture/frame_sequence.h"
#include "host/options.h"

#include <memory>
#include <set>

namespace pmdsim {

// Its files hold on to `taken`.
MeasuredPart rendered_frame(const std::shared_ptr<const TakenFrame> &taken, const SensorFrame &at,
                            const std::set<Format> &formats);

// Of the setup's largest frame.
std::size_t bytes_of_rendered_frame(const Setup &setup);

} // namespace pmdsim
