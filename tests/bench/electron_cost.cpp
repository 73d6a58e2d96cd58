// The cost of a sensor's electronics: frames of scenes/paper_ring.json with and without, in alternation,
// warm. Not a test: times are reported, never asserted. The noise is checked against its prediction first.

#include "engine/electronics/electrons.h"
#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "tests/bench/times.h"

#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

constexpr int rounds = 41;

Electronics electronics() {
  Electronics of;
  of.integration_time_s = 1e-4;
  of.quantum_efficiency = 0.5;
  of.lens_f_number = 2.0;
  of.demodulation_contrast = {0.5};
  of.full_well_e = 150e3;
  of.read_noise_e = 75.0;
  of.gain_dn_per_e = 0.0265;
  of.offset_dn = 64.0;
  return of;
}

// One kind of frame, on a simulator of its own.
class Variant {
public:
  Variant(std::string name, const Setup &setup, const Sensor &sensor, bool keep_taps)
      : name_(std::move(name)), sensor_(sensor), keep_taps_(keep_taps),
        simulator_(SimulatorOptions{.device = {}, .keep_taps = keep_taps, .count_electrons = true}) {
    std::vector<Illuminator> lights = setup.start.illuminators;
    for (Illuminator &light : lights)
      for (Diode &diode : light.diodes)
        diode.intensity_w_sr = 0.003;
    simulator_.prepare(setup.start.scene, sensor_, lights, setup.backscatter);
  }

  const std::string &name() const { return name_; }

  Measurement measure(std::uint32_t number) {
    Measurement frame = simulator_.measure({}, {0, number, 0});
    if (sensor_.electronics && !frame.has_electrons)
      count_electrons(sensor_, {.keep_taps = keep_taps_}, frame);
    return frame;
  }

  void take(std::uint32_t number) {
    Measurement frame = measure(number);
    times_ms_.push_back(frame.frame_ms);
    simulator_.reuse(std::move(frame));
  }

  bench::Times times() const { return bench::spread({times_ms_.begin() + 1, times_ms_.end()}); }

private:
  std::string name_;
  Sensor sensor_;
  bool keep_taps_;
  Simulator simulator_;
  std::vector<double> times_ms_;
};

// The root of the mean square of (difference of two frames) / (sqrt(2) predicted noise): 1.
double noise_over_prediction(Variant &variant) {
  const Measurement a = variant.measure(1000), b = variant.measure(1001);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.coverage.size(); ++i) {
    const double apart = a.returns[0].distance_m[i] - b.returns[0].distance_m[i];
    const double predicted = a.returns[0].distance_noise_m[i];
    sum += apart * apart / (2.0 * predicted * predicted);
  }
  return std::sqrt(sum / static_cast<double>(a.coverage.size()));
}

} // namespace

int main() {
  const Setup setup = load_setup(PMDSIM_SCENES "/paper_ring.json");
  const Sensor noiseless = setup.start.sensors[0];
  Sensor noisy = noiseless, patterned = noiseless, of_one_tap = noiseless, beside = noiseless;
  noisy.electronics = patterned.electronics = of_one_tap.electronics = beside.electronics = electronics();
  beside.electronics->noiseless_channels = true;
  of_one_tap.electronics->two_tap = false;
  patterned.electronics->prnu = 0.01;
  patterned.electronics->dsnu_e = 100.0;
  std::vector<Variant> variants;
  variants.emplace_back("noiseless", setup, noiseless, false);
  variants.emplace_back("electronics", setup, noisy, false);
  variants.emplace_back("electronics with a fixed pattern", setup, patterned, false);
  variants.emplace_back("electronics of one tap", setup, of_one_tap, false);
  variants.emplace_back("electronics beside noiseless channels", setup, beside, false);
  variants.emplace_back("noiseless, taps kept", setup, noiseless, true);
  variants.emplace_back("electronics, taps kept", setup, noisy, true);
  const std::size_t of_taps = variants.size() - 2; // the first one whose taps are kept
  const double checked = noise_over_prediction(variants[1]);
  for (std::uint32_t round = 0; round <= rounds; ++round)
    for (Variant &variant : variants)
      variant.take(round);
  fmt::print("{} x {} pixels, {} diodes, N = {}, {} rounds; noise over prediction {:.4f}\n",
             noiseless.resolution.x, noiseless.resolution.y, setup.start.illuminators[0].diodes.size(),
             noiseless.taps, rounds, checked);
  fmt::print("{:<38}{:>10}{:>10}{:>10}{:>10}\n", "frame, ms", "median", "min", "max", "times");
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const bench::Times of = variants[i].times();
    fmt::print("{:<38}{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}\n", variants[i].name(), of.median_ms, of.min_ms,
               of.max_ms, of.median_ms / variants[i < of_taps ? 0 : of_taps].times().median_ms);
  }
}
