#include "engine/frame/frame_path.h"

#include "engine/light/host/host_sum.h"
#include "engine/sampling/sample_grid.h"
#include "engine/signal/demodulation_pass.h"
#include "engine/signal/direct_pixels.h"
#include "shaders/shared/interface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {
namespace {

SampleGrid grid_of(const Sensor &sensor) {
  return sensor.has_distortion() ? SampleGrid::distorted
         : is_tiled(sensor)      ? SampleGrid::tiled
         : is_nominal(sensor)    ? SampleGrid::nominal
                                 : SampleGrid::posed;
}

Summation summation_of(const FrameFacts &facts, const SourceGroups &groups) {
  return !facts.modulation.by_moments()  ? Summation::per_diode
         : groups.polynomials.powers > 0 ? Summation::polynomial_moments
                                         : Summation::moments;
}

// Whether the samples are an even grid over the chip. A pixel's only sample lies in its middle, however much
// of the pixel is filled.
bool is_even(SampleGrid grid, const Sensor &sensor) {
  return grid != SampleGrid::distorted && (sensor.samples == 1 || grid != SampleGrid::tiled);
}

// Where the host knows all of a pixel: it knows no paint.
bool may_make_pixels_on_host(const FrameFacts &facts, const PathForms &allowed) {
  return allowed.host_pixels && facts.host_is_device && facts.has_doubles && !facts.paint.painted;
}

// All but what the device would go on from.
bool may_sum_on_host(const FramePath &path, const FrameFacts &facts, const SourceGroups &groups,
                     const PathForms &allowed) {
  return path.windows <= 1 && facts.host_is_device && allowed.host_sum &&
         path.summation != Summation::per_diode && can_sum_on_host(groups);
}

// Whether pixels of one sample go to channels at once, if their sources can be summed so.
bool fits_channels(const FramePath &path, const FrameFacts &facts, const FramePlan &plan,
                   const Sensor &sensor, const PathForms &allowed) {
  const Modulation &modulation = facts.modulation;
  return allowed.direct_pixels && allowed.depth_records && sensor.samples == 1 &&
         is_even(path.grid, sensor) && plan.precision == Precision::fp32 &&
         modulation.waveform == shader::waveform_sine && modulation.frequencies() <= most_direct_frequencies;
}

// For any number of runs; the device makes pixels of one.
bool fits_host_pixels(const FramePath &path, const FrameFacts &facts, const FramePlan &plan,
                      const Sensor &sensor, const PathForms &allowed) {
  return fits_channels(path, facts, plan, sensor, allowed) && may_make_pixels_on_host(facts, allowed) &&
         may_sum_on_host(path, facts, plan.all, allowed);
}

// Where it sums beforehand the device is as fast, so that only shaded samples go to the host.
HostSum host_sum_of(const FramePath &path, const FrameFacts &facts, const FramePlan &plan,
                    const Sensor &sensor, const PathForms &allowed) {
  if (!may_sum_on_host(path, facts, plan.all, allowed))
    return HostSum::none;
  const bool makes_pixels = fits_host_pixels(path, facts, plan, sensor, allowed);
  if (!makes_pixels && !keeps_few_moments(plan.all))
    return HostSum::none;
  const bool is_whole = path.single_run || makes_pixels;
  const bool beforehand =
      plan.all.polynomials.point_dimensions > 0 && (facts.modulation.lit ? is_whole : facts.model.all_facing);
  return !beforehand ? HostSum::all : path.windows == 1 ? HostSum::partial : HostSum::none;
}

// Whether the light within a pixel changes as a known function does: paint does not, nor do beams' ends.
bool is_smooth(const FrameFacts &facts, const FramePlan &plan, const Sensor &sensor) {
  return !facts.paint.painted && sensor.vignetting == Vignetting::none &&
         std::isfinite(plan.extent.pattern_slope);
}

// Whether some pixels may not face all sources, or not be lit by all.
bool has_rest(const FrameFacts &facts) {
  return facts.modulation.lit || facts.model.backscatter != shader::backscatter_flat;
}

// The bits of several windows are never there together, so that nothing is known of a sample before it is
// summed.
bool can_sort(const FrameFacts &facts, std::size_t windows) { return !facts.modulation.lit || windows == 1; }

// Whether the pass from IDs to channels can sum such groups itself, as one straight line.
bool can_fuse(const SourceGroups &groups, const Modulation &modulation, const Sensor &sensor) {
  return modulation.waveform == shader::waveform_sine && !sensor.has_distortion() &&
         modulation.frequencies() <= shader::uniform_tones &&
         groups.runs.size() * groups.blocks_per_run <= usual_run_blocks;
}

// The number of points that do for the samples of a pixel whose light is uniform; nothing where none do.
std::optional<std::uint32_t> uniform_points(const FrameFacts &facts, const FramePlan &plan,
                                            const FrameRequest &request, const PathForms &allowed) {
  const Sensor &sensor = request.sensor;
  if (!plan.uniform_bound || !allowed.uniform_pixels ||
      !can_fuse(plan.uniform_groups, facts.modulation, sensor))
    return std::nullopt;
  const bool may_thin_out = sensor.adaptive_samples || request.accuracy.mode == Mode::automatic;
  if (sensor.samples == 1)
    return allowed.uniform_single_samples ? std::optional(1u) : std::nullopt;
  return is_smooth(facts, plan, sensor) && may_thin_out ? std::optional(1u) : std::nullopt;
}

void add_precise(const FrameFacts &facts, const FramePlan &plan, std::uint32_t samples,
                 std::vector<PixelClass> &classes) {
  if (plan.precise)
    classes.push_back(
        {PixelsOf::precise, false, samples, Precision::fp64, facts.modulation.lit, plan.bound_of_precise});
}

std::vector<PixelClass> sorted_classes(const FrameFacts &facts, const FramePlan &plan,
                                       const FrameRequest &request, const PathForms &allowed) {
  const std::uint32_t samples = request.sensor.samples * request.sensor.samples;
  const auto points = uniform_points(facts, plan, request, allowed);
  std::vector<PixelClass> classes;
  if (points)
    classes.push_back({PixelsOf::uniform, true, *points, Precision::fp32, false, plan.uniform_bound});
  if (points && samples > 1 && plan.refined_bound && allowed.refined_uniform_pixels)
    classes.push_back({PixelsOf::uniform_refined, true, 4, Precision::fp32, false, plan.refined_bound});
  // With one sample a pixel, the uniform pixels are all that every source lights; those that may not keep the
  // bound with the reduced set go to the rest.
  if (!points || samples > 1 || (!plan.surely_kept && !plan.precise))
    classes.push_back({PixelsOf::unshadowed, true, samples, plan.precision, false, plan.bound});
  if (has_rest(facts) || plan.precise)
    classes.push_back(
        {PixelsOf::rest, false, samples, plan.precision, facts.modulation.lit, plan.bound_of_all});
  add_precise(facts, plan, samples, classes);
  return classes;
}

// Whether the reduced set is worth it for every sample, as each faces all of its extent and all of it reaches
// the sample. Sums beforehand do not depend on the number of sources; few sources are summed in no more runs
// and moments than all.
bool reduced_set_lights_all(const FramePath &path, const FrameFacts &facts, const FramePlan &plan) {
  const bool is_worth_it = !path.field && plan.all.polynomials.point_dimensions == 0 &&
                           2 * plan.reduced.diodes.size() <= plan.all.diodes.size() &&
                           plan.reduced.runs.size() <= plan.all.runs.size() &&
                           plan.reduced.moments <= plan.all.moments;
  return is_worth_it && !facts.modulation.lit && facts.model.all_facing &&
         (facts.model.backscatter == shader::backscatter_flat || all_face(facts.camera, plan.extent.box));
}

std::vector<PixelClass> classes_of(const FramePath &path, const FrameFacts &facts, const FramePlan &plan,
                                   const FrameRequest &request, std::size_t windows, bool unsorted,
                                   const PathForms &allowed) {
  const std::uint32_t samples = request.sensor.samples * request.sensor.samples;
  if (unsorted) {
    const bool reduced = reduced_set_lights_all(path, facts, plan);
    std::vector<PixelClass> classes{{PixelsOf::all, reduced, samples, plan.precision, facts.modulation.lit,
                                     reduced ? plan.bound : plan.bound_of_all}};
    add_precise(facts, plan, samples, classes);
    return classes;
  }
  // With one sample a pixel, classes are worth their lists only where fewer sources do for some of them.
  const bool uniform = uniform_points(facts, plan, request, allowed).has_value();
  const bool is_thinned = uniform && request.sensor.samples > 1;
  const bool is_reduced = plan.is_reduced() && (uniform || has_rest(facts));
  const bool sorted = can_sort(facts, windows) && (is_thinned || is_reduced);
  if (sorted)
    return sorted_classes(facts, plan, request, allowed);
  // Where all samples are alike, the reduced set does for all of them.
  const bool reduced = plan.is_reduced() && !has_rest(facts);
  std::vector<PixelClass> classes{{PixelsOf::all, reduced, samples, plan.precision, facts.modulation.lit,
                                   reduced ? plan.bound : plan.bound_of_all}};
  if (can_sort(facts, windows))
    add_precise(facts, plan, samples, classes);
  return classes;
}

bool can_sum_records(const FramePath &path, const FramePlan &plan, const Sensor &sensor,
                     const PathForms &allowed) {
  const bool reads_depths = path.windows == 0 || path.single_run || path.host_sum != HostSum::none;
  return allowed.depth_records && reads_depths && path.summation != Summation::per_diode &&
         plan.precision == Precision::fp32 && is_even(path.grid, sensor);
}

bool can_be_direct(const FramePath &path, const FrameFacts &facts, const FramePlan &plan,
                   const Sensor &sensor, const PathForms &allowed) {
  return can_sum_records(path, plan, sensor, allowed) &&
         (path.single_run ? fits_channels(path, facts, plan, sensor, allowed)
                          : fits_host_pixels(path, facts, plan, sensor, allowed));
}

bool can_make_pixels_on_host(const FramePath &path, const FrameFacts &facts, const PathForms &allowed) {
  const bool sums_all =
      path.host_sum == HostSum::all ||
      (path.point_dimensions > 0 && (path.windows == 0 || path.host_sum == HostSum::partial));
  return path.direct && sums_all && may_make_pixels_on_host(facts, allowed);
}

// Of samples that every source lights and faces; 0 where they are not summed beforehand.
std::uint32_t dimensions_beforehand(const FramePath &path, const FrameFacts &facts, const FramePlan &plan) {
  const bool is_plain = !path.is_sorted() && !path.classes.front().reduced &&
                        (path.sums_records || !facts.modulation.keeps_terms) &&
                        plan.precision == Precision::fp32 && path.summation == Summation::polynomial_moments;
  return is_plain ? plan.all.polynomials.point_dimensions : 0;
}

// 0 unless the other samples are summed apart or are not there.
std::uint32_t point_dimensions(const FramePath &path, const FrameFacts &facts, const FramePlan &plan) {
  const bool takes_all = path.windows > 0 ? path.sums_records : facts.model.all_facing;
  return takes_all && path.host_sum != HostSum::all ? dimensions_beforehand(path, facts, plan) : 0;
}

// Where no shadows fall, only the host finds out which samples face all sources, as it makes their pixels.
void sum_facing_beforehand(const FrameFacts &facts, const FramePlan &plan, FramePath &path) {
  if (!path.host_pixels || path.windows > 0 || path.host_sum != HostSum::all)
    return;
  path.point_dimensions = dimensions_beforehand(path, facts, plan);
  if (path.point_dimensions > 0)
    path.host_sum = HostSum::partial;
}

// What sorting pixels into classes costs, in sources that the host would sum meanwhile: it makes pixels at
// once.
constexpr std::size_t sorting_sources = 256;

// Within an error, sorting pixels and reducing the sources costs more than it saves where sums beforehand do
// not depend on the number of sources, or where the reduced set saves less than half of them. With several
// samples a pixel this holds only where no point stands in for them, or where shadows may fall.
bool is_better_unsorted(const FramePath &path, const FrameFacts &facts, const FramePlan &plan,
                        const FrameRequest &request, const PathForms &allowed) {
  const bool on_host = fits_host_pixels(path, facts, plan, request.sensor, allowed);
  const bool beforehand = plan.all.polynomials.point_dimensions > 0 &&
                          (facts.modulation.lit || facts.model.all_facing || on_host);
  const bool thins_out = request.sensor.samples > 1 && !facts.modulation.lit &&
                         uniform_points(facts, plan, request, allowed).has_value();
  const std::size_t all = plan.all.diodes.size(), reduced = plan.reduced.diodes.size();
  return !thins_out && (beforehand || 2 * reduced > all ||
                        (on_host && (path.field || all <= reduced + sorting_sources ||
                                     reduced_set_lights_all(path, facts, plan))));
}

// Whether the sums of records can be held against what was asked for.
bool can_hold_records(const FrameFacts &facts, const FrameRequest &request) {
  return request.accuracy.mode == Mode::automatic && !request.sensor.adaptive_samples &&
         facts.modulation.by_moments() && resolves_at_once(facts.modulation);
}

// The host's raster knows neither the holes of shapes nor tiles, and leaves doubles.
bool can_raster_on_host(const FramePath &path, const FrameFacts &facts, const Sensor &sensor,
                        const PathForms &allowed) {
  return allowed.host_raster && facts.host_is_device && facts.has_doubles && !facts.paint.cutouts &&
         is_even(path.grid, sensor);
}

// With one sample a pixel, the classes begin with depths, and points are made for the later ones' lists.
bool begins_with_depths(const FramePath &path, const Sensor &sensor, const PathForms &allowed) {
  return allowed.depth_records && path.is_sorted() && sensor.samples == 1 && is_even(path.grid, sensor);
}

// Points of distorted samples, and bits in the order of the plan's sources, are there in the plan's
// precision.
Precision check_precision(const FrameFacts &facts, const FramePlan &plan, const Sensor &sensor) {
  return (facts.modulation.lit && !plan.precise) || sensor.has_distortion() ? plan.precision
                                                                            : Precision::fp64;
}

// In the order of the numbers that they stand for.
constexpr std::array pixels_names{"all", "uniform", "uniform_refined", "unshadowed", "rest", "precise"};
constexpr std::array grid_names{"nominal", "posed", "tiled", "distorted"};
constexpr std::array surface_names{"constant, all facing", "constant, tested", "lambert"};
constexpr std::array pattern_names{"isotropic", "one power of the cosine", "powers of the cosine",
                                   "diagram around the axis", "any"};
std::string host_sum_text(const FramePath &path) {
  return path.field ? fmt::format(", on the host at nodes of {0} x {0} pixels", path.field->grid.side)
         : path.host_sum == HostSum::all     ? ", on the host"
         : path.host_sum != HostSum::partial ? ""
         : path.windows > 0                  ? ", shaded samples on the host"
                                             : ", samples that turn away on the host";
}

constexpr std::array precision_names{"fp32", "fp64"};

std::string name_among(const auto &names, auto number) { return names[static_cast<std::size_t>(number)]; }

std::string text_of(const PixelClass &pixels) {
  return fmt::format("{}: {} sources, {} points a pixel, {}{}", name_among(pixels_names, pixels.who),
                     pixels.reduced ? "reduced" : "all", pixels.points,
                     name_among(precision_names, pixels.precision),
                     pixels.shadowed ? ", visibility bits" : "");
}

std::string summation_text(const FramePath &path) {
  switch (path.summation) {
  case Summation::polynomial_moments:
    return fmt::format("{} moments from {} powers{}{}{}{}", path.moments, path.powers,
                       path.equal_weights ? ", equal weights" : "", path.coplanar ? ", coplanar" : "",
                       path.point_dimensions > 0 ? ", summed beforehand" : "", host_sum_text(path));
  case Summation::moments:
    return fmt::format("{} moments{}", path.moments, host_sum_text(path));
  case Summation::per_diode:
    return "diode by diode";
  }
  return {};
}

std::string record_text(const FramePath &path) {
  return path.record == SampleRecord::point
             ? "point"
             : fmt::format("depth{}{}{}", path.one_backscatter ? ", one backscatter" : "",
                           path.direct ? ", to channels at once" : "",
                           path.host_pixels ? " on the host" : "");
}

std::string visibility_text(const FramePath &path) {
  if (path.windows == 0)
    return "not asked";
  return fmt::format("silhouettes on the {}{}", path.host_sweep ? "host" : "device",
                     path.holes ? ", holes" : "");
}

} // namespace

const PixelClass *FramePath::of(PixelsOf who) const {
  const auto found = std::ranges::find(classes, who, &PixelClass::who);
  return found == classes.end() ? nullptr : &*found;
}

FramePath choose_path(const FrameFacts &facts, const FramePlan &plan, const FrameRequest &request,
                      std::size_t windows, std::optional<float> one_backscatter, const PathForms &allowed) {
  const Sensor &sensor = request.sensor;
  FramePath path{};
  path.grid = grid_of(sensor);
  path.host_raster = can_raster_on_host(path, facts, sensor, allowed);
  path.windows = facts.modulation.lit ? static_cast<std::uint32_t>(windows) : 0;
  path.host_sweep = path.windows > 0 && facts.host_is_device && allowed.host_sweep;
  path.holes = path.windows > 0 && !facts.occluders.with_holes.empty();
  path.backscatter = facts.model.backscatter;
  path.pattern = facts.model.pattern;
  path.summation = summation_of(facts, plan.all);
  path.powers = plan.all.polynomials.powers;
  path.moments = plan.all.moments;
  path.equal_weights = plan.all.polynomials.equal_weights;
  path.coplanar = plan.all.polynomials.coplanar;
  path.single_run = plan.all.runs.size() == 1;
  path.host_sum = host_sum_of(path, facts, plan, sensor, allowed);
  if (fits_host_pixels(path, facts, plan, sensor, allowed))
    path.field = plan.field;
  path.one_backscatter = one_backscatter && !facts.paint.painted && allowed.one_backscatter;
  const bool reports = facts.modulation.keeps_terms;
  const bool holds = reports && allowed.unsorted && can_hold_records(facts, request) &&
                     can_sort(facts, windows) && is_better_unsorted(path, facts, plan, request, allowed) &&
                     can_sum_records(path, plan, sensor, allowed);
  const bool direct = can_be_direct(path, facts, plan, sensor, allowed) && (!reports || holds);
  path.classes = classes_of(path, facts, plan, request, windows, direct || holds, allowed);
  path.sums_records =
      direct || holds ||
      (!reports && !path.is_sorted() && !plan.is_reduced() && can_sum_records(path, plan, sensor, allowed));
  path.direct = direct;
  if (!path.sums_records)
    path.host_sum = HostSum::none;
  path.record = path.sums_records || begins_with_depths(path, sensor, allowed) ? SampleRecord::depth
                                                                               : SampleRecord::point;
  path.point_dimensions = point_dimensions(path, facts, plan);
  path.host_pixels = can_make_pixels_on_host(path, facts, allowed);
  sum_facing_beforehand(facts, plan, path);
  if (!path.host_pixels || path.host_sum != HostSum::all)
    path.field.reset();
  path.points_first = path.record == SampleRecord::point &&
                      (!path.is_sorted() || facts.modulation.lit || sensor.has_distortion());
  path.host_reads_truth = path.record == SampleRecord::depth && sensor.samples == 1;
  if (request.accuracy.mode != Mode::exact)
    path.check = check_precision(facts, plan, sensor);
  return path;
}

std::vector<std::pair<std::string, std::string>> description(const FramePath &path) {
  std::vector<std::string> classes;
  std::ranges::transform(path.classes, std::back_inserter(classes), text_of);
  return {{"grid", name_among(grid_names, path.grid)},
          {"record", record_text(path)},
          {"raster", path.host_raster ? "host" : "device"},
          {"visibility_windows", fmt::format("{}", path.windows)},
          {"visibility", visibility_text(path)},
          {"surface", name_among(surface_names, path.backscatter)},
          {"radiation_law", name_among(pattern_names, path.pattern)},
          {"sum", summation_text(path)},
          {"pixels", fmt::format("{}", fmt::join(classes, "; "))},
          {"spot_check", path.check ? name_among(precision_names, *path.check) : "none"}};
}

} // namespace pmdsim
