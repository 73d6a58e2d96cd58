#include "engine/multipath/multipath.h"

#include "engine/model/error.h"
#include "engine/model/stopwatch.h"
#include "engine/multipath/bounced_channels.h"
#include "engine/multipath/bounced_image.h"
#include "engine/multipath/fineness.h"
#include "engine/radiosity/radiosity.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

namespace pmdsim {
namespace {

constexpr int most_tries = 5; // each for less error than the one before
// A try is the last if it leaves so much of the error claimed before, and that is so much more than was asked
// for.
constexpr double hardly_less = 0.8, far_too_much = 1.3;
// Parts of the error asked for: what lines and interpolation aim at, and what elements may be off by.
// Together they come to it; measured over boxes and rooms.
constexpr double of_gather = 0.7, most_of_elements = 0.65;
constexpr double promised = 0.95; // share of the pixels that keep what is claimed

// The part of a pixel's light that the error of each tone may be.
std::vector<float> parts_of(const std::vector<BounceTone> &tones, const Sensor &sensor, double error_m) {
  constexpr double least_harmonic = 1e-3; // weaker ones need not be more exact
  constexpr double most = 0.5;
  constexpr float mean_part = 0.01f; // shot noise follows its root
  std::vector<float> parts;
  for (const BounceTone &tone : tones) {
    if (tone.is_mean()) {
      parts.push_back(mean_part);
      continue;
    }
    const double rad = 2.0 * std::numbers::pi * error_m / sensor.ambiguity_m(tone.frequency);
    parts.push_back(
        static_cast<float>(std::min(rad, most) / std::max(std::abs(tone.relative), least_harmonic)));
  }
  return parts;
}

[[noreturn]] void refuse(double reached_m, double asked_m) {
  throw Error(
      ExitCode::accuracy,
      fmt::format("multipath is off by up to {:.3g} mm in 95 % of the pixels, as estimated with the finest "
                  "elements and the most lines: expected at most {:.3g} mm (\"bounce_error\")",
                  1e3 * reached_m, 1e3 * asked_m));
}

// Of the frequency where it is largest.
double claimed_m(const Measurement &measurement) {
  double most_m = 0.0;
  for (const Return &of_frequency : measurement.returns)
    most_m = std::max(most_m, quantile(of_frequency.multipath_error_m, promised));
  return most_m;
}

} // namespace

// Solutions for the tones that were asked for, as sensors may differ in them.
struct Multipath::State {
  struct Solved {
    std::vector<BounceTone> tones;
    double error_m; // that its elements were made for
    Radiosity radiosity;
  };

  Scene scene;
  std::vector<Illuminator> illuminators;
  Shadows shadows = Shadows::automatic;
  Bounces bounces;
  Sensor sensor;
  BounceTones tones;
  std::vector<Solved> solved;

  // The largest of few errors that is no more than that, so that solutions of one frame serve others, too.
  double step_below(double error_m) const {
    constexpr double step = 0.8, rounding = 1e-9;
    const double most_m = first_of_elements * bounces.max_error_m;
    const double steps = std::ceil(std::log(error_m / most_m) / std::log(step) - rounding);
    return most_m * std::pow(step, std::max(steps, 0.0));
  }

  // The solution of the tones that are asked for, with elements made for that error. One for less error that
  // is known will not do: what a frame holds must not depend on the frames before it.
  Solved &solution(double error_m) {
    const auto known = std::ranges::find_if(
        solved, [&](const Solved &one) { return one.tones == tones.tones && one.error_m == error_m; });
    if (known != solved.end())
      return *known;
    Radiosity radiosity = solve_radiosity(scene, illuminators, shadows, bounces, tones.tones,
                                          fineness_of(scene, tones.tones, error_m));
    return solved.emplace_back(tones.tones, error_m, std::move(radiosity));
  }

  // A solution whose elements are off by no more than they may be where the frame looks, made for an error of
  // `elements_m` at most. Throws Error: accuracy, where they alone are off by more than was asked for,
  // however fine.
  Solved &exact_solution(double error_m, double elements_m, const Measurement &measurement,
                         const ImageAim &aim) {
    Solved *found = &solution(step_below(std::min(elements_m, first_of_elements * error_m)));
    while (true) {
      const SeenPlaces seen(scene, sensor, measurement, found->radiosity.elements.origin_m);
      const double times = quantile(times_off(found->radiosity, tones.tones, seen, aim), promised);
      if (times <= most_of_elements)
        return *found;
      // Somewhat finer than it should take, and so much that more triangles are cut.
      const double finer_m =
          step_below(found->error_m * std::clamp(std::pow(0.85 * most_of_elements / times, 1.5), 0.2, 0.55));
      if (fineness_of(scene, tones.tones, finer_m).element_m ==
          fineness_of(scene, tones.tones, found->error_m).element_m) {
        if (times * error_m > bounces.max_error_m)
          refuse(times * error_m, bounces.max_error_m);
        return *found;
      }
      found = &solution(finer_m);
    }
  }
};

Multipath::Multipath() : state_(std::make_unique<State>()) {}
Multipath::~Multipath() = default;

void Multipath::prepare(const BouncesRequest &request) {
  State &state = *state_;
  if (state.scene != request.scene || state.illuminators != request.illuminators ||
      state.shadows != request.shadows || state.bounces != request.bounces) {
    state.solved.clear();
    state.scene = request.scene;
    state.illuminators = request.illuminators;
    state.shadows = request.shadows;
    state.bounces = request.bounces;
  }
  state.sensor = request.sensor;
  state.tones = bounce_tones(request.sensor);
}

void Multipath::add_to(Measurement &measurement, const std::function<void(double)> &progress) {
  State &state = *state_;
  const auto &tones = state.tones.tones;
  const std::vector<std::vector<Phasor>> direct = direct_light(measurement, tones);
  double claimed = std::numeric_limits<double>::infinity(), error_m = state.bounces.max_error_m;
  double elements_m = claimed; // that the elements of the try before were made for
  Stopwatch stopwatch;
  for (int i = 0; i < most_tries; ++i) {
    const ImageAim asked{parts_of(tones, state.sensor, error_m), direct};
    const State::Solved &found = state.exact_solution(error_m, elements_m, measurement, asked);
    const Radiosity &radiosity = found.radiosity;
    elements_m = found.error_m;
    stopwatch.add_to(measurement, "bounces");
    const SeenPlaces seen(state.scene, state.sensor, measurement, radiosity.elements.origin_m);
    const ImageAim aim{parts_of(tones, state.sensor, of_gather * error_m), direct};
    const BouncedImage image = gather_image(radiosity, tones, seen, state.sensor.resolution, aim, progress);
    Measurement with = measurement;
    add_bounced(image, state.tones, state.sensor, with);
    const double before = std::exchange(claimed, claimed_m(with));
    with.bounces = BouncesReport{radiosity.elements.elements.size(), radiosity.lines + image.lines,
                                 radiosity.products, claimed};
    stopwatch.add_to(with, "gather");
    if (claimed <= state.bounces.max_error_m) {
      measurement = std::move(with);
      return;
    }
    measurement.passes = with.passes;
    measurement.frame_ms = with.frame_ms;
    if (claimed > hardly_less * before && claimed > far_too_much * state.bounces.max_error_m)
      break;
    error_m *= std::clamp(0.9 * state.bounces.max_error_m / claimed, 0.3, 0.9);
  }
  refuse(claimed, state.bounces.max_error_m);
}

} // namespace pmdsim
