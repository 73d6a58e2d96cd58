#include "host/tolerance/diode_study.h"

#include "engine/model/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr double most_points_with_boards = 100.0;

const Sensor &sensor_named(const Setup &setup, const std::string &name) {
  for (const Sensor &sensor : setup.start.sensors)
    if (name.empty() || sensor.name == name)
      return sensor;
  throw Error(ExitCode::usage, fmt::format("--sensor: expected the name of a sensor of {}, found \"{}\"",
                                           setup.file.string(), name));
}

// Columns and rows, the longer side at most `most`.
glm::uvec2 grid_of(const glm::uvec2 &resolution, std::uint32_t most) {
  const std::uint32_t longer = std::max(resolution.x, resolution.y);
  if (longer <= most)
    return resolution;
  const glm::dvec2 fitting = glm::round(glm::dvec2(resolution) * (static_cast<double>(most) / longer));
  return glm::max(glm::uvec2(fitting), glm::uvec2(1));
}

// The pixel in the middle of each cell of the grid, row * columns + column.
std::vector<std::uint32_t> pixels_of(const glm::uvec2 &grid, const glm::uvec2 &resolution) {
  const auto middle = [](std::uint64_t cell, std::uint64_t cells, std::uint64_t pixels) {
    return static_cast<std::uint32_t>((2 * cell + 1) * pixels / (2 * cells));
  };
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t row = 0; row < grid.y; ++row)
    for (std::uint32_t column = 0; column < grid.x; ++column)
      pixels.push_back(middle(row, grid.y, resolution.y) * resolution.x +
                       middle(column, grid.x, resolution.x));
  return pixels;
}

std::vector<StudiedDiode> diodes_of(const std::vector<Illuminator> &illuminators, const LitView &view) {
  std::vector<StudiedDiode> diodes;
  for (const Illuminator &illuminator : illuminators)
    for (std::size_t i = 0; i < illuminator.diodes.size(); ++i)
      diodes.push_back({illuminator.name, i, illuminator.diodes[i].position_m,
                        view.diodes[diodes.size()].diode.position_m});
  return diodes;
}

// Chosen among the points that light returns from. A few at rims of bodies and shadows may vary so much that
// they rule the mean over the image. So half of the choice is even, and half goes by how much theory lets a
// point vary. A point's weight is of how many it is one: each mean over all is the weighted mean of these.
void choose_points(const LinearTheory &theory, RandomBoards &random) {
  double lit = 0.0, squares_m2 = 0.0;
  for (std::size_t i = 0; i < theory.deviation_m.size(); ++i)
    if (!std::isnan(theory.deviation_m[i])) {
      lit += 1.0;
      squares_m2 += theory.varying_deviation_m[i] * theory.varying_deviation_m[i];
    }
  const bool is_few = lit <= most_points_with_boards;
  double sum = 0.0;
  for (std::size_t i = 0; i < theory.deviation_m.size(); ++i) {
    if (std::isnan(theory.deviation_m[i]))
      continue;
    const double varying_m = theory.varying_deviation_m[i],
                 by_theory = squares_m2 > 0.0 ? varying_m * varying_m / squares_m2 : 1.0 / lit,
                 share = is_few ? 1.0 : most_points_with_boards * (0.5 / lit + 0.5 * by_theory);
    // Where the sum of shares passes a half, one and a half and so on.
    const double times = std::floor(sum + share + 0.5) - std::floor(sum + 0.5);
    sum += share;
    if (times == 0.0)
      continue;
    random.points.push_back(i);
    random.weights.push_back(times / share);
  }
}

RandomBoards random_boards(const LitView &view, const LinearTheory &theory, const DiodeRequest &request,
                           const StudyProgress &progress) {
  RandomBoards random{.boards = request.boards, .seed = request.seed};
  choose_points(theory, random);
  LitView part = view;
  part.points.clear();
  for (std::size_t i = 0; i < random.points.size(); ++i) {
    part.points.push_back(view.points[random.points[i]]);
    part.points.back().weight = random.weights[i];
  }
  const LinearTheory here = linear_theory(part, request.tolerances);
  random.theory = here.board;
  random.theory_m = here.deviation_m;
  for (std::size_t kind = 0; kind <= kind_count; ++kind) {
    KindsOn on{};
    for (std::size_t i = 0; i < kind_count; ++i)
      on[i] = kind == kind_count || i == kind;
    const BoardChanges changes =
        board_changes(part, request.tolerances, on, request.boards, request.seed, [&](double fraction) {
          progress("random boards", (static_cast<double>(kind) + fraction) / (kind_count + 1));
        });
    random.found[kind] = board_statistics(changes);
    if (kind == kind_count)
      random.statistics = point_statistics(changes);
  }
  return random;
}

} // namespace

DiodeStudy study_diodes(const Setup &setup, const DiodeRequest &request, const StudyProgress &progress) {
  const Sensor &sensor = sensor_named(setup, request.sensor);
  DiodeStudy study{.sensor = sensor.name,
                   .modulation_hz = sensor.modulation_hz.front(),
                   .resolution = sensor.resolution,
                   .grid = grid_of(sensor.resolution, request.pixels),
                   .tolerances = request.tolerances};
  const std::vector<std::uint32_t> pixels = pixels_of(study.grid, study.resolution);
  const LitView view = lit_view(setup, sensor, pixels, study.cells,
                                [&](double fraction) { progress("what the pixels see", fraction); });
  for (const std::size_t cell : study.cells)
    study.pixels.emplace_back(pixels[cell] % sensor.resolution.x, pixels[cell] / sensor.resolution.x);
  for (const Illuminator &illuminator : setup.start.illuminators)
    study.illuminators.push_back(illuminator.name);
  study.diodes = diodes_of(setup.start.illuminators, view);
  study.theory =
      linear_theory(view, request.tolerances, [&](double fraction) { progress("linear theory", fraction); });
  if (study.theory.lit_points == 0)
    throw Error(ExitCode::input,
                fmt::format("{}: sensor {}: expected pixels that light returns to, found none among {} x {}",
                            setup.file.string(), sensor.name, study.grid.x, study.grid.y));
  study.random = random_boards(view, study.theory, request, progress);
  return study;
}

} // namespace pmdsim
