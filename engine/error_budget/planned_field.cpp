#include "engine/error_budget/planned_field.h"

#include "engine/error_budget/field_error.h"
#include "engine/error_budget/typical_light.h"
#include "engine/light/radiation_laws.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

// The share of the error asked for that sums by the field may claim where nothing cancels.
constexpr double share_of_field = 0.5;
// Sums at a node, in sums at a sample; and what it takes to interpolate, in sources at a sample.
constexpr double node_cost = 1.5, interpolated_sources = 24.0;

// What all of the frame's sums take, in sums over a source at a sample.
double cost(const Sensor &sensor, const SourceGroups &groups, const FieldCells &cells) {
  constexpr double nodes_of_cell = field_nodes * field_nodes * field_nodes;
  return groups.diode_count * nodes_of_cell * node_cost * cells.count() +
         static_cast<double>(groups.runs.size()) * interpolated_sources *
             static_cast<double>(sensor.pixel_count());
}

double farthest_lamp_m(const std::vector<CameraIlluminator> &lights) {
  double farthest_m = 0.01;
  for (const CameraIlluminator &light : lights)
    for (const Diode &diode : light.diodes)
      farthest_m = std::max(farthest_m, glm::length(diode.position_m));
  return farthest_m;
}

// From the nearest depth that is seen to a hair beyond the farthest.
struct DepthRange {
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0.0;
};

DepthRange depths_of(const std::vector<VisibleBox> &visible) {
  constexpr double beyond = 1.000001;
  DepthRange range;
  for (const VisibleBox &box : visible)
    range = {std::min(range.nearest_m, box.low_m.z), std::max(range.farthest_m, beyond * box.high_m.z)};
  return range;
}

// Whether the host would sum over the sources at each sample else.
bool is_summed_at_samples(const LightFacts &view, const SourceGroups &groups) {
  const PathForms &allowed = view.allowed;
  return view.on_host && allowed.host_pixels && allowed.host_sum && allowed.direct_pixels &&
         allowed.depth_records && allowed.unsorted && !view.painted && view.sensor.samples == 1 &&
         !view.sensor.has_distortion() && view.sensor.chip.is_nominal() &&
         view.modulation.waveform == shader::waveform_sine && groups.polynomials.point_dimensions == 0;
}

// Whether J is above 0 in all directions within `most_rad` of the axis.
bool shines(const Diagram &diagram, double most_rad) {
  const std::size_t phis = diagram.phi_rad.size();
  const auto above = std::ranges::upper_bound(diagram.theta_rad, most_rad);
  if (diagram.theta_rad.front() > 0.0 || above == diagram.theta_rad.end())
    return false;
  const auto count = static_cast<std::ptrdiff_t>(phis) * (above - diagram.theta_rad.begin() + 1);
  return std::all_of(diagram.relative.begin(), diagram.relative.begin() + count,
                     [](double j) { return j > 0.0; });
}

// Whether the diode's light neither ends nor nearly ends between the corners. Directions within less than a
// right angle of an axis are convex, so that the corners hold the largest angle.
bool shines(const Diode &diode, const CellCorners &corners_m) {
  constexpr double least_cosine = 0.1;
  const RadiationLaw &law = law_of(diode.pattern);
  if (law.value == nullptr)
    return false;
  const Diagram *diagram = diode.pattern.diagram.get();
  if (!diagram && law.edge == nullptr)
    return true;
  double least = 1.0;
  for (const glm::dvec3 &corner_m : corners_m) {
    const glm::dvec3 way_m = corner_m - diode.position_m;
    least = std::min(least, glm::dot(diode.axis, way_m) / glm::length(way_m));
  }
  return least >= least_cosine && (!diagram || shines(*diagram, std::acos(least)));
}

bool all_shine(const LightFacts &view, const CellCorners &corners_m) {
  return std::ranges::all_of(view.lights, [&](const CameraIlluminator &light) {
    return std::ranges::all_of(light.diodes, [&](const Diode &diode) { return shines(diode, corners_m); });
  });
}

// Where a run's diodes have one power of the cosine, and nearly one axis.
FieldBeam beam_of(const SourceGroups &groups, const SourceRun &run) {
  constexpr double common_axis = 0.95; // 18 degrees
  std::vector<const shader::GroupSource *> sources;
  glm::dvec3 axis(0.0);
  for (std::uint32_t i = run.first; i < run.first + groups.blocks_per_run * shader::diodes_per_block; ++i)
    if (groups.positions[i].number != no_id) {
      sources.push_back(&groups.diodes[i]);
      axis += glm::dvec3(groups.diodes[i].axis);
    }
  axis = glm::normalize(axis);
  const auto is_along = [&](const shader::GroupSource *source) {
    return source->order == sources.front()->order && glm::dot(glm::dvec3(source->axis), axis) > common_axis;
  };
  const bool has_beam =
      !sources.empty() && sources.front()->order > 0.0f && std::ranges::all_of(sources, is_along);
  return {{axis.x, axis.y, axis.z},
          has_beam ? exponent_of(static_cast<double>(sources.front()->order)) : Exponent{}};
}

std::vector<FieldBeam> beams_of(const SourceGroups &groups) {
  std::vector<FieldBeam> beams;
  for (const SourceRun &run : groups.runs)
    beams.push_back(beam_of(groups, run));
  return beams;
}

// Whether sums over the sources are loops, of terms that may be interpolated.
bool suits(const LightFacts &view, const SourceGroups &groups, const DepthRange &seen) {
  constexpr double largest_rad = 0.5; // the error of a path is that of a phase's first power
  return view.allowed.incident_field && is_summed_at_samples(view, groups) && seen.nearest_m > 0.0 &&
         seen.farthest_m > 0.0 && std::isfinite(seen.farthest_m) &&
         view.modulation.largest_wavenumber_rad_m() * groups.path_difference_m <= largest_rad;
}

// From the largest cells on. In 1 / depth each takes a part of 1 / lamp_m.
std::vector<FieldGrid> grids_of(double lamp_m, double farthest_m) {
  std::vector<FieldGrid> grids;
  for (const std::uint32_t side : {64u, 32u, 16u})
    for (const double part : {0.25, 0.125, 0.0625, 0.03125, 0.015625})
      grids.push_back({side, lamp_m / part, farthest_m});
  return grids;
}

} // namespace

std::optional<InterpolatedField> plan_field(const LightFacts &view, const SourceGroups &groups,
                                            const ErrorBound &bound) {
  const DepthRange seen = depths_of(view.visible);
  if (!suits(view, groups, seen))
    return std::nullopt;
  const std::vector<FieldGrid> grids = grids_of(farthest_lamp_m(view.lights), seen.farthest_m);
  const double wavenumber_rad_m = view.modulation.largest_wavenumber_rad_m();
  const TypicalLight typical = typical_light_at(
      FieldCells(view.sensor, grids[0], view.visible).random_places_m(), view.lights, wavenumber_rad_m);
  const auto is_kept = [&](const ErrorBound &of) {
    return of.nearest_m(typical.condition, typical.dimming_of_most) <= share_of_field * of.limit_m &&
           of.amplitude_fixed + of.amplitude_per_condition <= share_of_field * of.amplitude_limit;
  };
  const std::vector<FieldBeam> beams = beams_of(groups);
  const double at_samples = groups.diode_count * static_cast<double>(view.sensor.pixel_count());
  for (const FieldGrid &grid : grids) {
    const FieldCells cells(view.sensor, grid, view.visible);
    if (!cells.any() || 2.0 * cost(view.sensor, groups, cells) > at_samples ||
        !all_shine(view, cells.corners_m()))
      continue;
    const auto is_beyond = [&](const FieldError &error) {
      return !is_kept(through_field(bound, error, wavenumber_rad_m));
    };
    const FieldError error = field_error(view, groups, beams, cells, is_beyond);
    if (!is_beyond(error))
      return InterpolatedField{grid, beams, through_field(bound, error, wavenumber_rad_m)};
  }
  return std::nullopt;
}

} // namespace pmdsim
