#pragma once
// Small images of a few channels, which records keep of the frames that a run's pictures show
// (host/output/sheets/sheets.h): whoever makes the last frame has none of the others' values.

#include "host/output/files/channel.h"
#include "host/output/pictures/image.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

struct Thumbnail {
  std::string channel;  // "f0.distance_m"
  std::string quantity; // "distance"
  std::string unit;
  ColourScale scale = ColourScale::sequential;
  glm::uvec2 frame_resolution{0, 0};
  PreviewImage image; // at most max_thumbnail_side a side
};

inline constexpr std::uint32_t max_thumbnail_side = 128;

// Of amplitude, distance_m, unwrapped_distance_m and deformation_mm, as far as the frame shows pictures of
// them; of several frequencies the first. Values beyond the outermost 0.5 % are cut.
std::vector<Thumbnail> thumbnails_of(const ChannelSet &channels);

// channel, quantity, unit, scale, frame_resolution, resolution, range and values: two characters of base 64
// for each value in row-major order, its place in the range from 0 to 4094, or 4095 where there is none.
nlohmann::ordered_json thumbnail_json(const Thumbnail &thumbnail);
// Nothing where the JSON is not of that form: anyone may have edited it.
std::optional<Thumbnail> parsed_thumbnail(const nlohmann::ordered_json &json);

} // namespace pmdsim
