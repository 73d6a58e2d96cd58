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

// A diode, and the reference point and the beam of its run.
struct RunDiode {
  const Diode *diode;
  glm::dvec3 reference_m;
  const FieldBeam *beam;
};

// Diodes that are alike but for their places, or nearly so: each kind is looked at by itself, as few diodes
// of one kind may give most of the light somewhere.
using DiodeKind = std::vector<RunDiode>;

bool are_alike(const RunDiode &a, const RunDiode &b) {
  constexpr double common_axis = 0.95; // 18 degrees
  const Pattern &of_a = a.diode->pattern, &of_b = b.diode->pattern;
  return a.reference_m == b.reference_m && of_a.kind == of_b.kind && of_a.order == of_b.order &&
         of_a.diagram == of_b.diagram && glm::dot(a.diode->axis, b.diode->axis) > common_axis;
}

// Nothing where there are more kinds than can be looked at, or no diode shines.
std::vector<DiodeKind> kinds_of(const std::vector<CameraIlluminator> &lights, const SourceGroups &groups,
                                const std::vector<FieldBeam> &beams) {
  constexpr std::size_t most_kinds = 32;
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
      const RunDiode diode{all[place.number], groups.runs[r].reference_m, &beams[r]};
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
  constexpr double infinite = std::numeric_limits<double>::infinity(), dark = 1e-25;
  std::array<std::array<std::array<Term, nodes>, nodes>, nodes> at;
  double least_light = infinite;
  for_each_of<nodes>([&](std::size_t x, std::size_t y, std::size_t z) {
    at[x][y][z] = terms.at(cell.place_m({node(x), node(y), node(z)}));
    least_light = std::min(least_light, at[x][y][z].light);
  });
  if (!(least_light > dark))
    return {infinite, infinite, infinite, infinite};
  FieldError worst{0.0, 0.0, 1.0, 0.0};
  for_each_of<places>([&](std::size_t px, std::size_t py, std::size_t pz) {
    Term sum{0.0, 0.0, 0.0};
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
    worst.relative = std::max(std::abs(sum.weight * inverse - 1.0) + terms.beam_rounding(), worst.relative);
    worst.path_m = std::max(worst.path_m, 0.5 * terms.rho_m(place_m) * inverse *
                                              std::abs(sum.path - exact.path * inverse * sum.weight));
    worst.rounding_growth = std::max(worst.rounding_growth, sizes * inverse);
    worst.dimming = std::max(worst.dimming, std::log(exact.light / least_light));
  });
  return worst;
}

} // namespace

FieldError field_error(const LightFacts &view, const SourceGroups &groups,
                       const std::vector<FieldBeam> &beams, const FieldCells &cells,
                       const std::function<bool(const FieldError &)> &is_too_large) {
  // Of what lies between the places and diodes that are looked at; and of the sums at nodes by a surface that
  // is no nearer to grazing than field_height allows.
  constexpr double margin = 2.0, by_surface = (field_height + 1.0) / (field_height - 1.0);
  constexpr std::size_t kinds_of_place = 4;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const bool lambert = view.model.backscatter == shader::backscatter_lambert;
  const std::vector<DiodeKind> kinds = kinds_of(view.lights, groups, beams);
  if (kinds.empty() || !cells.any())
    return {infinite, infinite, infinite, infinite};
  FieldError worst{0.0, 0.0, by_surface, 0.0};
  std::size_t next = 0;
  for (const glm::dvec3 &place_m : cells.places_m())
    for (std::size_t i = 0; i < std::min(kinds.size(), kinds_of_place); ++i, ++next) {
      if (is_too_large(worst))
        return worst;
      const DiodeKind &kind = kinds[next % kinds.size()];
      // Steps by the golden ratio come to all diodes, however many there are.
      const std::size_t round = next / kinds.size();
      const double turn = static_cast<double>(round) * std::numbers::phi;
      const auto number =
          static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(kind.size()));
      const FieldError here = error_in(cells.cell_of(place_m), FieldTerms(kind[number], lambert));
      worst = {std::max(margin * here.relative, worst.relative), std::max(margin * here.path_m, worst.path_m),
               std::max(by_surface * here.rounding_growth, worst.rounding_growth),
               std::max(here.dimming, worst.dimming)};
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
  bound.weight_error += growth * bound.beams.at(error.dimming);
  bound.beams.square *= growth * growth;
  bound.beams.square_per_log *= growth * growth;
  return bound;
}

} // namespace pmdsim
