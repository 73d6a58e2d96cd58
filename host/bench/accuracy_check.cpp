#include "host/bench/accuracy_check.h"

#include "engine/model/error.h"
#include "host/capture/camera.h"
#include "host/capture/progress.h"
#include "host/report/findings.h"
#include "host/report/report.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr double affordable_interactions = 2e8; // some seconds of the reference
constexpr double shadow_ray_terms = 5.0; // in sines; among thin bars a ray takes the reference half of that

// The work that the reference does for one path, in sines: every frequency has its own correlation function,
// and all share what reaches the point.
double terms_per_path(const Sensor &sensor, Shadows shadows) {
  const Waveform &waveform = sensor.waveform;
  const double terms = waveform.kind == Waveform::Kind::harmonics
                           ? static_cast<double>(waveform.harmonics.size())
                       : waveform.kind == Waveform::Kind::square ? sensor.taps
                                                                 : 1.0;
  return terms * static_cast<double>(sensor.modulation_hz.size()) +
         (shadows == Shadows::automatic ? shadow_ray_terms : 0.0);
}

double interactions(const Sensor &sensor, std::size_t diode_count, Shadows shadows) {
  return static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples *
         static_cast<double>(diode_count) * terms_per_path(sensor, shadows);
}

// The differences between the samples and the reference's.
struct SampleDifferences {
  std::vector<bool> other_triangle, other_diodes; // by pixel: of any of its samples
  std::size_t pairs = 0, pairs_apart = 0;         // as in AccuracyCheck
};

// The number of diodes that reach the sample in one of the two frames only; each sample has `words` words of
// bits.
std::size_t diodes_apart(const Measurement &found, const reference::Frame &truth, std::size_t sample,
                         std::size_t words) {
  std::size_t apart = 0;
  for (std::size_t i = sample * words; i < (sample + 1) * words; ++i)
    apart += static_cast<std::size_t>(std::popcount(found.sample_visibility[i] ^ truth.sample_visibility[i]));
  return apart;
}

SampleDifferences differences(const Measurement &found, const reference::Frame &truth, const Sensor &sensor,
                              std::size_t diodes) {
  if (found.sample_triangle_id.size() != truth.sample_triangle_id.size() ||
      found.sample_visibility.size() != truth.sample_visibility.size())
    throw Error(ExitCode::internal, "the device and the reference do not tell of the same samples");
  const std::vector<bool> none(sensor.pixel_count(), false);
  SampleDifferences result{none, none};
  const std::size_t words = truth.sample_visibility.size() / truth.sample_triangle_id.size();
  const std::size_t columns = std::size_t{sensor.resolution.x} * sensor.samples;
  for (std::size_t sample = 0; sample < truth.sample_triangle_id.size(); ++sample) {
    const std::size_t pixel =
        sample / columns / sensor.samples * sensor.resolution.x + sample % columns / sensor.samples;
    if (found.sample_triangle_id[sample] != truth.sample_triangle_id[sample]) {
      result.other_triangle[pixel] = true;
    } else if (words > 0 && truth.sample_triangle_id[sample] != no_id) {
      const std::size_t apart = diodes_apart(found, truth, sample, words);
      result.pairs += diodes;
      result.pairs_apart += apart;
      result.other_diodes[pixel] = result.other_diodes[pixel] || apart > 0;
    }
  }
  return result;
}

// In W/(m^2 sr).
double darkest_comparable(const reference::FrameReturn &truth) {
  double brightest = std::ranges::max(truth.amplitude);
  for (const std::vector<double> &tap : truth.taps)
    for (const double value : tap)
      brightest = std::max(brightest, std::abs(value));
  return 1e-3 * brightest;
}

// Rounding decides a pair otherwise only where a ray all but touches an edge, in 1e-4 of the pairs at most.
// Ten times as many may pass, as other devices and coarser frames have other edges, and at least a line of
// pixels, as a shadow's edge may run through the middle of each.
std::size_t most_plausible_pairs_apart(const AccuracyCheck &check) {
  return std::max(check.pairs / 1000, std::size_t{std::max(check.resolution.x, check.resolution.y)});
}

void add_difference(AccuracyCheck &check, double difference_m) {
  const double off_m = std::abs(std::remainder(difference_m, check.ambiguity_m));
  ++check.pixels;
  check.not_finite += !std::isfinite(difference_m);
  check.too_far += !(off_m <= largest_plausible_error_m(check.ambiguity_m, check.claimed_m));
  check.distance_max_m = std::fmax(check.distance_max_m, off_m); // whichever is a number
}

} // namespace

AccuracyCheck compare(const Measurement &found, const reference::Frame &truth, const Sensor &sensor,
                      std::size_t frequency, std::size_t diodes) {
  AccuracyCheck check{sensor.name, sensor.modulation_hz[frequency], sensor.ambiguity_m(frequency),
                      sensor.resolution, found.accuracy.claimed_m.value_or(0.0)};
  const SampleDifferences samples = differences(found, truth, sensor, diodes);
  check.pairs = samples.pairs;
  check.pairs_apart = samples.pairs_apart;
  const reference::FrameReturn &expected = truth.returns[frequency];
  const std::vector<float> &found_m = found.returns[frequency].distance_m;
  const double darkest = darkest_comparable(expected);
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    if (!std::isfinite(expected.distance_m[pixel]) || !(expected.amplitude[pixel] > darkest))
      continue;
    ++check.comparable;
    if (samples.other_triangle[pixel])
      continue;
    ++check.same_triangles;
    if (!samples.other_diodes[pixel])
      add_difference(check, static_cast<double>(found_m[pixel]) - expected.distance_m[pixel]);
  }
  return check;
}

double largest_plausible_error_m(double ambiguity_m, double claimed_m) {
  return std::max(10e-6, 1e-6 * ambiguity_m) + claimed_m;
}

void require_plausible(const AccuracyCheck &check, const std::string &device) {
  const auto fail = [&](const std::string &what) {
    throw Error(ExitCode::internal, fmt::format("{}: sensor {} at {}: {}", device, check.sensor,
                                                frequency_text(check.modulation_hz), what));
  };
  // Rounding moves samples to another triangle at edges only.
  if (2 * check.same_triangles < check.comparable)
    fail(fmt::format("sees the reference's triangles in {} of {} pixels; expected at least half",
                     check.same_triangles, check.comparable));
  if (const std::size_t limit = most_plausible_pairs_apart(check); check.pairs_apart > limit)
    fail(fmt::format("{} of {} pairs of sample and diode are lit where the reference's are not, or the other "
                     "way round; expected at most {}",
                     check.pairs_apart, check.pairs, limit));
  if (check.not_finite > 0)
    fail(fmt::format("distances are not finite in {} of {} pixels where the reference's are",
                     check.not_finite, check.pixels));
  const double limit_m = largest_plausible_error_m(check.ambiguity_m, check.claimed_m);
  if (check.distance_max_m > limit_m)
    fail(fmt::format("distances differ from the reference by up to {:.6g} mm; expected at most {:.6g} mm",
                     1e3 * check.distance_max_m, 1e3 * limit_m));
}

Sensor affordable(Sensor sensor, std::size_t diode_count, Shadows shadows, std::size_t sensors) {
  const double share = affordable_interactions / static_cast<double>(sensors);
  const auto coarse = [&] {
    return coarser(sensor, std::sqrt(interactions(sensor, diode_count, shadows) / share));
  };
  if (interactions(coarse(), diode_count, shadows) > share)
    sensor.samples = 1;
  return coarse();
}

std::vector<ReferenceFrame> reference_frames(const Setup &setup) {
  const auto &[scene, sensors, illuminators, others] = setup.start;
  std::vector<ReferenceFrame> frames;
  ProgressBar bar(static_cast<double>(sensors.size()));
  for (const Sensor &fine : sensors) {
    const Sensor sensor = affordable(fine, diode_count(illuminators), setup.shadows, sensors.size());
    bar.begin("measuring the reference", 1.0);
    frames.push_back({sensor, reference::simulate(scene, sensor, illuminators, setup.backscatter,
                                                  {.shadows = setup.shadows,
                                                   .keep_visibility = setup.shadows == Shadows::automatic},
                                                  interruptible_progress(bar))});
  }
  return frames;
}

std::vector<AccuracyCheck> check_accuracy(const Setup &setup, const std::vector<ReferenceFrame> &truth,
                                          const std::string &device, const Accuracy &accuracy) {
  Camera camera(device, {.sample_triangles = true, .reached = setup.shadows == Shadows::automatic});
  std::vector<AccuracyCheck> checks;
  ProgressBar bar(static_cast<double>(truth.size()));
  for (const auto &[sensor, frame] : truth) {
    camera.prepare(setup, sensor, accuracy);
    bar.begin("measuring what is checked", 1.0);
    const Measurement found = camera.measure_light(interruptible_progress(bar));
    for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
      checks.push_back(compare(found, frame, sensor, i, diode_count(setup.start.illuminators)));
  }
  return checks;
}

} // namespace pmdsim
