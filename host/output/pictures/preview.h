#pragma once
// A channel as a picture: colours, axes in pixels, a colour bar with its unit, and grey where there is no
// value.

#include "engine/model/channels.h"
#include "host/output/pictures/canvas.h"

#include <span>
#include <string>
#include <vector>

namespace pmdsim {

// The picture's image area: at most 1024 pixels a side (whole blocks of pixels averaged, for `turn` their
// first taken, since angles do not average), small frames enlarged by a whole factor.
struct PreviewImage {
  glm::uvec2 resolution;     // of `values`
  std::vector<float> values; // NaN where a block holds no value
  std::uint32_t enlargement; // picture pixels a value
};

PreviewImage preview_image(std::span<const float> values, const glm::uvec2 &resolution, ColourScale scale);

// The values that the ends of the colour bar stand for; of positive span, for constant and for empty images
// too.
Range preview_range(std::span<const float> values, ColourScale scale);

// `values` is row-major, rows * columns values, NaN for none.
Canvas draw_preview(std::span<const float> values, const glm::uvec2 &resolution, const Preview &preview,
                    const std::string &unit, const std::string &title);

} // namespace pmdsim
