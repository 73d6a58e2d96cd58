// A measured diagram on its even grid is the diagram itself wherever a grid can meet its angles.

#include "engine/light/diagram_tables.h"
#include "engine/light/rounding_units.h"
#include "tests/support/units.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double turn_rad = full_turn_rad;

std::shared_ptr<const Diagram> diagram_of(const std::vector<double> &theta_deg,
                                          const std::vector<double> &phi_deg,
                                          const std::vector<double> &relative) {
  Diagram diagram;
  for (const double angle_deg : theta_deg)
    diagram.theta_rad.push_back(angle_deg * degree);
  for (const double angle_deg : phi_deg)
    diagram.phi_rad.push_back(angle_deg * degree);
  diagram.relative = relative;
  return std::make_shared<const Diagram>(diagram);
}

// Some number for each angle that has no pattern to it.
std::vector<double> values_for(std::size_t count) {
  std::mt19937 random(7);
  std::vector<double> values(count);
  std::ranges::generate(values, [&] { return static_cast<double>(random()) / 4294967296.0; });
  return values;
}

std::vector<double> every(double step_deg, double last_deg) {
  std::vector<double> angles;
  for (int i = 0; i * step_deg <= last_deg; ++i)
    angles.push_back(i * step_deg);
  return angles;
}

// By the book: linear in theta of what is linear in phi.
double linear(const Diagram &diagram, double theta_rad, double phi_rad) {
  const auto &[thetas, phis, values] = diagram;
  if (theta_rad < thetas.front() || theta_rad > thetas.back())
    return 0.0;
  std::size_t row = 0, column = 0;
  while (row + 2 < thetas.size() && thetas[row + 1] < theta_rad)
    ++row;
  const double past_first = std::fmod(phi_rad - phis.front() + turn_rad, turn_rad);
  while (column + 1 < phis.size() && phis[column + 1] - phis.front() < past_first)
    ++column;
  const std::size_t next = (column + 1) % phis.size();
  const double width = phis.size() > 1 ? std::fmod(phis[next] - phis[column] + turn_rad, turn_rad) : 1.0;
  const double v = (past_first - phis[column] + phis.front()) / width;
  const double u = (theta_rad - thetas[row]) / (thetas[row + 1] - thetas[row]);
  const auto at = [&](std::size_t i, std::size_t k) { return values[i * phis.size() + k]; };
  const auto between = [&](std::size_t i) {
    return phis.size() > 1 ? (1 - v) * at(i, column) + v * at(i, next) : at(i, 0);
  };
  return (1 - u) * between(row) + u * between(row + 1);
}

// The table's value at a fraction of places behind `first`.
double interpolated(const DiagramTables &tables, double first, double place) {
  const glm::dvec2 pair = tables.values().at(static_cast<std::size_t>(first + std::floor(place)));
  return std::lerp(pair.x, pair.y, place - std::floor(place));
}

// As the shader reads it, but in double.
double from_table(const DiagramTables &tables, const DiagramGrid &grid, double theta_rad, double phi_rad) {
  const double u = (theta_rad - grid.first_theta_rad) * grid.theta_steps_per_rad;
  if (!(u >= 0 && u <= grid.theta_steps))
    return 0.0;
  if (grid.row_length == 0)
    return interpolated(tables, grid.first_value, u);
  const double past_first = std::fmod(phi_rad - grid.first_phi_rad + turn_rad, turn_rad);
  const double of_phi = grid.first_value + grid.theta_steps + 1.0, rows = of_phi + grid.phi_steps + 1.0;
  const double column = interpolated(tables, grid.first_value, u);
  const double row = interpolated(tables, of_phi, past_first / turn_rad * grid.phi_steps);
  const double upper = rows + std::floor(row) * grid.row_length;
  return std::lerp(interpolated(tables, upper, column), interpolated(tables, upper + grid.row_length, column),
                   row - std::floor(row));
}

// Over random directions, within the diagram's thetas.
double largest_difference(const Diagram &diagram, const DiagramTables &tables, const DiagramGrid &grid) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(1e-6, 1.0 - 1e-6);
  double largest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const double theta_rad = std::lerp(diagram.theta_rad.front(), diagram.theta_rad.back(), part(random));
    const double phi_rad = turn_rad * part(random);
    largest = std::max(largest, std::abs(from_table(tables, grid, theta_rad, phi_rad) -
                                         linear(diagram, theta_rad, phi_rad)));
  }
  return largest;
}

} // namespace

TEST_CASE("what a diagram may be off by is a direction's rounding and what the even grid misses") {
  DiagramTables tables;
  // 1 per degree.
  const auto even = diagram_of({0, 1, 2}, {0}, {0, 1, 2});
  const DiagramGrid grid = tables.grid_of(even);
  CHECK(grid.error == Approx(0.0).margin(1e-12));
  CHECK(diagram_error(*even, grid, 0.1) ==
        Approx(grid.error + 0x1p-24 * theta_error_u(0.1, 2 * degree) / degree).epsilon(1e-6));
  // The grid bends at 2, the diagram 5e-5 of a step later.
  const auto off = diagram_of({0, 1, 2.00005, 3}, {0}, {0, 0, 0, 1});
  CHECK(tables.grid_of(off).theta_steps == 3);
  CHECK(tables.grid_of(off).error == Approx(5e-5).epsilon(1e-3));
  // Twice the slope in phi over the sine.
  const auto around = diagram_of({0, 90}, {0, 90}, {0, 0, 0, 1});
  const DiagramGrid of_both = tables.grid_of(around);
  const double of_theta = theta_error_u(0.0, 90 * degree) / (90 * degree);
  const double of_phi = 2 * phi_error_u(0.0) / (90 * degree);
  CHECK(diagram_error(*around, of_both, 0.0) ==
        Approx(of_both.error + 0x1p-24 * (of_theta + of_phi)).epsilon(1e-6));
}

TEST_CASE("a grid's step divides all angles of a diagram, so that it is the diagram") {
  DiagramTables tables;
  const auto uneven = diagram_of({0, 2.5, 10, 12.75, 90}, {0}, values_for(5));
  const DiagramGrid grid = tables.grid_of(uneven);
  CHECK(grid.theta_steps == 360); // 0.25 degrees
  CHECK(grid.phi_steps == 0);
  CHECK(largest_difference(*uneven, tables, grid) < 1e-7);
}

TEST_CASE("a diagram that begins off the axis has no light on it") {
  DiagramTables tables;
  const auto ring = diagram_of({10, 20, 40}, {0}, {1, 0.5, 0.25});
  const DiagramGrid grid = tables.grid_of(ring);
  CHECK(grid.theta_steps == 3);
  CHECK(largest_difference(*ring, tables, grid) < 1e-7);
  CHECK(from_table(tables, grid, 9.99 * degree, 0) == 0.0);
  CHECK(from_table(tables, grid, 40.01 * degree, 0) == 0.0);
}

TEST_CASE("phi goes around, wherever it begins and however uneven it is") {
  DiagramTables tables;
  const auto thetas = every(15, 90);
  const std::vector<std::pair<std::vector<double>, std::uint32_t>> phis_and_steps{
      {{0, 90, 180, 270}, 4}, {{30, 75, 300}, 8}, {every(22.5, 359), 16}};
  for (const auto &[phi_deg, steps] : phis_and_steps) {
    const auto diagram = diagram_of(thetas, phi_deg, values_for(thetas.size() * phi_deg.size()));
    const DiagramGrid grid = tables.grid_of(diagram);
    CHECK(grid.phi_steps == steps);
    CHECK(largest_difference(*diagram, tables, grid) < 1e-6);
  }
}

TEST_CASE("straight behind the diode is within a diagram of all angles") {
  DiagramTables tables;
  const auto all_around = diagram_of({0, 90, 180}, {0, 120}, {1, 1, 0.5, 0.6, 0.2, 0.3});
  const DiagramGrid grid = tables.grid_of(all_around);
  CHECK(largest_difference(*all_around, tables, grid) < 1e-6);
  CHECK(from_table(tables, grid, std::numbers::pi + 3e-7, 0) == Approx(0.2));
}

TEST_CASE("a single angle has light nowhere beside it") {
  DiagramTables tables;
  const DiagramGrid grid = tables.grid_of(diagram_of({0}, {0}, {1}));
  CHECK(from_table(tables, grid, 0.0, 0.0) == 1.0);
  CHECK(from_table(tables, grid, 1e-6, 0.0) == 0.0);
}

TEST_CASE("angles that a file has rounded are met by even steps") {
  DiagramTables tables;
  std::vector<double> theta_deg;
  for (int i = 0; i <= 55; ++i) // 90 / 55 degrees, to four digits
    theta_deg.push_back(std::round(i * 90.0 / 55.0 * 1e4) / 1e4);
  const auto rounded = diagram_of(theta_deg, {0}, values_for(theta_deg.size()));
  const DiagramGrid grid = tables.grid_of(rounded);
  CHECK(grid.theta_steps == 55);
  const double difference = largest_difference(*rounded, tables, grid);
  CHECK(difference < 2e-4); // 1e-4 of the bends, which are 2 at most
  CHECK(difference > 1e-6);
  CHECK(difference <= grid.error);
}

TEST_CASE("angles that no grid meets take the finest, which is off by a quarter step of their bends") {
  DiagramTables tables;
  std::vector<double> theta_deg{0};
  while (theta_deg.back() < 89)
    theta_deg.push_back(theta_deg.back() + 1 + 0.1 * std::sin(theta_deg.back()));
  const auto odd = diagram_of(theta_deg, {0}, values_for(theta_deg.size()));
  const DiagramGrid grid = tables.grid_of(odd);
  CHECK(grid.theta_steps == 1u << 22);
  const double steepest = 2.0 / (0.9 * degree); // values are 0 to 1: the slope changes by twice that at most
  CHECK(largest_difference(*odd, tables, grid) < 0.25 * steepest * 90 * degree / (1u << 22) + 1e-7);
  CHECK(largest_difference(*odd, tables, grid) <= grid.error);
}

TEST_CASE("angles that no grid meets in either direction are met by the diagram's own") {
  DiagramTables tables;
  const std::vector<double> theta_deg{0, 4.37, 9.71, 15.02, 20.66, 24.9, 30.15, 34.78, 45.3, 61.2, 90};
  const std::vector<double> phi_deg{0, 14.71, 30.42, 44.93, 61.07, 118.2, 180.6, 241.1, 299.9};
  const auto odd = diagram_of(theta_deg, phi_deg, values_for(theta_deg.size() * phi_deg.size()));
  const DiagramGrid grid = tables.grid_of(odd);
  CHECK(grid.row_length == theta_deg.size());
  CHECK(largest_difference(*odd, tables, grid) < 1e-5);
}

TEST_CASE("diodes with the same diagram share its values") {
  DiagramTables tables;
  const auto one = diagram_of({0, 45, 90}, {0}, {1, 0.5, 0}), other = diagram_of({0, 90}, {0}, {1, 0});
  CHECK(tables.grid_of(one).first_value == 0);
  CHECK(tables.grid_of(other).first_value == 3);
  CHECK(tables.grid_of(one).first_value == 0);
  CHECK(tables.values().size() == 5);
}

TEST_CASE("a diagram in double is linear between its angles, around the turn too") {
  Diagram diagram;
  diagram.theta_rad = {0.0, 0.5, 1.0};
  diagram.phi_rad = {1.0, 3.0, 5.0};
  diagram.relative = {1.0, 1.0, 1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.0};
  CHECK(relative_at(diagram, 0.5, 1.0) == Approx(0.8));
  CHECK(relative_at(diagram, 0.25, 3.0) == Approx(0.8));
  CHECK(relative_at(diagram, 0.5, 2.0) == Approx(0.7));
  const double from_last_to_first = 2.0 * std::numbers::pi - 4.0;
  for (const double beyond_last_rad : {0.3, 1.8}) { // before and behind the end of the turn
    double phi_rad = 5.0 + beyond_last_rad;
    phi_rad -= phi_rad < 2.0 * std::numbers::pi ? 0.0 : 2.0 * std::numbers::pi;
    CHECK(relative_at(diagram, 0.5, phi_rad) == Approx(0.4 + 0.4 * beyond_last_rad / from_last_to_first));
  }
  CHECK(relative_at(diagram, 1.0, 4.0) == Approx(0.05));
  CHECK(relative_at(diagram, 1.01, 4.0) == 0.0);
}
