#pragma once
// A channel as a picture: colours, axes in pixels, a colour bar with its unit or the ids that there are, and
// grey where there is no value.

#include "engine/model/channels.h"
#include "host/output/pictures/canvas.h"
#include "host/output/pictures/colouring.h"
#include "host/output/pictures/image.h"

#include <span>
#include <string>
#include <vector>

namespace pmdsim {

// `values` is row-major, rows * columns values, NaN for none. An image of one value says so instead of
// showing a bar.
Canvas draw_preview(std::span<const float> values, const glm::uvec2 &resolution, const Preview &preview,
                    const std::string &unit, const std::string &title);
// The same of an image that is there, of a frame of `resolution`, with colours that others have, too, and so
// with a bar in any case.
Canvas draw_preview(const PreviewImage &image, const Colouring &colouring, const glm::uvec2 &resolution,
                    const std::string &quantity, const std::string &unit, const std::string &title);
// Ids, no_id for none, with those that most pixels show and, as far as there are any, their names, UTF-8.
Canvas draw_preview(std::span<const std::uint32_t> ids, const glm::uvec2 &resolution,
                    const std::string &title, std::span<const std::string> names = {});

} // namespace pmdsim
