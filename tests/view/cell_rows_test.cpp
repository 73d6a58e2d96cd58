// The cells of a raster that an outline touches and those inside it, against places all over it.

#include "engine/view/cell_rows.h"

#include "tests/support/random_scenes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr glm::uvec2 raster_size{90, 20};

using Cells = std::set<std::pair<std::int64_t, std::int64_t>>; // row, column

template <typename Columns>
Cells cells_of(const OutlineCells &outline, const Columns &columns) {
  Cells cells;
  for (std::int64_t row = outline.rows().first; row <= outline.rows().last; ++row) {
    const CellSpan span = columns(row);
    for (std::int64_t column = span.first; column <= span.last; ++column)
      cells.emplace(row, column);
  }
  return cells;
}

Cells touched(const OutlineCells &outline) {
  return cells_of(outline, [&](std::int64_t row) { return outline.touched(row); });
}
Cells inside(const OutlineCells &outline) {
  return cells_of(outline, [&](std::int64_t row) { return outline.inside(row); });
}

bool is_on_raster(const glm::dvec2 &place) {
  return place.x >= 0 && place.y >= 0 && place.x < raster_size.x && place.y < raster_size.y;
}

double side(const glm::dvec2 &a, const glm::dvec2 &b, const glm::dvec2 &p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}
bool holds(const Outline &triangle, const glm::dvec2 &p) {
  const auto &[a, b, c, unused] = triangle.corners;
  const double ab = side(a, b, p), bc = side(b, c, p), ca = side(c, a, p);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

} // namespace

TEST_CASE("no place of an outline lies outside the cells that it touches, nor a corner of those inside it") {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    Outline triangle;
    const double spread = random.log_uniform(1, 100);
    const glm::dvec2 middle(random.uniform(-10, 100), random.uniform(-10, 30));
    for (int k = 0; k < 3; ++k)
      triangle.add(middle + spread * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1)));
    const OutlineCells cells(triangle, raster_size);
    const Cells all = touched(cells);
    for (int n = 0; n < 500; ++n) {
      const double u = std::sqrt(random.uniform(0, 1)), v = random.uniform(0, 1);
      const auto &[a, b, c, unused] = triangle.corners;
      const glm::dvec2 place = (1 - u) * a + u * (1 - v) * b + u * v * c;
      if (is_on_raster(place))
        REQUIRE(all.contains({static_cast<std::int64_t>(place.y), static_cast<std::int64_t>(place.x)}));
    }
    for (const auto &[row, column] : inside(cells))
      for (const int x : {0, 1})
        for (const int y : {0, 1})
          REQUIRE(holds(triangle, glm::dvec2(static_cast<double>(column + x), static_cast<double>(row + y))));
  }
}

TEST_CASE("the cells of a rectangle and of a line, by hand") {
  Outline rectangle;
  for (const glm::dvec2 corner : {glm::dvec2(2.5, 3.5), {6.5, 3.5}, {6.5, 5.5}, {2.5, 5.5}})
    rectangle.add(corner);
  const OutlineCells cells(rectangle, raster_size);
  CHECK(touched(cells).size() == 3 * 5);
  CHECK(inside(cells) == Cells{{4, 3}, {4, 4}, {4, 5}});
  Outline line;
  line.add({1.5, 1.5});
  line.add({3.5, 2.5});
  CHECK(touched(OutlineCells(line, raster_size)) == Cells{{1, 1}, {1, 2}, {2, 2}, {2, 3}});
}

TEST_CASE("an outline beside the raster touches none of its cells") {
  for (const glm::dvec2 far : {glm::dvec2(-1e12, 5), {1e12, 5}, {5, -1e12}, {5, 1e12}}) {
    Outline triangle;
    for (const glm::dvec2 corner : {glm::dvec2(0, 0), {1, 0}, {0, 1}})
      triangle.add(far + corner);
    CHECK(touched(OutlineCells(triangle, raster_size)).empty());
  }
}

TEST_CASE("cells of a set are numbered row by row") {
  CellSet set(raster_size);
  set.add(2, {60, 70});
  set.add(0, {5, 5});
  set.add(19, {89, 89});
  CHECK(set.number() == 13);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  set.for_each(2, {63, 65},
               [&](std::uint32_t number, std::uint32_t column) { found.emplace_back(number, column); });
  CHECK(found == std::vector<std::pair<std::uint32_t, std::uint32_t>>{{4, 63}, {5, 64}, {6, 65}});
  CHECK(set.has_any(19, {80, 89}));
  CHECK_FALSE(set.has_any(19, {80, 88}));
  CHECK_FALSE(set.has_any(2, {71, 60}));
}
