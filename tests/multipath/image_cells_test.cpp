// The parts of a frame between whose corners light is interpolated.

#include "engine/multipath/image_cells.h"
#include "tests/support/random_rooms.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Measurement seen_frame(const Room &room) {
  SimulatorOptions options;
  options.keep_sample_ids = true;
  Simulator simulator = make_simulator(options);
  simulator.prepare(room.scene, room.sensor, {room.light}, Backscatter::lambert);
  return simulator.measure();
}

// Cut anywhere.
std::vector<ImageCell> cut(std::vector<ImageCell> cells, Random &random) {
  for (int round = 0; round < 3; ++round) {
    std::vector<ImageCell> next;
    for (const ImageCell &cell : cells) {
      const bool by_row = cell.has_middle_row() && (!cell.has_middle_column() || random.flip());
      if (!cell.is_divisible() || random.flip())
        next.push_back(cell);
      else
        for (const ImageCell &half : by_row ? halves_by_row(cell) : halves_by_column(cell))
          next.push_back(half);
    }
    cells = std::move(next);
  }
  return cells;
}

} // namespace

TEST_CASE("each sample that sees a surface is the own of one cell, which sees one surface") {
  const auto samples = GENERATE(1u, 3u);
  Room room = random_room(5);
  room.sensor.samples = samples;
  const Measurement frame = seen_frame(room);
  const SeenPlaces seen(room.scene, room.sensor, frame, glm::dvec3(0.0));
  Random random(3);
  std::vector<int> owners(std::size_t{seen.columns()} * seen.rows());
  const glm::uvec2 end(seen.columns() - 1, seen.rows() - 1);
  constexpr std::uint32_t block = 8;
  for (std::uint32_t row = 0; row < end.y; row += block)
    for (std::uint32_t column = 0; column < end.x; column += block) {
      const glm::uvec2 low(column, row), high = glm::min(low + block, end);
      for (const ImageCell &cell : cut(cells_of(seen, low, high), random)) {
        const std::uint32_t object = room.scene.object_of(seen.shape(cell.middle()));
        for_each_own(cell, [&](const glm::uvec2 &sample) {
          ++owners[sample.y * seen.columns() + sample.x];
          CHECK(room.scene.object_of(seen.shape(sample)) == object);
          if (sample.x > cell.runs[sample.y - cell.row].low)
            CHECK(seen.are_continuous(sample - glm::uvec2(1, 0), sample));
        });
      }
    }
  std::size_t wrong = 0, surfaces = 0;
  for (std::uint32_t row = 0; row <= end.y; ++row)
    for (std::uint32_t column = 0; column <= end.x; ++column) {
      const bool sees = seen.shape({column, row}) != no_id;
      surfaces += sees ? 1u : 0u;
      wrong += owners[row * seen.columns() + column] != (sees ? 1 : 0) ? 1u : 0u;
    }
  CHECK(surfaces > owners.size() / 2);
  CHECK(wrong == 0);
}

TEST_CASE("a cell's corners count 1 together, and alone at themselves") {
  const ImageCell cell{4, {{2, 9}, {3, 9}, {4, 8}, {5, 7}}, true, true};
  for (std::uint32_t row = 4; row <= 7; ++row)
    for (std::uint32_t column = cell.runs[row - 4].low; column <= cell.runs[row - 4].high; ++column) {
      const auto weights = cell.weights({column, row});
      CHECK(weights[0] + weights[1] + weights[2] + weights[3] == Approx(1.0f));
    }
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(cell.weights(cell.corners()[i])[i] == 1.0f);
}
