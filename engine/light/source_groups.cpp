#include "engine/light/source_groups.h"

#include "engine/light/diagram_tables.h"
#include "engine/light/path_difference.h"
#include "engine/light/radiation_laws.h"
#include "engine/model/error.h"
#include "engine/model/turn.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace pmdsim {
namespace {

constexpr double largest_phase_rad =
    0.5; // of a group's largest path difference: 9 moments at most, no phase wraps
constexpr double largest_radius_over_range = 0.5; // beyond it r^2 = rho^2 + q would cancel
// A straight line in fp64 takes several times as long to compile as one in float.
constexpr std::uint32_t largest_precise_run_blocks = 4;
// A run's cost beside its diodes, in blocks of diodes: fetching the samples and their reference path.
constexpr std::uint64_t run_overhead_blocks = 4;
// The least intensity, over the strongest: a weaker one would leave float's range on its way over distances.
constexpr double weakest_intensity = 1e-25;

struct NumberedDiode : Diode {
  std::uint32_t number; // among those of all illuminators
};

VisibleBox box_of(std::span<const NumberedDiode> diodes) {
  VisibleBox box;
  for (const Diode &diode : diodes)
    box.add(diode.position_m);
  return box;
}

struct Group {
  std::span<NumberedDiode> diodes;
  double phase_turns, modulation_depth; // the illuminator's
  glm::dvec3 reference_m;
  PathDifference reach; // of its diodes
};

Group group_of(std::span<NumberedDiode> diodes, double phase_turns, double modulation_depth,
               const std::vector<VisibleBox> &visible) {
  const VisibleBox box = box_of(diodes);
  // The box's middle; for a single diode exactly its place, so that its path needs no correction at all.
  Group group{diodes,
              phase_turns,
              modulation_depth,
              diodes.size() == 1 ? box.low_m : 0.5 * (box.low_m + box.high_m),
              {}};
  std::vector<glm::dvec3> places_m;
  for (const Diode &diode : diodes)
    places_m.push_back(diode.position_m);
  group.reach = path_difference_of(group.reference_m, places_m, visible);
  return group;
}

shader::GroupSource dark_diode() {
  shader::GroupSource diode{};
  diode.axis = {0, 0, 1, 0};
  diode.order = law_of(Pattern{}).number;
  return diode;
}

shader::GroupSource group_diode(const Diode &diode, const glm::dvec3 &reference_m,
                                double largest_intensity_w_sr, DiagramTables &diagrams) {
  const glm::dvec3 position_m = diode.position_m - reference_m;
  shader::GroupSource record = dark_diode();
  record.position = glm::vec4(-2.0 * position_m, glm::dot(position_m, position_m));
  record.axis = glm::vec4(diode.axis, glm::dot(diode.axis, position_m));
  if (largest_intensity_w_sr > 0.0)
    record.intensity = static_cast<float>(diode.intensity_w_sr / largest_intensity_w_sr);
  const RadiationLaw &law = law_of(diode.pattern);
  record.order = law.number;
  if (law.describe != nullptr)
    law.describe(diode, diagrams, record);
  return record;
}

// A dark diode may stand beside any other.
void check_intensities(std::span<const NumberedDiode> diodes, double largest_w_sr) {
  if (std::ranges::any_of(diodes, [&](const Diode &diode) {
        return diode.intensity_w_sr > 0.0 && diode.intensity_w_sr < weakest_intensity * largest_w_sr;
      }))
    throw Error(ExitCode::input, "the strongest diode is more than 1e25 times as strong as the weakest: "
                                 "expected intensities closer to each other, or 0");
}

float rest(double value, float rounded) { return static_cast<float>(value - static_cast<double>(rounded)); }

glm::vec4 rest(const glm::dvec4 &value, const glm::vec4 &rounded) {
  return glm::vec4(value - glm::dvec4(rounded));
}

// The diode with the rest that rounding to `rounded` took; no rest for a dark one.
shader::PreciseSource precise_diode(const shader::GroupSource &rounded, const Diode &diode,
                                    const glm::dvec3 &reference_m, double largest_intensity_w_sr,
                                    PreciseDiagrams &diagrams) {
  shader::PreciseSource record{};
  record.rounded = rounded;
  if (rounded.intensity == 0.0f)
    return record;
  const glm::dvec3 position_m = diode.position_m - reference_m;
  record.position_rest =
      rest(glm::dvec4(-2.0 * position_m, glm::dot(position_m, position_m)), rounded.position);
  record.axis_rest = rest(glm::dvec4(diode.axis, glm::dot(diode.axis, position_m)), rounded.axis);
  record.intensity_rest = rest(diode.intensity_w_sr / largest_intensity_w_sr, rounded.intensity);
  if (rounded.order >= 0.0f)
    record.order_rest = rest(diode.pattern.order, rounded.order);
  if (const RadiationLaw &law = law_of(rounded); law.describe_precisely != nullptr)
    law.describe_precisely(diode, diagrams, record);
  return record;
}

std::vector<NumberedDiode> numbered(const std::vector<CameraIlluminator> &illuminators) {
  std::vector<NumberedDiode> all;
  for (const CameraIlluminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes)
      all.push_back({diode, static_cast<std::uint32_t>(all.size())});
  return all;
}

// Brings `first` diodes to the front so that a plane across the longest side of their box parts them from the
// rest.
void part_in_two(std::span<NumberedDiode> diodes, std::size_t first) {
  const int axis = box_of(diodes).longest_side();
  std::ranges::nth_element(diodes, diodes.begin() + static_cast<std::ptrdiff_t>(first), {},
                           [axis](const Diode &diode) { return diode.position_m[axis]; });
}

// Orders a group's diodes by their angles about the lens, seen from the scene: on boards across the view the
// sweep's order is that of the bits then. Those that share a bundle stand in one sector.
void order_by_angles(std::span<NumberedDiode> diodes) {
  std::ranges::stable_sort(diodes, {}, [](const Diode &diode) {
    return turn_of({static_cast<float>(diode.position_m.x), -static_cast<float>(diode.position_m.y)});
  });
}

class Grouping {
public:
  Grouping(const std::vector<VisibleBox> &visible, double wavenumber_rad_m)
      : visible_(visible), wavenumber_rad_m_(wavenumber_rad_m) {}

  // Halves `diodes` (which it reorders) along its longest side until every part is small enough.
  void split(std::span<NumberedDiode> diodes, double phase_turns, double modulation_depth) {
    const Group group = group_of(diodes, phase_turns, modulation_depth, visible_);
    if (is_small_enough(group)) {
      order_by_angles(diodes);
      groups_.push_back(group);
      return;
    }
    part_in_two(diodes, diodes.size() / 2);
    split(diodes.first(diodes.size() / 2), phase_turns, modulation_depth);
    split(diodes.subspan(diodes.size() / 2), phase_turns, modulation_depth);
  }

  const std::vector<Group> &groups() const { return groups_; }

private:
  bool is_small_enough(const Group &group) const {
    return wavenumber_rad_m_ * group.reach.path_difference_m <= largest_phase_rad &&
           group.reach.radius_m <= largest_radius_over_range * group.reach.range_m;
  }

  const std::vector<VisibleBox> &visible_;
  double wavenumber_rad_m_;
  std::vector<Group> groups_;
};

std::uint32_t blocks_for(std::size_t diodes) {
  return static_cast<std::uint32_t>((diodes + shader::diodes_per_block - 1) / shader::diodes_per_block);
}

// All runs have the same length, so short groups are padded and long ones cut: the length that costs least.
std::uint32_t cheapest_run_blocks(const std::vector<Group> &groups, std::uint32_t most) {
  const auto cost = [&](std::uint32_t run_blocks) {
    std::uint64_t runs = 0;
    for (const Group &group : groups)
      runs += (blocks_for(group.diodes.size()) + run_blocks - 1) / run_blocks;
    return runs * (run_blocks + run_overhead_blocks);
  };
  std::uint32_t cheapest = 1;
  for (std::uint32_t run_blocks = 2; run_blocks <= most; ++run_blocks)
    if (cost(run_blocks) < cost(cheapest))
      cheapest = run_blocks;
  return cheapest;
}

// The diagrams of all diodes, in both precisions.
struct Diagrams {
  DiagramTables in_float;
  PreciseDiagrams precise;
};

void add_runs(const Group &group, Precision precision, SourceGroups &result, Diagrams &diagrams) {
  const std::size_t run_diodes = std::size_t{result.blocks_per_run} * shader::diodes_per_block;
  const bool precise = precision == Precision::fp64;
  for (std::size_t first = 0; first < group.diodes.size(); first += run_diodes) {
    result.runs.push_back({group.reference_m, static_cast<std::uint32_t>(result.diodes.size()),
                           group.phase_turns, group.modulation_depth, group.reach});
    for (std::size_t i = first; i < first + run_diodes; ++i) {
      const bool dark = i >= group.diodes.size();
      const NumberedDiode &diode = group.diodes[dark ? group.diodes.size() - 1 : i];
      result.diodes.push_back(
          dark ? dark_diode()
               : group_diode(diode, group.reference_m, result.largest_intensity_w_sr, diagrams.in_float));
      if (precise)
        result.precise_diodes.push_back(precise_diode(result.diodes.back(), diode, group.reference_m,
                                                      result.largest_intensity_w_sr, diagrams.precise));
      const double error = precise
                               ? precise_law_error(diode.pattern)
                               : law_error(diode.pattern, diagrams.in_float, group.reach.radius_over_range());
      result.positions.push_back(
          {diode.position_m, dark ? no_id : diode.number, error, largest_radiation(diode.pattern)});
    }
  }
}

} // namespace

std::uint32_t moments_needed(double phase_rad, double remainder, double tolerance) {
  std::uint32_t k = 1;
  double term = phase_rad; // (kappa e)^k / k!
  while (term > std::max(largest_term(phase_rad, remainder), tolerance))
    term *= phase_rad / ++k;
  return k;
}

namespace {

// `run_blocks`: nothing where the cheapest are to be found, of `most_blocks` at most.
SourceGroups grouped(const std::vector<CameraIlluminator> &illuminators,
                     const std::vector<VisibleBox> &visible, double wavenumber_rad_m, Precision precision,
                     std::uint32_t most_blocks, std::optional<std::uint32_t> run_blocks, double tolerance) {
  std::vector<NumberedDiode> ordered = numbered(illuminators);
  std::span<NumberedDiode> left = ordered;
  Grouping grouping(visible, wavenumber_rad_m);
  SourceGroups result;
  result.tolerance = tolerance;
  result.diode_count = static_cast<std::uint32_t>(ordered.size());
  for (const auto &[diodes, phase_rad, modulation_depth] : illuminators) {
    const double phase_turns = std::remainder(phase_rad / (2.0 * std::numbers::pi), 1.0);
    result.phased = result.phased || phase_turns != 0.0;
    for (const Diode &diode : diodes)
      result.largest_intensity_w_sr = std::max(result.largest_intensity_w_sr, diode.intensity_w_sr);
    grouping.split(left.first(diodes.size()), phase_turns, modulation_depth);
    left = left.subspan(diodes.size());
  }
  check_intensities(ordered, result.largest_intensity_w_sr);

  for (const Group &group : grouping.groups()) {
    result.path_difference_m = std::max(result.path_difference_m, group.reach.path_difference_m);
    result.radius_m = std::max(result.radius_m, group.reach.radius_m);
    result.radius_over_range = std::max(result.radius_over_range, group.reach.radius_over_range());
  }
  result.moments =
      moments_needed(wavenumber_rad_m * result.path_difference_m, largest_remainder(precision), tolerance);
  result.blocks_per_run = run_blocks ? *run_blocks : cheapest_run_blocks(grouping.groups(), most_blocks);
  Diagrams diagrams;
  for (const Group &group : grouping.groups())
    add_runs(group, precision, result, diagrams);
  result.diagrams = precision == Precision::fp64 ? diagrams.precise.values() : diagrams.in_float.values();
  return result;
}

} // namespace

SourceGroups group_diodes(const std::vector<CameraIlluminator> &illuminators,
                          const std::vector<VisibleBox> &visible, double wavenumber_rad_m,
                          Precision precision, std::uint32_t most_blocks, double tolerance) {
  return grouped(illuminators, visible, wavenumber_rad_m, precision,
                 precision == Precision::fp64 ? largest_precise_run_blocks : most_blocks, std::nullopt,
                 tolerance);
}

SourceGroups precise_groups(const std::vector<CameraIlluminator> &illuminators,
                            const std::vector<VisibleBox> &visible, double wavenumber_rad_m,
                            const SourceGroups &groups) {
  return grouped(illuminators, visible, wavenumber_rad_m, Precision::fp64, 0, groups.blocks_per_run, 0.0);
}

std::uint32_t shining_diodes(const SourceGroups &groups) {
  return static_cast<std::uint32_t>(std::ranges::count_if(
      groups.positions, [](const SourcePosition &place) { return place.number != no_id; }));
}

} // namespace pmdsim
