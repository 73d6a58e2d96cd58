#include "engine/tolerance/board_errors.h"

#include "shaders/shared/philox.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// The random numbers of a diode on a board, made where they are asked for.
class Chances {
public:
  Chances(std::uint64_t seed, std::uint32_t board, std::uint32_t diode)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}, board_(board),
        diode_(diode) {}

  // Of variance 1, or from -1 to 1: the one of a fault.
  double error(ErrorLaw law, std::size_t fault) {
    if (law == ErrorLaw::uniform)
      return 2.0 * share(fault) - 1.0;
    // Two of a pair, by Box and Muller.
    const double radius = std::sqrt(-2.0 * std::log(share(fault & ~std::size_t{1}))),
                 angle_rad = radians_per_turn * share(fault | 1);
    return radius * (fault % 2 == 0 ? std::cos(angle_rad) : std::sin(angle_rad));
  }
  bool is_dead(double chance) { return share(4 * draws - 1) < chance; }

private:
  static constexpr std::uint32_t draws = 3; // of four words: the last word's is what is dead

  // From 0 to 1, neither included.
  double share(std::size_t number) {
    const std::size_t draw = number / 4;
    if (!is_drawn_[draw]) {
      const shader::uvec4 words = shader::philox({board_, diode_, static_cast<std::uint32_t>(draw), 0}, key_);
      words_[draw] = {words.x, words.y, words.z, words.w};
      is_drawn_[draw] = true;
    }
    return (words_[draw][number % 4] + 0.5) * 0x1p-32;
  }

  shader::uvec2 key_;
  std::uint32_t board_, diode_;
  std::array<bool, draws> is_drawn_{};
  std::array<std::array<std::uint32_t, 4>, draws> words_{};
};

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
  Chances chances(seed, board, number);
  const auto error = [&](Fault fault) {
    const Kind kind = kind_of(fault);
    return on[static_cast<std::size_t>(kind)]
               ? tolerances.of(kind) * chances.error(tolerances.law, static_cast<std::size_t>(fault))
               : 0.0;
  };
  TolerancedDiode diode = nominal;
  diode.diode.position_m +=
      nominal.illuminator_axes * glm::dvec3(error(Fault::x), error(Fault::y), error(Fault::z));
  tilt(diode.diode, glm::cross(nominal.diode.axis, error(Fault::axis_x) * nominal.towards_x +
                                                       error(Fault::axis_y) * nominal.towards_y));
  const bool is_dead = on[static_cast<std::size_t>(Kind::dead)] && chances.is_dead(tolerances.dead);
  diode.diode.intensity_w_sr *= is_dead ? 0.0 : std::max(0.0, 1.0 + error(Fault::intensity));
  diode.phase_turns += error(Fault::phase) / radians_per_turn;
  return diode;
}

} // namespace pmdsim
