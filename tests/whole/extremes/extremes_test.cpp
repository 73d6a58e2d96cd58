// How exact a frame is at the ends of what a setup can say: each axis alone from a middle setup, and the
// pairs of ends that strain the same part of the arithmetic. For every cell the device must keep the limit or
// refuse; what plain fp32 makes of it stands beside.

#include "tests/support/simulator.h"
#include "tests/whole/extremes/extreme_runs.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

using Change = void (*)(ExtremeSetup &);

struct End {
  std::string name;
  Change change;
};

struct Cell {
  std::string name;
  ExtremeSetup setup;
};

Cell cell(const std::vector<End> &ends) {
  Cell cell;
  for (const auto &[name, change] : ends) {
    cell.name += (cell.name.empty() ? "" : ", ") + name;
    change(cell.setup);
  }
  return cell;
}

const End middle{"middle: 2 m, 20 MHz, 240 diodes", [](ExtremeSetup &) {}};

const End at_1_mm{"wall at 1 mm", [](ExtremeSetup &s) { s.distance_m = 1e-3; }};
const End at_100_km{"wall at 100 km", [](ExtremeSetup &s) { s.distance_m = 1e5; }};
const End slow{"1 kHz", [](ExtremeSetup &s) { s.modulation_hz = 1e3; }};
const End fast{"10 GHz", [](ExtremeSetup &s) { s.modulation_hz = 10e9; }};
const End one_diode{"1 diode", [](ExtremeSetup &s) { s.diodes = 1; }};
const End many_diodes{"100,000 diodes", [](ExtremeSetup &s) { s.diodes = 100'000; }};
const End small_ring{"ring of 1 mm", [](ExtremeSetup &s) { s.ring_radius_m = 1e-3; }};
const End large_ring{"ring of 10 m", [](ExtremeSetup &s) { s.ring_radius_m = 10.0; }};
const End far_out{"1e7 m from the origin", [](ExtremeSetup &s) { s.offset_m = 1e7; }};
const End many_samples{"256 samples", [](ExtremeSetup &s) { s.samples = 16; }};
const End grazing{"at 89.999 deg", [](ExtremeSetup &s) { s.incidence_deg = 89.999; }};
const End tiny_triangles{"triangles of 1e-6 m", [](ExtremeSetup &s) { s.triangle_m = 1e-6; }};
const End huge_triangles{"triangles of 1e5 m", [](ExtremeSetup &s) { s.triangle_m = 1e5; }};
const End slivers{"slivers of 1e-6 x 1 m, and zero areas", [](ExtremeSetup &s) {
                    s.triangle_m = 1e-6;
                    s.aspect = 1e6;
                    s.zero_areas = true;
                  }};
const End weak{"1e-30 W/sr", [](ExtremeSetup &s) { s.intensity_w_sr = 1e-30; }};
const End strong{"1e30 W/sr", [](ExtremeSetup &s) { s.intensity_w_sr = 1e30; }};
const End outshone{"1e30 W/sr behind the wall", [](ExtremeSetup &s) { s.behind_w_sr = 1e30; }};
const End over_the_wall{"16 diodes 1 um off it", [](ExtremeSetup &s) {
                          s.diodes = 16;
                          s.over_wall_m = 1e-6;
                        }};
const End opposed{"opposed to 1e-3", [](ExtremeSetup &s) {
                    s.opposed = ExtremeSetup::Opposed::phase;
                    s.left_over = 1e-3;
                  }};
const End half_wave_behind{"half a wave behind, to 1e-3", [](ExtremeSetup &s) {
                             s.opposed = ExtremeSetup::Opposed::path;
                             s.left_over = 1e-3;
                           }};

std::vector<Cell> axes() {
  std::vector<Cell> cells{cell({middle})};
  auto opposed_by = ExtremeSetup::Opposed::no;
  const auto along = [&](const char *format, auto ExtremeSetup::*figure, const auto &values) {
    for (const auto value : values) {
      Cell cell{fmt::format(fmt::runtime(format), value), {}};
      cell.setup.*figure = value;
      cell.setup.opposed = opposed_by;
      cells.push_back(cell);
    }
  };
  using Values = std::vector<double>;
  using Counts = std::vector<std::uint32_t>;
  along("wall at {} m", &ExtremeSetup::distance_m, Values{1e-3, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4, 1e5});
  along("{} Hz", &ExtremeSetup::modulation_hz, Values{1e3, 1e5, 1e7, 1e8, 1e9, 1e10});
  along("{} diodes", &ExtremeSetup::diodes, Counts{1, 2, 17, 1000, 100'000});
  along("ring of {} m", &ExtremeSetup::ring_radius_m, Values{1e-3, 1e-2, 0.1, 1, 10});
  along("{} m from the origin", &ExtremeSetup::offset_m, Values{1e3, 1e5, 1e7});
  along("S = {}", &ExtremeSetup::samples, Counts{2, 7, 16});
  along("at {} deg", &ExtremeSetup::incidence_deg, Values{45, 80, 89, 89.9, 89.999});
  along("triangles of {} m", &ExtremeSetup::triangle_m, Values{1e-6, 1e-4, 1e-2, 1, 1e5});
  along("{} W/sr", &ExtremeSetup::intensity_w_sr, Values{1e-30, 1e-10, 1e30});
  for (const End &end : {slivers, over_the_wall})
    cells.push_back(cell({end}));
  opposed_by = ExtremeSetup::Opposed::phase;
  along("opposed, {} left over", &ExtremeSetup::left_over, Values{0.1, 1e-2, 1e-4, 1e-6, 0});
  opposed_by = ExtremeSetup::Opposed::path;
  along("half a wave behind, {} left over", &ExtremeSetup::left_over, Values{0.1, 1e-2, 1e-4, 1e-6, 0});
  return cells;
}

std::vector<Cell> worst_pairs() {
  const std::vector<std::vector<End>> pairs{
      {at_1_mm, slow},
      {at_1_mm, fast},
      {at_100_km, slow},
      {at_100_km, fast},
      {at_1_mm, small_ring},
      {at_1_mm, large_ring},
      {at_100_km, small_ring},
      {at_100_km, large_ring},
      {at_1_mm, many_diodes},
      {at_100_km, many_diodes},
      {at_1_mm, far_out},
      {at_100_km, far_out},
      {at_1_mm, grazing},
      {at_100_km, grazing},
      {at_1_mm, many_samples},
      {at_100_km, many_samples},
      {at_1_mm, tiny_triangles},
      {at_1_mm, weak},
      {at_1_mm, strong},
      {at_100_km, weak},
      {at_100_km, strong},
      {at_1_mm, one_diode},
      {at_100_km, one_diode},
      {slow, small_ring},
      {slow, large_ring},
      {fast, small_ring},
      {fast, large_ring},
      {fast, many_diodes},
      {fast, many_samples},
      {slow, many_samples},
      {fast, far_out},
      {slow, far_out},
      {fast, grazing},
      {slow, grazing},
      {large_ring, many_diodes},
      {large_ring, grazing},
      {large_ring, far_out},
      {far_out, grazing},
      {far_out, slivers},
      {far_out, tiny_triangles},
      {far_out, many_samples},
      {grazing, many_samples},
      {grazing, slivers},
      {over_the_wall, slow},
      {over_the_wall, fast},
      {over_the_wall, far_out},
      {over_the_wall, at_1_mm},
      {over_the_wall, at_100_km},
      {over_the_wall, strong},
      {over_the_wall, grazing},
      {opposed, at_1_mm},
      {opposed, at_100_km},
      {opposed, slow},
      {opposed, fast},
      {opposed, large_ring},
      {opposed, far_out},
      {opposed, weak},
      {opposed, grazing},
      {half_wave_behind, at_1_mm},
      {half_wave_behind, at_100_km},
      {half_wave_behind, slow},
      {half_wave_behind, fast},
      {half_wave_behind, many_samples},
      {large_ring, slow, at_1_mm},
      {large_ring, slow, grazing},
      {fast, large_ring, many_diodes},
      {at_1_mm, small_ring, many_diodes, strong},
      {at_100_km, slow, weak},
      {at_100_km, one_diode, weak},
      {outshone},
      {outshone, weak},
      {outshone, at_100_km, weak},
  };
  std::vector<Cell> cells;
  for (const std::vector<End> &ends : pairs)
    cells.push_back(cell(ends));
  return cells;
}

// The three ways to a frame that stand beside each other.
struct Runs {
  ExtremeRun chosen, fp32, fp64; // mode auto within the smallest limit; every diode in each precision
};

Runs run_all(Simulator &simulator, const ExtremeTruth &truth) {
  Accuracy within_limit, precise;
  within_limit.mode = Mode::automatic;
  within_limit.strict = true;
  within_limit.max_error_m = truth.smallest_limit_m();
  precise.precision = Precision::fp64;
  return {run(simulator, truth, within_limit), run(simulator, truth, {}), run(simulator, truth, precise)};
}

std::string heading() {
  return fmt::format("{:<52}{:>10}{:>10} |{:>10}{:>9}{:>5}{:>7}{:>9} |{:>10}{:>9}{:>9} |{:>10}{:>9}{:>9}\n",
                     "", "limit um", "condition", "auto um", "/limit", "", "diodes", "claim um", "fp32 um",
                     "/limit", "ampl.", "fp64 um", "/limit", "ampl.");
}

std::string errors(const ExtremeRun &run) {
  if (!run.refusal.empty())
    return fmt::format("{:>10}{:>9}", "refused", "");
  return fmt::format("{:>10.3g}{:>9.2g}{}", 1e6 * run.error_m, run.error_over_limit,
                     run.impossible > 0 ? fmt::format(" !{}", run.impossible) : "");
}

// The precision and diodes that mode auto picked, and the error that it claims.
std::string choice(const ExtremeRun &run) {
  if (!run.refusal.empty())
    return fmt::format("{:>21}", "");
  const AccuracyReport &report = run.accuracy;
  return fmt::format("{:>5}{:>7}{:>9}", report.precision == Precision::fp64 ? "fp64" : "fp32", report.diodes,
                     report.claimed_m ? fmt::format("{:.2g}", 1e6 * *report.claimed_m) : "");
}

std::string row(const Cell &cell, const ExtremeTruth &truth, const Runs &runs) {
  std::string text = fmt::format("{:<52}{:>10.3g}{:>10.3g} |{}{} |{}{:>9.1e} |{}{:>9.1e}\n", cell.name,
                                 1e6 * truth.smallest_limit_m(), truth.largest_condition(),
                                 errors(runs.chosen), choice(runs.chosen), errors(runs.fp32),
                                 runs.fp32.amplitude_error, errors(runs.fp64), runs.fp64.amplitude_error);
  if (!runs.chosen.refusal.empty())
    text += "    " + runs.chosen.refusal + "\n";
  return text;
}

void check(const ExtremeTruth &truth, const Runs &runs) {
  for (const ExtremeRun *run : {&runs.chosen, &runs.fp32, &runs.fp64}) {
    CHECK(run->refused_rightly);
    CHECK(run->impossible == 0);
    CHECK(run->differing <= truth.frame().range_m.size() / 20);
  }
  CHECK(runs.chosen.error_over_limit <= 1.0);
  // Mode auto promises the same error for all pixels.
  CHECK(runs.chosen.error_m <= truth.smallest_limit_m());
}

void check_cells(const std::vector<Cell> &cells) {
  Simulator simulator = make_simulator({.device = {}, .keep_sample_ids = true, .loop = DiodeLoop::looped});
  fmt::print("{}", heading());
  for (const Cell &cell : cells) {
    const ExtremeTruth truth(cell.setup);
    const Runs runs = run_all(simulator, truth);
    fmt::print("{}", row(cell, truth, runs));
    INFO(cell.name);
    check(truth, runs);
  }
}

std::vector<Cell> each_of(std::size_t step, const std::vector<Cell> &cells) {
  std::vector<Cell> result;
  for (std::size_t i = 0; i < cells.size(); i += step)
    result.push_back(cells[i]);
  return result;
}

} // namespace

TEST_CASE("some axes alone") { check_cells(each_of(8, axes())); }

TEST_CASE("each axis alone", "[long]") { check_cells(axes()); }

TEST_CASE("some of the worst pairs of axes") { check_cells(each_of(16, worst_pairs())); }

TEST_CASE("the worst pairs of axes", "[long]") { check_cells(worst_pairs()); }
