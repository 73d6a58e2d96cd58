#include "engine/error_budget/field_error.h"

#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace pmdsim {
namespace {

// A diode and the reference point of its run.
struct RunDiode {
  const Diode *diode;
  glm::dvec3 reference_m;
};

std::vector<RunDiode> diodes_of(const std::vector<CameraIlluminator> &lights, const SourceGroups &groups) {
  std::vector<const Diode *> all;
  for (const CameraIlluminator &light : lights)
    for (const Diode &diode : light.diodes)
      all.push_back(&diode);
  std::vector<RunDiode> diodes;
  for (const SourceRun &run : groups.runs)
    for (std::uint32_t i = 0; i < groups.blocks_per_run * shader::diodes_per_block; ++i)
      if (const SourcePosition &place = groups.positions[run.first + i];
          place.number != no_id && all[place.number]->intensity_w_sr > 0.0)
        diodes.push_back({all[place.number], run.reference_m});
  return diodes;
}

// What is interpolated of a diode's term at a place: its weight without the surface, and that times the path
// difference, in units of rho.
struct Term {
  double weight, path;
};

class FieldTerms {
public:
  FieldTerms(const RunDiode &of, bool lambert)
      : of_(of), value_(law_of(of.diode->pattern).value), lambert_(lambert) {}

  double rho_m(const glm::dvec3 &place_m) const { return glm::distance(place_m, of_.reference_m); }
  Term at(const glm::dvec3 &place_m) const {
    const glm::dvec3 way_m = place_m - of_.diode->position_m;
    const double stretch = glm::length(way_m) / rho_m(place_m);
    const double weight = value_(*of_.diode, way_m) / (stretch * stretch * (lambert_ ? stretch : 1.0));
    return {weight, weight * (stretch - 1.0)};
  }

private:
  const RunDiode &of_;
  double (*value_)(const Diode &, const glm::dvec3 &);
  bool lambert_;
};

// A cell of the view: x, y and s of its middle, and half of its extent along each; places are (x, y, 1) / s.
struct ViewCell {
  glm::dvec3 middle, half;

  glm::dvec3 place_m(const glm::dvec3 &within) const { // each in [-1, 1]
    const glm::dvec3 at = middle + half * within;
    return glm::dvec3(at.x, at.y, 1.0) / at.z;
  }
};

constexpr std::size_t nodes = field_nodes, places = 5; // along each axis

double node(std::size_t i) { return field_node_places[i]; }
double place(std::size_t i) { return 1.8 * static_cast<double>(i) / (places - 1) - 0.9; }

// Lagrange's polynomials of the nodes at each place.
using Weights = std::array<std::array<double, nodes>, places>;
Weights lagrange_weights() {
  Weights weights;
  for (std::size_t p = 0; p < places; ++p)
    for (std::size_t i = 0; i < nodes; ++i) {
      weights[p][i] = 1.0;
      for (std::size_t k = 0; k < nodes; ++k)
        weights[p][i] *= k == i ? 1.0 : (place(p) - node(k)) / (node(i) - node(k));
    }
  return weights;
}

// A cell's nodes, or places, the last axis first.
template <std::size_t count, class Function>
void for_each_of(const Function &function) {
  for (std::size_t x = 0; x < count; ++x)
    for (std::size_t y = 0; y < count; ++y)
      for (std::size_t z = 0; z < count; ++z)
        function(x, y, z);
}

// The worst of a diode's term in a cell.
FieldError error_in(const ViewCell &cell, const FieldTerms &terms) {
  static const Weights weights = lagrange_weights();
  std::array<std::array<std::array<Term, nodes>, nodes>, nodes> at;
  for_each_of<nodes>([&](std::size_t x, std::size_t y, std::size_t z) {
    at[x][y][z] = terms.at(cell.place_m({node(x), node(y), node(z)}));
  });
  FieldError worst{0.0, 0.0, 1.0};
  for_each_of<places>([&](std::size_t px, std::size_t py, std::size_t pz) {
    Term sum{0.0, 0.0};
    double sizes = 0.0;
    for_each_of<nodes>([&](std::size_t x, std::size_t y, std::size_t z) {
      const double weight = weights[px][x] * weights[py][y] * weights[pz][z];
      sum.weight += weight * at[x][y][z].weight;
      sum.path += weight * at[x][y][z].path;
      sizes += std::abs(weight) * at[x][y][z].weight;
    });
    const glm::dvec3 place_m = cell.place_m({place(px), place(py), place(pz)});
    const Term exact = terms.at(place_m);
    const double inverse = 1.0 / exact.weight;
    worst.relative = std::max(std::abs(sum.weight * inverse - 1.0), worst.relative);
    worst.path_m = std::max(worst.path_m, 0.5 * terms.rho_m(place_m) * inverse *
                                              std::abs(sum.path - exact.path * inverse * sum.weight));
    worst.rounding_growth = std::max(worst.rounding_growth, sizes * inverse);
  });
  return worst;
}

// The cell that a place is in; nothing where that is out of the frame.
std::optional<ViewCell> cell_of(const Sensor &sensor, const FieldGrid &grid, const glm::dvec3 &place_m) {
  const glm::dvec2 half_cell =
      0.5 * static_cast<double>(grid.side) * sensor.pixel_pitch_m / sensor.image_distance_m();
  const glm::dvec2 edge =
      0.5 * sensor.pixel_pitch_m * glm::dvec2(sensor.resolution) / sensor.image_distance_m();
  const glm::dvec2 ray = glm::dvec2(place_m) / place_m.z;
  if (!(place_m.z > 0.0) || std::abs(ray.x) > edge.x || std::abs(ray.y) > edge.y)
    return std::nullopt;
  const double half_s = 0.5 / grid.cells_m;
  const glm::dvec2 number = glm::floor((ray + edge) / (2.0 * half_cell));
  const double farthest = 1.0 / grid.farthest_m,
               deep = std::max(std::floor(grid.cells_m * (1.0 / place_m.z - farthest)), 0.0);
  return ViewCell{{glm::dvec2(2.0 * number + 1.0) * half_cell - edge, farthest + (2.0 * deep + 1.0) * half_s},
                  {half_cell, half_s}};
}

// Places that are seen, most of them at random, at first those at the edges of the frame.
std::vector<glm::dvec3> places_of(const std::vector<VisibleBox> &visible) {
  constexpr std::size_t most_boxes = 32, most_places = 160;
  std::mt19937 random(1);
  const auto part = [&] { return std::generate_canonical<double, 32>(random); };
  std::vector<glm::dvec3> all;
  const std::size_t step = (visible.size() + most_boxes - 1) / most_boxes,
                    of_box = most_places / std::min(visible.size(), most_boxes);
  for (std::size_t i = 0; i < visible.size(); i += step) {
    const VisibleBox &box = visible[i];
    const auto at = [&](double x, double y, double z) {
      all.push_back(glm::mix(box.low_m, box.high_m, glm::dvec3(x, y, z)));
    };
    for (const double x : {0.001, 0.999})
      for (const double y : {0.001, 0.999})
        for (const double z : {0.001, 0.999})
          at(x, y, z);
    for (std::size_t k = 0; k < of_box; ++k)
      at(part(), part(), part());
  }
  return all;
}

} // namespace

FieldError field_error(const LightFacts &view, const SourceGroups &groups, const FieldGrid &grid,
                       const std::function<bool(const FieldError &)> &is_enough) {
  // Of what lies between the places and diodes that are looked at; and of the sums at nodes by a surface that
  // is no nearer to grazing than field_height allows.
  constexpr double margin = 2.0, by_surface = (field_height + 1.0) / (field_height - 1.0);
  const bool lambert = view.model.backscatter == shader::backscatter_lambert;
  const std::vector<RunDiode> diodes = diodes_of(view.lights, groups);
  FieldError worst{diodes.empty() ? std::numeric_limits<double>::infinity() : 0.0, 0.0, by_surface};
  std::size_t next = 0;
  for (const glm::dvec3 &place_m : places_of(view.visible)) {
    if (is_enough(worst))
      break;
    const auto cell = cell_of(view.sensor, grid, place_m);
    if (!cell)
      continue;
    const FieldError here = error_in(*cell, FieldTerms(diodes[next % diodes.size()], lambert));
    worst = {std::max(margin * here.relative, worst.relative), std::max(margin * here.path_m, worst.path_m),
             std::max(by_surface * here.rounding_growth, worst.rounding_growth)};
    next += 1 + diodes.size() * 5 / 13;
  }
  return worst;
}

ErrorBound through_field(ErrorBound bound, const FieldError &error) {
  // Products and sums of the nodes' values and weights.
  constexpr double roundings = 40.0 * 0x1p-24;
  const double growth = error.rounding_growth, relative = error.relative + growth * roundings;
  bound.per_condition_m = growth * bound.per_condition_m + error.path_m;
  bound.weight_error = growth * bound.weight_error + relative;
  bound.amplitude_per_condition = growth * bound.amplitude_per_condition + relative;
  bound.terms_per_weight_error *= growth;
  bound.terms_of_beam_edges *= growth;
  // A node may be dimmer than the sample, by the terms' change.
  const double dimming = std::log(growth);
  bound.weight_error += growth * bound.beams.at(dimming);
  bound.beams.square *= growth * growth;
  bound.beams.square_per_log *= growth * growth;
  return bound;
}

} // namespace pmdsim
