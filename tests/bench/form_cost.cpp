// The time that each special form of a frame's path saves: whole frames with it and without, in turn, warm. A
// round is one frame of each. Prints Markdown for docs/decisions.md.

#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "tests/bench/times.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <vector>

using namespace pmdsim;

namespace {

constexpr int rounds = 15;

struct Form {
  std::string name;
  bool PathForms::*allowed;
};

const std::vector<Form> forms{
    {"depth records", &PathForms::depth_records},
    {"one backscatter", &PathForms::one_backscatter},
    {"polynomial moments", &PathForms::polynomial_moments},
    {"equal weights", &PathForms::equal_weights},
    {"coplanar sources", &PathForms::coplanar},
    {"sums over the diodes beforehand", &PathForms::point_polynomials},
    {"direct pixels", &PathForms::direct_pixels},
    {"direct pixels on the host", &PathForms::host_pixels},
    {"uniform pixels", &PathForms::uniform_pixels},
    {"uniform pixels of one sample", &PathForms::uniform_single_samples},
    {"refined uniform pixels", &PathForms::refined_uniform_pixels},
};

struct Case {
  std::string name;
  std::string scene; // of scenes/
  std::uint32_t samples = 1;
  Mode mode = Mode::exact;
  std::function<void(Setup &)> change = [](Setup &) {};
};

void give_cosines(Setup &setup, double order) {
  setup.backscatter = Backscatter::lambert;
  for (Illuminator &illuminator : setup.start.illuminators)
    for (Diode &diode : illuminator.diodes) {
      diode.pattern.kind = Pattern::Kind::cosine;
      diode.pattern.order = order;
    }
}

void give_wide_beams(Setup &setup) { give_cosines(setup, 3.0); }
void give_narrow_beams(Setup &setup) { give_cosines(setup, 40.0); }

void light_through(Setup &setup) { setup.shadows = Shadows::off; }

const std::vector<Case> cases{
    {"paper ring", "paper_ring"},
    {"paper ring, S = 4", "paper_ring", 4},
    {"Lambert wall, cos^3", "paper_ring", 1, Mode::exact, give_wide_beams},
    {"Lambert wall, cos^3, S = 4", "paper_ring", 4, Mode::exact, give_wide_beams},
    {"lit room", "room", 1, Mode::exact, light_through},
    {"shadowed room", "room"},
    {"paper ring, auto", "paper_ring", 1, Mode::automatic},
    {"paper ring, auto, S = 4", "paper_ring", 4, Mode::automatic},
    {"Lambert wall, cos^3, auto, S = 4", "paper_ring", 4, Mode::automatic, give_wide_beams},
    {"lit room, auto", "room", 1, Mode::automatic, light_through},
    {"lit room, auto, S = 4", "room", 4, Mode::automatic, light_through},
    {"narrow beams, auto, S = 4", "paper_ring", 4, Mode::automatic, give_narrow_beams},
};

Setup setup_of(const Case &of) {
  Setup setup = load_setup(std::string(PMDSIM_SCENES "/") + of.scene + ".json");
  setup.start.sensors.resize(1);
  setup.start.sensors[0].samples = of.samples;
  of.change(setup);
  return setup;
}

Simulator prepared(const Case &of, const Setup &setup, const PathForms &allowed) {
  Accuracy accuracy;
  accuracy.mode = of.mode;
  Simulator simulator({.device = {}, .allowed = allowed});
  simulator.prepare(setup.start.scene, setup.start.sensors[0], setup.start.illuminators, setup.backscatter,
                    setup.shadows, accuracy);
  return simulator;
}

double frame_ms(Simulator &simulator) {
  Measurement frame = simulator.measure();
  const double ms = frame.frame_ms;
  simulator.reuse(std::move(frame));
  return ms;
}

void compare(const Case &of, const Setup &setup, Simulator &with, const Form &form) {
  PathForms allowed;
  allowed.*form.allowed = false;
  Simulator without = prepared(of, setup, allowed);
  if (without.path() == with.path())
    return; // the frame does not take the form
  frame_ms(with), frame_ms(without);
  std::vector<double> with_ms, without_ms, ratios;
  for (int round = 0; round < rounds; ++round) {
    with_ms.push_back(frame_ms(with));
    without_ms.push_back(frame_ms(without));
    ratios.push_back(without_ms.back() / with_ms.back());
  }
  const bench::Times ratio = bench::spread(ratios);
  fmt::print("| {} | {} | {:.1f} | {:.1f} | {:.2f} | {:.2f} to {:.2f} |\n", form.name, of.name,
             bench::spread(with_ms).median_ms, bench::spread(without_ms).median_ms, ratio.median_ms,
             ratio.min_ms, ratio.max_ms);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
  const std::string wanted = argc > 1 ? argv[1] : ""; // of a case's name
  const std::string wanted_form = argc > 2 ? argv[2] : "";
  fmt::print(
      "| form | frame | with, ms | without, ms | without / with | spread |\n|---|---|---|---|---|---|\n");
  for (const Case &of : cases) {
    if (of.name.find(wanted) == std::string::npos)
      continue;
    const Setup setup = setup_of(of);
    Simulator with = prepared(of, setup, {});
    for (const Form &form : forms)
      if (form.name.find(wanted_form) != std::string::npos)
        compare(of, setup, with, form);
  }
}
