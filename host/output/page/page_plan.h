#pragma once
// What of a run a page has room for.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim {

// Every `frame_step`-th frame from the first on, and of these every `pixel_step`-th pixel of every
// `pixel_step`-th row: values of the files, never means. Without `has_raw` the camera's single images are
// left out.
struct PagePlan {
  std::uint32_t frame_step = 1, pixel_step = 1;
  bool has_raw = true;

  bool operator==(const PagePlan &) const = default;
};

// What one sensor's frames would take, in bytes of the page.
struct SensorSize {
  std::size_t frames = 0, columns = 0, rows = 0;
  double raw_bytes = 0.0, other_bytes = 0.0; // of one whole frame: the single images, and all else
};

// The plan that leaves out least, of those of at most `max_bytes`: first the single images go, then frames
// down to 16, then pixels. The smallest there is where none fits.
PagePlan plan_for(const std::vector<SensorSize> &sensors, double max_bytes);

// What it leaves out, a sentence each.
std::vector<std::string> left_out_text(const PagePlan &plan, std::size_t frames,
                                       const std::vector<std::string> &raw_channels);

} // namespace pmdsim
