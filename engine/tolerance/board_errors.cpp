#include "engine/tolerance/board_errors.h"

#include "shaders/shared/philox.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// Of variance 1, or from -1 to 1: those of the slopes in their order, then one from 0 to 1.
struct Chances {
  std::array<double, slope_count> error;
  double share;
};

constexpr double of_word = 0x1p-32;

double share_of(std::uint32_t word) { return (word + 0.5) * of_word; }

Chances chances(ErrorLaw law, std::uint64_t seed, std::uint32_t board, std::uint32_t diode) {
  constexpr std::uint32_t draws = 3;
  std::array<double, 4 * draws> shares;
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    const shader::uvec4 words = shader::philox(
        {board, diode, draw, 0}, {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
    const std::array of{words.x, words.y, words.z, words.w};
    std::ranges::transform(of, shares.begin() + 4 * draw, share_of);
  }
  Chances result{};
  for (std::size_t i = 0; i < slope_count; ++i) {
    // Two of a pair, by Box and Muller.
    const double radius = std::sqrt(-2.0 * std::log(shares[i & ~std::size_t{1}])),
                 angle_rad = radians_per_turn * shares[i | 1];
    const double normal = radius * (i % 2 == 0 ? std::cos(angle_rad) : std::sin(angle_rad));
    result.error[i] = law == ErrorLaw::uniform ? 2.0 * shares[i] - 1.0 : normal;
  }
  result.share = shares.back();
  return result;
}

// Turns the axis, and what is at right angles to it, by so much.
void tilt(Diode &diode, const glm::dvec3 &rotation_rad) {
  const double angle_rad = glm::length(rotation_rad);
  if (angle_rad == 0.0)
    return;
  const glm::dvec3 about = rotation_rad / angle_rad;
  const auto turned = [&](const glm::dvec3 &v) {
    return v * std::cos(angle_rad) + glm::cross(about, v) * std::sin(angle_rad) +
           about * glm::dot(about, v) * (1.0 - std::cos(angle_rad));
  };
  diode.axis = turned(diode.axis);
  diode.across = turned(diode.across);
}

} // namespace

TolerancedDiode on_board(const TolerancedDiode &nominal, const Tolerances &tolerances, const KindsOn &on,
                         std::uint64_t seed, std::uint32_t board, std::uint32_t number) {
  const Chances chance = chances(tolerances.law, seed, board, number);
  const auto error = [&](Fault fault) {
    const Kind kind = kind_of(fault);
    return on[static_cast<std::size_t>(kind)]
               ? tolerances.of(kind) * chance.error[static_cast<std::size_t>(fault)]
               : 0.0;
  };
  TolerancedDiode diode = nominal;
  diode.diode.position_m +=
      nominal.illuminator_axes * glm::dvec3(error(Fault::x), error(Fault::y), error(Fault::z));
  tilt(diode.diode, glm::cross(nominal.diode.axis, error(Fault::axis_x) * nominal.towards_x +
                                                       error(Fault::axis_y) * nominal.towards_y));
  const bool is_dead = on[static_cast<std::size_t>(Kind::dead)] && chance.share < tolerances.dead;
  diode.diode.intensity_w_sr *= is_dead ? 0.0 : std::max(0.0, 1.0 + error(Fault::intensity));
  diode.phase_turns += error(Fault::phase) / radians_per_turn;
  return diode;
}

} // namespace pmdsim
