#include "host/input/calibration/readout.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace pmdsim {
namespace {

constexpr double most_binned = 64.0;

// A whole number from 0 to `most` under that name, 0 where there is none.
double whole_number(const CalibrationMap &map, const char *name, double most) {
  const auto entry = map.find({name});
  if (!entry)
    return 0.0;
  const double number = number_of(*entry);
  if (!(number >= 0.0 && number <= most) || number != std::floor(number))
    throw input_error(entry->key,
                      fmt::format("expected a whole number from 0 to {:.0f}, found {}", most, number));
  return number;
}

struct Region {
  glm::dvec2 offset{0.0}, size{0.0};
  CalibrationKey key;
};

// Nothing where the whole image is read: ROS writes zeros for it.
std::optional<Region> region_of(const CalibrationMap &map, const glm::uvec2 &resolution) {
  const auto entry = map.find({"roi"});
  if (!entry)
    return std::nullopt;
  if (!entry->value.IsMap())
    throw input_error(entry->key, "expected x_offset, y_offset, width and height");
  const CalibrationMap roi(entry->value, entry->key.place.file);
  constexpr double most = std::numeric_limits<std::uint32_t>::max();
  Region region{{whole_number(roi, "x_offset", most), whole_number(roi, "y_offset", most)},
                {whole_number(roi, "width", most), whole_number(roi, "height", most)},
                entry->key};
  if (region.size == glm::dvec2(0.0) && region.offset == glm::dvec2(0.0))
    return std::nullopt;
  const glm::dvec2 end = region.offset + region.size;
  if (!(region.size.x >= 1.0 && region.size.y >= 1.0 && end.x <= resolution.x && end.y <= resolution.y))
    throw input_error(entry->key,
                      fmt::format("expected a region within the image of {} x {} pixels, found {} x {} "
                                  "from column {}, row {} on",
                                  resolution.x, resolution.y, region.size.x, region.size.y, region.offset.x,
                                  region.offset.y));
  return region;
}

} // namespace

void apply_readout(const CalibrationMap &map, Calibration &calibration) {
  const glm::dvec2 binning(std::max(1.0, whole_number(map, "binning_x", most_binned)),
                           std::max(1.0, whole_number(map, "binning_y", most_binned)));
  const Region whole{{0.0, 0.0}, glm::dvec2(calibration.resolution), calibration.camera_matrix_at};
  const Region region = region_of(map, calibration.resolution).value_or(whole);
  const glm::dvec2 size = glm::floor(region.size / binning);
  if (size.x < 1.0 || size.y < 1.0)
    throw input_error(region.key,
                      fmt::format("expected at least one binned pixel of {} x {}, found a region of {} x {}",
                                  binning.x, binning.y, region.size.x, region.size.y));
  const glm::dvec2 middle = 0.5 * (binning - 1.0); // of a binned pixel, from the centre of its first one
  const glm::dvec2 centre = (glm::dvec2(calibration.cx, calibration.cy) - region.offset - middle) / binning;
  calibration.resolution = glm::uvec2(size);
  calibration.binning = glm::uvec2(binning);
  calibration.fx /= binning.x, calibration.cx = centre.x;
  calibration.fy /= binning.y, calibration.cy = centre.y;
}

} // namespace pmdsim
