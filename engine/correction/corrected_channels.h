#pragma once
// The channels that `pmdsim correct` writes, beside those of a measurement (engine/model/channels.h).

#include <array>
#include <string_view>

namespace pmdsim {

struct CorrectedChannelRow {
  std::string_view name; // in files
  std::string_view unit; // "" for the status
  std::string_view about;
};

// In the order of files.
inline constexpr auto corrected_channel_rows = std::to_array<CorrectedChannelRow>({
    {"range_m", "m", "distance to the lens, along the pixel's ray, corrected"},
    {"x_m", "m", "the corrected point in the camera frame, to the right"},
    {"y_m", "m", "the corrected point in the camera frame, down"},
    {"z_m", "m", "the corrected point in the camera frame, along the optical axis"},
    {"correction_mm", "mm", "measured distance minus range"},
    {"normal_error_mm", "mm",
     "how far the range may be off by the surface's normal, or as the pixel mixes surfaces, estimated"},
    {"status", "", "0 corrected, 1 corrected at an edge, 2 not measured, 3 no light, 4 not converged"},
});

} // namespace pmdsim
