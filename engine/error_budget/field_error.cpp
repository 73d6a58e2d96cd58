#include "engine/error_budget/field_error.h"

#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace pmdsim {
namespace {

// What cancels in the sums at nodes by a surface that is no nearer to grazing than field_height allows.
constexpr double by_surface = (field_height + 1.0) / (field_height - 1.0);

// A diode, and the reference point and the beam of its run.
struct RunDiode {
  const Diode *diode;
  glm::dvec3 reference_m;
  const FieldBeam *beam;
  double distance_m; // to the reference point; the same for all that are near it
};

// Diodes that are nearly alike: each kind is looked at by itself, as few diodes of one kind may give most of
// the light somewhere, or most of the error.
using DiodeKind = std::vector<RunDiode>;

bool is_about(double a, double b, double factor) { return a <= factor * b && b <= factor * a; }

bool are_alike(const RunDiode &a, const RunDiode &b) {
  // What terms change by goes with the fourth power of the distance to the reference point.
  constexpr double common_axis = 0.95 /* 18 degrees */, distances = 1.2, intensities = 4.0;
  const Pattern &of_a = a.diode->pattern, &of_b = b.diode->pattern;
  return a.beam == b.beam && of_a.kind == of_b.kind && of_a.order == of_b.order &&
         of_a.diagram == of_b.diagram && glm::dot(a.diode->axis, b.diode->axis) > common_axis &&
         is_about(a.diode->intensity_w_sr, b.diode->intensity_w_sr, intensities) &&
         is_about(a.distance_m, b.distance_m, distances);
}

// Nothing where there are more kinds than can be looked at, or no diode shines.
std::vector<DiodeKind> kinds_of(const std::vector<CameraIlluminator> &lights, const SourceGroups &groups,
                                const std::vector<FieldBeam> &beams) {
  constexpr std::size_t most_kinds = 32;
  constexpr double near = 0.4; // of a run's radius: they change least
  std::vector<const Diode *> all;
  for (const CameraIlluminator &light : lights)
    for (const Diode &diode : light.diodes)
      all.push_back(&diode);
  std::vector<DiodeKind> kinds;
  for (std::size_t r = 0; r < groups.runs.size(); ++r)
    for (std::uint32_t i = 0; i < groups.blocks_per_run * shader::diodes_per_block; ++i) {
      const SourcePosition &place = groups.positions[groups.runs[r].first + i];
      if (place.number == no_id || !(all[place.number]->intensity_w_sr > 0.0))
        continue;
      const SourceRun &run = groups.runs[r];
      const double distance_m = glm::distance(place.position_m, run.reference_m);
      const RunDiode diode{all[place.number], run.reference_m, &beams[r],
                           std::max(distance_m, near * run.reach.radius_m)};
      const auto kind =
          std::ranges::find_if(kinds, [&](const DiodeKind &of) { return are_alike(of.front(), diode); });
      if (kind != kinds.end())
        kind->push_back(diode);
      else if (kinds.size() < most_kinds)
        kinds.push_back({diode});
      else
        return {};
    }
  return kinds;
}

// What is interpolated of a diode's term at a place: its weight without the surface, over its run's beam, and
// that times the path difference, in units of rho.
struct Term {
  double weight, path;
  double light; // J
};

class FieldTerms {
public:
  FieldTerms(const RunDiode &of, bool lambert)
      : of_(of), value_(law_of(of.diode->pattern).value), lambert_(lambert) {}

  double rho_m(const glm::dvec3 &place_m) const { return glm::distance(place_m, of_.reference_m); }
  Term at(const glm::dvec3 &place_m) const {
    const glm::dvec3 way_m = place_m - of_.diode->position_m;
    const double stretch = glm::length(way_m) / rho_m(place_m);
    const double light = value_(*of_.diode, way_m);
    const double weight = light / (beam_at(place_m) * stretch * stretch * (lambert_ ? stretch : 1.0));
    return {weight, weight * (stretch - 1.0), light};
  }
  // Of the beam at a sample, in float: its cosine's, the power's, and a few more.
  double beam_rounding() const { return (2.0 * power() + 8.0) * 0x1p-24; }

private:
  double power() const {
    return static_cast<double>(of_.beam->power.whole) + static_cast<double>(of_.beam->power.rest);
  }
  double beam_at(const glm::dvec3 &place_m) const {
    const glm::dvec3 axis(of_.beam->axis[0], of_.beam->axis[1], of_.beam->axis[2]);
    return std::pow(std::max(glm::dot(axis, place_m - of_.reference_m), 0.0) / rho_m(place_m), power());
  }

  const RunDiode &of_;
  double (*value_)(const Diode &, const glm::dvec3 &);
  bool lambert_;
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

// What is interpolated, at nodes or places along each axis.
struct TermSums {
  double weight = 0.0, path = 0.0;
  double size = 0.0; // with all weights of the nodes positive

  void add(double of_node, const TermSums &at) {
    weight += of_node * at.weight;
    path += of_node * at.path;
    size += std::abs(of_node) * at.size;
  }
};
template <std::size_t x, std::size_t y, std::size_t z>
using TermGrid = std::array<std::array<std::array<TermSums, z>, y>, x>;

template <std::size_t x, std::size_t y, std::size_t z, class Function>
void for_each_of(const Function &function) {
  for (std::size_t i = 0; i < x; ++i)
    for (std::size_t k = 0; k < y; ++k)
      for (std::size_t l = 0; l < z; ++l)
        function(i, k, l);
}

// One axis after the other.
TermGrid<places, places, places> interpolated(const TermGrid<nodes, nodes, nodes> &at) {
  static const Weights weights = lagrange_weights();
  TermGrid<nodes, nodes, places> deep;
  TermGrid<nodes, places, places> high;
  TermGrid<places, places, places> all;
  for_each_of<nodes, nodes, places>([&](std::size_t x, std::size_t y, std::size_t z) {
    for (std::size_t i = 0; i < nodes; ++i)
      deep[x][y][z].add(weights[z][i], at[x][y][i]);
  });
  for_each_of<nodes, places, places>([&](std::size_t x, std::size_t y, std::size_t z) {
    for (std::size_t i = 0; i < nodes; ++i)
      high[x][y][z].add(weights[y][i], deep[x][i][z]);
  });
  for_each_of<places, places, places>([&](std::size_t x, std::size_t y, std::size_t z) {
    for (std::size_t i = 0; i < nodes; ++i)
      all[x][y][z].add(weights[x][i], high[i][y][z]);
  });
  return all;
}

// The worst of a diode's term in a cell.
FieldError error_in(const ViewCell &cell, const FieldTerms &terms) {
  constexpr double infinite = std::numeric_limits<double>::infinity(), dark = 1e-25;
  TermGrid<nodes, nodes, nodes> at;
  double least_light = infinite;
  for_each_of<nodes, nodes, nodes>([&](std::size_t x, std::size_t y, std::size_t z) {
    const Term term = terms.at(cell.place_m({node(x), node(y), node(z)}));
    at[x][y][z] = {term.weight, term.path, term.weight};
    least_light = std::min(least_light, term.light);
  });
  if (!(least_light > dark))
    return {infinite, infinite, infinite, infinite};
  const TermGrid<places, places, places> sums = interpolated(at);
  FieldError worst{0.0, 0.0, 1.0, 0.0};
  for_each_of<places, places, places>([&](std::size_t x, std::size_t y, std::size_t z) {
    const TermSums &sum = sums[x][y][z];
    const glm::dvec3 place_m = cell.place_m({place(x), place(y), place(z)});
    const Term exact = terms.at(place_m);
    const double inverse = 1.0 / exact.weight;
    worst.relative = std::max(std::abs(sum.weight * inverse - 1.0) + terms.beam_rounding(), worst.relative);
    worst.path_m = std::max(worst.path_m, 0.5 * terms.rho_m(place_m) * inverse *
                                              std::abs(sum.path - exact.path * inverse * sum.weight));
    worst.rounding_growth = std::max(worst.rounding_growth, sum.size * inverse);
    worst.dimming = std::max(worst.dimming, std::log(exact.light / least_light));
  });
  return worst;
}

// Numbers that come evenly to all from 0 on below `count`, however many there are.
class EvenTurns {
public:
  std::size_t next(std::size_t count) {
    turn_ += std::numbers::phi;
    turn_ -= std::floor(turn_);
    return static_cast<std::size_t>(turn_ * static_cast<double>(count));
  }

private:
  double turn_ = 0.0;
};

// The worst of what was looked at.
struct WorstOf {
  FieldError so_far;

  void add(const FieldError &here) {
    // Of what lies between the places and diodes that are looked at.
    constexpr double margin = 2.0;
    so_far = {std::max(margin * here.relative, so_far.relative),
              std::max(margin * here.path_m, so_far.path_m),
              std::max(by_surface * here.rounding_growth, so_far.rounding_growth),
              std::max(here.dimming, so_far.dimming)};
  }
};

} // namespace

FieldError field_error(const LightFacts &view, const SourceGroups &groups,
                       const std::vector<FieldBeam> &beams, const FieldCells &cells,
                       const std::function<bool(const FieldError &)> &is_too_large) {
  constexpr std::size_t kinds_of_place = 2;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const bool lambert = view.model.backscatter == shader::backscatter_lambert;
  const std::vector<DiodeKind> kinds = kinds_of(view.lights, groups, beams);
  if (kinds.empty() || !cells.any())
    return {infinite, infinite, infinite, infinite};
  WorstOf worst{{0.0, 0.0, by_surface, 0.0}};
  EvenTurns of_kinds, of_diodes;
  const auto look_at = [&](const glm::dvec3 &place_m, const DiodeKind &kind) {
    worst.add(error_in(cells.cell_of(place_m), FieldTerms(kind[of_diodes.next(kind.size())], lambert)));
    return !is_too_large(worst.so_far);
  };
  for (const glm::dvec3 &place_m : cells.corner_places_m())
    for (const DiodeKind &kind : kinds)
      if (!look_at(place_m, kind))
        return worst.so_far;
  for (const glm::dvec3 &place_m : cells.random_places_m())
    for (std::size_t i = 0; i < std::min(kinds.size(), kinds_of_place); ++i)
      if (!look_at(place_m, kinds[of_kinds.next(kinds.size())]))
        return worst.so_far;
  return worst.so_far;
}

ErrorBound through_field(ErrorBound bound, const FieldError &error, double wavenumber_rad_m) {
  // Products and sums of the nodes' values and weights.
  constexpr double roundings = 40.0 * 0x1p-24;
  const double growth = error.rounding_growth, relative = error.relative + growth * roundings;
  bound.per_condition_m = growth * bound.per_condition_m + error.path_m;
  bound.weight_error = growth * bound.weight_error + relative;
  const double of_beams = growth * bound.beams.at(error.dimming);
  bound.amplitude_per_condition = growth * bound.amplitude_per_condition + relative +
                                  bound.amplitude_per_weight * of_beams +
                                  2.0 * wavenumber_rad_m * error.path_m;
  bound.terms_per_weight_error *= growth;
  bound.terms_of_beam_edges *= growth;
  bound.weight_error += of_beams;
  bound.beams.square *= growth * growth;
  bound.beams.square_per_log *= growth * growth;
  return bound;
}

} // namespace pmdsim
