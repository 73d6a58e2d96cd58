#include "host/tolerance/diode_study.h"

#include "engine/model/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::size_t most_points_with_boards = 100;

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

// Evenly chosen among the points that light returns from.
std::vector<std::size_t> points_for_boards(const LinearTheory &theory) {
  std::vector<std::size_t> lit, chosen;
  for (std::size_t i = 0; i < theory.deviation_m.size(); ++i)
    if (!std::isnan(theory.deviation_m[i]))
      lit.push_back(i);
  const std::size_t count = std::min(lit.size(), most_points_with_boards);
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(lit[(2 * i + 1) * lit.size() / (2 * count)]);
  return chosen;
}

RandomBoards random_boards(const LitView &view, const LinearTheory &theory, const DiodeRequest &request,
                           const StudyProgress &progress) {
  RandomBoards random{.boards = request.boards, .seed = request.seed, .points = points_for_boards(theory)};
  LitView part = view;
  part.points.clear();
  for (const std::size_t point : random.points)
    part.points.push_back(view.points[point]);
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
