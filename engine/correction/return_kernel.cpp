// Eq. 5 to 7 of one point, in double, a vector of diodes at a time.

#include "engine/correction/return_loops.h"
#include "engine/model/wide_lanes.h"

#include <algorithm>
#include <cmath>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

inline Doubles of_all(double value) { return value - Doubles{}; }

inline Doubles nearest_whole(const Doubles &v) {
  constexpr double shift = 0x1.8p52;
  return (v + shift) - shift;
}

struct Complexes {
  Doubles re, im;
};

inline Complexes operator*(const Complexes &a, const Complexes &b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

// exp(j 2 pi turns), of up to 2^50 turns. Within an eighth of a turn by Taylor's series.
inline Complexes unit_phasor(const Doubles &turns) {
  const Doubles part = turns - nearest_whole(turns), quarter = nearest_whole(4.0 * part);
  const Doubles y = radians_per_turn * (part - 0.25 * quarter), u = y * y;
  constexpr double of_sine[] = {-1.0 / 1307674368000.0, 1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0,
                                -1.0 / 5040.0,          1.0 / 120.0,        -1.0 / 6.0,        1.0},
                   of_cosine[] = {1.0 / 20922789888000.0,
                                  -1.0 / 87178291200.0,
                                  1.0 / 479001600.0,
                                  -1.0 / 3628800.0,
                                  1.0 / 40320.0,
                                  -1.0 / 720.0,
                                  1.0 / 24.0,
                                  -0.5,
                                  1.0};
  Doubles s{}, c{};
  for (const double coefficient : of_sine)
    s = s * u + coefficient;
  for (const double coefficient : of_cosine)
    c = c * u + coefficient;
  s *= y;
  const Longs q = __builtin_convertvector(quarter, Longs), is_odd = (q & 1) != 0, is_turned = (q & 2) != 0;
  const Doubles re = is_odd ? -s : c, im = is_odd ? c : s;
  return {is_turned ? -re : re, is_turned ? -im : im};
}

// What a camera takes for the return of a path, and the same differentiated by its turns.
struct Demodulated {
  Complexes value, per_turn;
};

inline Demodulated sine(const Doubles &turns) {
  const Complexes e = unit_phasor(turns);
  return {e, {-radians_per_turn * e.im, radians_per_turn * e.re}};
}

inline Demodulated harmonics(const TapDemodulation &by, const Doubles &turns) {
  const Complexes e = unit_phasor(turns);
  Complexes power = e;
  Demodulated sum{};
  for (std::size_t h = 1; h < by.forward.size(); ++h, power = power * e) {
    const double same = by.forward[h] + by.backward[h], turned = by.forward[h] - by.backward[h];
    const double per_turn = radians_per_turn * static_cast<double>(h);
    sum.value.re += same * power.re;
    sum.value.im += turned * power.im;
    sum.per_turn.re -= per_turn * same * power.im;
    sum.per_turn.im += per_turn * turned * power.re;
  }
  return sum;
}

// The triangle wave, +1 at 0 and -1 at half a turn.
inline Demodulated square(const TapDemodulation &by, const Doubles &turns) {
  const auto taps = by.tap_cos.size();
  Demodulated sum{};
  for (std::size_t k = 0; k < taps; ++k) {
    const Doubles at = turns - static_cast<double>(k) / static_cast<double>(taps),
                  part = at - nearest_whole(at); // -1/2 to 1/2
    const Longs behind = part < 0.0;
    const Doubles value = 1.0 - 4.0 * (behind ? -part : part), per_turn = behind ? of_all(4.0) : of_all(-4.0);
    sum.value.re += by.tap_cos[k] * value;
    sum.value.im += by.tap_sin[k] * value;
    sum.per_turn.re += by.tap_cos[k] * per_turn;
    sum.per_turn.im += by.tap_sin[k] * per_turn;
  }
  return sum;
}

inline Demodulated demodulated(const TapDemodulation &by, const Doubles &turns) {
  switch (by.kind) {
  case TapDemodulation::Kind::harmonics:
    return harmonics(by, turns);
  case TapDemodulation::Kind::square:
    return square(by, turns);
  case TapDemodulation::Kind::sine:
    break;
  }
  return sine(turns);
}

// Where a number lies between ascending nodes: the last node that is not beyond it, and how far on it is.
struct Place {
  std::size_t node;
  double part;
};
Place place_among(const std::vector<double> &nodes, double at) {
  const auto beyond = static_cast<std::size_t>(
      std::distance(nodes.begin(), std::upper_bound(nodes.begin(), nodes.end(), at)));
  const std::size_t node = std::clamp<std::size_t>(beyond, 1, std::max<std::size_t>(nodes.size() - 1, 1)) - 1;
  return nodes.size() < 2 ? Place{0, 0.0} : Place{node, (at - nodes[node]) / (nodes[node + 1] - nodes[node])};
}

// As Diagram says: linear in both angles, 0 beyond its ends.
double diagram_at(const Diagram &diagram, double theta_rad, double phi_rad) {
  constexpr double rounding_rad = 1e-12; // of an angle: the last one belongs to the table
  const std::vector<double> &thetas = diagram.theta_rad, &phis = diagram.phi_rad;
  if (theta_rad < thetas.front() - rounding_rad || theta_rad > thetas.back() + rounding_rad)
    return 0.0;
  const Place theta = place_among(thetas, std::clamp(theta_rad, thetas.front(), thetas.back()));
  double turned_rad = phi_rad;
  while (turned_rad < phis.front())
    turned_rad += radians_per_turn;
  std::size_t from = phis.size() - 1, to = 0;
  double part = (turned_rad - phis.back()) / (phis.front() + radians_per_turn - phis.back());
  if (turned_rad < phis.back()) {
    const Place phi = place_among(phis, turned_rad);
    from = phi.node, to = phi.node + 1, part = phi.part;
  }
  const auto around = [&](std::size_t node) {
    const double *row = &diagram.relative[node * phis.size()];
    return row[from] + part * (row[to] - row[from]);
  };
  const double first = around(theta.node);
  return theta.part == 0.0 ? first : first + theta.part * (around(theta.node + 1) - first);
}

// A vector of a row's diodes and the way from them to the point.
struct ToPoint {
  Doubles x, y, z, length_m;
};

inline Doubles along_axis(const DiodeRow &row, std::size_t i, const ToPoint &way) {
  return (load<Doubles>(&row.axis_x[i]) * way.x + load<Doubles>(&row.axis_y[i]) * way.y +
          load<Doubles>(&row.axis_z[i]) * way.z) /
         way.length_m;
}

inline Doubles whole_power(Doubles x, std::uint32_t power) {
  Doubles result = of_all(1.0);
  for (; power > 0; power /= 2, x *= x)
    if (power % 2 == 1)
      result *= x;
  return result;
}

Doubles by_diagram(const DiodeRow &row, std::size_t i, const ToPoint &way) {
  Doubles relative{};
  for (int lane = 0; lane < double_lanes; ++lane) {
    const std::size_t k = i + static_cast<std::size_t>(lane);
    const glm::dvec3 axis(row.axis_x[k], row.axis_y[k], row.axis_z[k]),
        across(row.across_x[k], row.across_y[k], row.across_z[k]),
        to_point(way.x[lane], way.y[lane], way.z[lane]);
    const double on = glm::dot(axis, to_point);
    relative[lane] =
        diagram_at(*row.diagram, std::atan2(glm::length(to_point - on * axis), on),
                   std::atan2(glm::dot(glm::cross(axis, across), to_point), glm::dot(across, to_point)));
  }
  return relative;
}

inline Doubles radiated(const DiodeRow &row, std::size_t i, const ToPoint &way) {
  if (row.law == DiodeLaw::isotropic)
    return of_all(1.0);
  if (row.law == DiodeLaw::diagram)
    return by_diagram(row, i, way);
  const Doubles cosine = along_axis(row, i, way);
  const Longs in_front = cosine > 0.0;
  Doubles power{};
  if (row.law == DiodeLaw::whole_order)
    power = whole_power(cosine, static_cast<std::uint32_t>(row.order));
  else
    for (int lane = 0; lane < double_lanes; ++lane)
      power[lane] = std::pow(std::max(cosine[lane], 0.0), row.order);
  return in_front ? power : Doubles{};
}

struct Sums {
  Complexes z{}, per_m{}, per_normal[3]{};
};

template <bool with_normal>
void add_row(const ReturnWork &of, const DiodeRow &row, const PointOnRay &at, Sums &sums) {
  const glm::dvec3 point = at.range_m * at.ray;
  for (std::size_t i = 0; i < row.size(); i += double_lanes) {
    ToPoint way{point.x - load<Doubles>(&row.x[i]),
                point.y - load<Doubles>(&row.y[i]),
                point.z - load<Doubles>(&row.z[i]),
                {}};
    const Doubles square_m2 = way.x * way.x + way.y * way.y + way.z * way.z;
    way.length_m = root(square_m2);
    const Doubles cosine = -(at.normal.x * way.x + at.normal.y * way.y + at.normal.z * way.z) / way.length_m;
    const Longs lit = cosine > 0.0;
    const Doubles even = load<Doubles>(&row.intensity_w_sr[i]) * radiated(row, i, way) / square_m2;
    const Doubles weight = lit ? (of.lambert ? even * cosine : even) : Doubles{};
    const Doubles turns = (way.length_m + at.range_m) * of.turns_per_m + load<Doubles>(&row.phase_turns[i]);
    const Demodulated seen = demodulated(of.demodulation, turns);
    const Doubles turns_per_m =
        of.turns_per_m * (1.0 + (at.ray.x * way.x + at.ray.y * way.y + at.ray.z * way.z) / way.length_m);
    sums.z.re += weight * seen.value.re;
    sums.z.im += weight * seen.value.im;
    sums.per_m.re += weight * turns_per_m * seen.per_turn.re;
    sums.per_m.im += weight * turns_per_m * seen.per_turn.im;
    if constexpr (with_normal) {
      const Doubles per_cosine = lit ? -even / way.length_m : Doubles{};
      const Doubles along[3] = {way.x, way.y, way.z};
      for (int axis = 0; axis < 3; ++axis) {
        sums.per_normal[axis].re += per_cosine * along[axis] * seen.value.re;
        sums.per_normal[axis].im += per_cosine * along[axis] * seen.value.im;
      }
    }
  }
}

std::complex<double> total(const Complexes &lanes_of) {
  double re = 0.0, im = 0.0;
  for (int lane = 0; lane < double_lanes; ++lane) {
    re += lanes_of.re[lane];
    im += lanes_of.im[lane];
  }
  return {re, im};
}

void sum_return(const ReturnWork &of, const PointOnRay &at, bool with_normal, ModelReturn &sum) {
  Sums sums{};
  for (const DiodeRow &row : of.rows)
    with_normal ? add_row<true>(of, row, at, sums) : add_row<false>(of, row, at, sums);
  sum.z = total(sums.z);
  sum.per_m = total(sums.per_m);
  for (int axis = 0; axis < 3; ++axis)
    sum.per_normal[axis] = total(sums.per_normal[axis]);
}

} // namespace

extern const ReturnLoops return_loops{sum_return};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
