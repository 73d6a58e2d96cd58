#include "engine/multipath/fineness.h"
#include "engine/multipath/multipath.h"
#include "engine/surfaces/grading.h"

#include <chrono>
#include <cmath>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

// Seconds that a line takes, with all threads at work.
double seconds_of_line(const HemisphereScan &scan, const Elements &elements) {
  constexpr std::uint32_t lines = 48;
  constexpr std::size_t places = 200;
  const auto start = std::chrono::steady_clock::now();
  tbb::parallel_for(std::size_t{0}, places, [&](std::size_t i) {
    const Element &element = elements.elements[i * elements.elements.size() / places];
    scan.at(scan.frame(element.places[0], turn_of(i), lines), lines, [](const SeenLine &) {});
  });
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  return taken.count() / (places * lines);
}

} // namespace

// The number of places at which light is gathered, the lines of each, and what else takes time are those of
// the scenes with bounces in BENCHMARKS.md; there the time is right within a factor of 3.
BouncesForecast Multipath::forecast(const Scene &scene, const Sensor &sensor, const Bounces &bounces) {
  const std::vector<BounceTone> tones = bounce_tones(sensor).tones;
  const double error_m = first_of_elements * bounces.max_error_m;
  const Fineness fineness = fineness_of(scene, tones, error_m);
  Elements elements = make_elements(scene, fineness.element_m);
  if (elements.elements.empty())
    return {};
  const FacetTree tree(scene, elements);
  grade_elements(scene, tree, elements);
  const HemisphereScan scan(scene, elements, fineness.bins);
  const double samples = static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples;
  const double places = std::min(35.0 * std::sqrt(samples), samples), lines_of_place = 75.0;
  const auto elements_places = static_cast<double>(elements.elements.size() * places_of_piece);
  const double lines = 2.0 * elements_places * fineness.lines +
                       places * lines_of_place * std::sqrt(1e-3 / bounces.max_error_m);
  const double for_light = 0.7 + 0.5 * static_cast<double>(tones.size()); // beside the lines themselves
  return {elements.elements.size(), (1.0 + for_light) * lines * seconds_of_line(scan, elements)};
}

} // namespace pmdsim
