#include "host/output/tables/diode_study.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

namespace pmdsim {

double DiodeStudy::part_m(std::size_t diode) const {
  constexpr double rounding_m = 1e-12;
  const Deviation &part = theory.diodes[diode].in_board;
  return theory.board.back().varying_rms_m > rounding_m ? part.varying_rms_m : part.rms_m;
}

std::vector<std::size_t> DiodeStudy::ranking() const {
  std::vector<std::size_t> order(diodes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t m) { return part_m(m); });
  return order;
}

std::vector<float> DiodeStudy::image_of(const std::vector<double> &values, double factor) const {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> of_cells(std::size_t{grid.x} * grid.y, none), image;
  for (std::size_t i = 0; i < values.size(); ++i)
    of_cells[cells[i]] = static_cast<float>(factor * values[i]);
  image.reserve(std::size_t{resolution.x} * resolution.y);
  for (std::uint64_t row = 0; row < resolution.y; ++row)
    for (std::uint64_t column = 0; column < resolution.x; ++column)
      image.push_back(of_cells[row * grid.y / resolution.y * grid.x + column * grid.x / resolution.x]);
  return image;
}

std::string diode_name(const StudiedDiode &diode) {
  return fmt::format("{} {}", diode.illuminator, diode.number);
}

std::string tolerance_text(Kind kind, const Tolerances &tolerances) {
  const double size = tolerances.of(kind);
  switch (kind) {
  case Kind::position:
    return fmt::format("{:.4g} mm", 1e3 * size);
  case Kind::axis:
  case Kind::phase:
    return fmt::format("{:.4g} deg", 180.0 / std::numbers::pi * size);
  case Kind::intensity:
  case Kind::dead:
    break;
  }
  return fmt::format("{:.4g} %", 100.0 * size);
}

std::string fault_text(Fault fault) {
  switch (fault) {
  case Fault::axis_x:
    return "axis towards x";
  case Fault::axis_y:
    return "axis towards y";
  default:
    return fault_names[static_cast<std::size_t>(fault)];
  }
}

} // namespace pmdsim
