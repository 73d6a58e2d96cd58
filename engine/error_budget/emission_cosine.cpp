#include "engine/error_budget/emission_cosine.h"

#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <glm/glm.hpp>

namespace pmdsim {
namespace {

// A lower bound of the cosine to `axis` of all that lies in `box`, seen from `place_m`.
double least_cosine(const glm::dvec3 &axis, const glm::dvec3 &place_m, const VisibleBox &box) {
  const glm::dvec3 low_m = box.low_m - place_m, high_m = box.high_m - place_m;
  const glm::dvec3 along_m = glm::min(axis * low_m, axis * high_m);
  const double height_m = along_m.x + along_m.y + along_m.z;
  return height_m / glm::length(glm::max(glm::abs(low_m), glm::abs(high_m)));
}

// At most `most` boxes that hold all of `boxes`.
std::vector<VisibleBox> merged(const std::vector<VisibleBox> &boxes, std::size_t most) {
  const std::size_t each = (boxes.size() + most - 1) / most;
  std::vector<VisibleBox> result;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i % each == 0)
      result.emplace_back();
    result.back().add(boxes[i].low_m);
    result.back().add(boxes[i].high_m);
  }
  return result;
}

} // namespace

double least_emission_cosine(const SourceGroups &groups, const std::vector<VisibleBox> &visible) {
  constexpr std::size_t most_boxes = 64;
  const std::vector<VisibleBox> boxes = merged(visible, most_boxes);
  double least = 1.0;
  for (std::size_t i = 0; i < groups.diodes.size() && least > grazing_cosine; ++i) {
    const glm::dvec3 &place_m = groups.positions[i].position_m;
    if (groups.positions[i].number == no_id || law_of(groups.diodes[i]).edge == nullptr)
      continue;
    for (const VisibleBox &box : boxes)
      least = std::min(least, least_cosine(glm::dvec3(groups.diodes[i].axis), place_m, box));
  }
  return std::max(least, grazing_cosine);
}

} // namespace pmdsim
