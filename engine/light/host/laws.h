#pragma once
// Radiation laws, J of the paper's eq. 5, for a vector of samples and a source at a time. Each is made for a
// vector and a batch; `x` and `y` lead from the source to the samples across the batch's axis, m.

#include "engine/light/host/law_sums.h"
#include "engine/model/elementary_lanes.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float tiny = 1e-30f; // which has a root, and an inverse one

// The arctangent of s over s, by s^2, up to so many degrees, to a relative error of 6e-8.
struct Within16 {
  static constexpr float largest = 0.3f;
  static Floats arctangent_over(const Floats &v) {
    return 0.99999994f + v * (-0.3333156626f + v * (0.1990061338f + v * -0.1246669644f));
  }
};
struct Within30 {
  static constexpr float largest = 0.58f;
  static Floats arctangent_over(const Floats &v) {
    return 1.0f +
           v * (-0.3333280259f +
                v * (0.1998108525f + v * (-0.1403484958f + v * (0.09551853252f + v * -0.04211287692f))));
  }
};
struct Within45 {
  static constexpr float largest = 1.0f;
  static Floats arctangent_over(const Floats &v) {
    const Floats high =
        0.106408912f +
        v * (-0.0750422082f + v * (0.04269082107f + v * (-0.0160682895f + v * 0.002849824162f)));
    return 1.0f + v * (-0.3333307323f + v * (0.1999261732f + v * (-0.1420363099f + v * high)));
  }
};

// A place on an even grid: the step before it, and how far beyond.
struct Cell {
  Ints at;
  Floats beyond;
};
inline Cell cell_of(const Floats &place) {
  const Ints at = __builtin_convertvector(place, Ints);
  return {at, place - __builtin_convertvector(at, Floats)};
}

// From a stretch of a table that is kept in registers: all samples of a vector see the sources of a batch
// under nearly one angle.
template <class Angles>
class NearAngles {
public:
  static constexpr std::int32_t width = 2 * lanes;

  NearAngles(const LawTable &table, std::int32_t first, const Floats &inverse_along)
      : inverse_along2_(inverse_along * inverse_along), steps_per_rad_(table.steps_per_rad),
        first_(table.first_step + static_cast<float>(first)) {
    for (int half = 0; half < 2; ++half, first += lanes) {
      values_[half] = load<Floats>(table.values + first);
      rises_[half] = load<Floats>(table.rises + first);
    }
  }

  Floats operator()(const Floats &x, const Floats &y) const {
    const Floats tangent2 = (x * x + y * y) * inverse_along2_ + tiny;
    const Floats steps = steps_per_rad_ * root(tangent2) * Angles::arctangent_over(tangent2);
    const Cell cell = cell_of(steps - first_);
    return picked(values_, cell.at) + cell.beyond * picked(rises_, cell.at);
  }

private:
  Floats values_[2], rises_[2], inverse_along2_;
  float steps_per_rad_, first_;
};

// The angle of (along, across) to the axis, rad, across > 0: twice the arctangent of its half within 45
// degrees.
inline Floats angle_to_axis(const Floats &along, const Floats &across) {
  const Floats forward = absolute(along), longer = larger(forward, across);
  const Floats t = smaller(forward, across) * inverse(root(along * along + across * across) + longer);
  const Floats u = t * t;
  const Floats near =
      t *
      (1.999999963f + u * (-0.6666557154f + u * (0.3994816483f + u * (-0.2769698042f + u * 0.1595258361f))));
  const Floats forwards = across > forward ? pi / 2.0f - near : near;
  return along < 0.0f ? pi - forwards : forwards;
}

// From the table as it lies in memory, at any angle.
class AnyAngle {
public:
  AnyAngle(const LawTable &table, const Floats &along) : table_(table), along_(along) {}

  Floats operator()(const Floats &x, const Floats &y) const {
    const Floats across = root(larger(x * x + y * y, all(tiny)));
    const Floats steps = angle_to_axis(along_, across) * table_.steps_per_rad - table_.first_step;
    // Negative steps, which would be rounded up, are all alike.
    const Floats place = smaller(larger(steps, all(-1.0f)), all(static_cast<float>(table_.steps + 1))) + 1.0f;
    const Cell cell = cell_of(place);
    return gathered(table_.values - 1, cell.at) + cell.beyond * gathered(table_.rises - 1, cell.at);
  }

private:
  const LawTable &table_;
  Floats along_;
};

// The angle of (x, y) about the axis, 0 to 2 pi, by the arcsine of its distance from the nearest axis.
inline Floats angle_about_axis(const Floats &x, const Floats &y, const Floats &inverse_length) {
  const Floats right = absolute(x), up = absolute(y);
  const Floats s = smaller(right, up) * inverse_length, v = s * s;
  const Floats high = 0.01522351490f + v * (0.0800082102f + v * (-0.09664219584f + v * 0.1134481206f));
  const Floats octant =
      s * (1.0f + v * (0.1666702032f + v * (0.07485974312f + v * (0.04674152127f + v * high))));
  const Floats quadrant = up > right ? pi / 2.0f - octant : octant;
  const Floats half = x < 0.0f ? pi - quadrant : quadrant;
  return y < 0.0f ? 2.0f * pi - half : half;
}

// The angle to the axis by the distance from it and that along it: at any angle, or within 45 degrees.
class ToAxis {
public:
  explicit ToAxis(const Floats &along) : along_(along) {}
  Floats operator()(const Floats &across) const { return angle_to_axis(along_, across); }

private:
  Floats along_;
};
class NearAxis {
public:
  explicit NearAxis(const Floats &along) : inverse_along_(1.0f / along) {}
  Floats operator()(const Floats &across) const {
    const Floats tangent = across * inverse_along_;
    return tangent * Within45::arctangent_over(tangent * tangent);
  }

private:
  Floats inverse_along_;
};

// A diagram that is not the same for all phi.
template <class Theta>
class AroundAxis {
public:
  AroundAxis(const LawTable &table, const Floats &along)
      : table_(table), theta_(along), phi_steps_per_rad_(static_cast<float>(table.phi_steps) / (2.0f * pi)) {}

  Floats operator()(const Floats &x, const Floats &y) const {
    const Floats square = larger(x * x + y * y, all(tiny)), inverse_across = inverse_root(square);
    const Floats theta = theta_(square * inverse_across) * table_.steps_per_rad - table_.first_step;
    const Floats phi = angle_about_axis(x, y, inverse_across) * phi_steps_per_rad_;
    const auto last_theta = static_cast<float>(table_.steps), last_phi = static_cast<float>(table_.phi_steps);
    const Cell row = cell_of(smaller(phi, all(last_phi)));
    const Cell column = cell_of(smaller(larger(theta, all(0.0f)), all(last_theta)));
    const Floats4 corner = gathered4(table_.cells, 4 * (row.at * (table_.steps + 1) + column.at));
    const Floats rise = corner.of[1] + row.beyond * corner.of[3];
    const Floats j = corner.of[0] + row.beyond * corner.of[2];
    const Ints inside = (theta >= 0.0f) & (theta <= last_theta);
    return inside != 0 ? j + column.beyond * rise : all(0.0f);
  }

private:
  const LawTable &table_;
  Theta theta_;
  float phi_steps_per_rad_;
};

// J = cos^n, or with r^n the power of lengths, which all sources of a batch share.
struct SharedByAll {
  Floats operator()(const Floats &, const Floats &) const { return all(1.0f); }
};
class WholePower {
public:
  WholePower(std::uint32_t power, const Floats &along) : power_(power), along_(along) {}

  Floats operator()(const Floats &x, const Floats &y) const {
    const Floats cosine = larger(along_, all(0.0f)) * inverse_root(x * x + y * y + along_ * along_);
    return whole_power(cosine, power_);
  }

private:
  std::uint32_t power_;
  Floats along_;
};

// As real_power of shaders/light/radiation_laws.glsl.
class RealPower {
public:
  RealPower(float power, const Floats &along) : half_power_(0.5f * power), along_(along) {}

  Floats operator()(const Floats &x, const Floats &y) const {
    const Floats along2 = along_ * along_, across2 = x * x + y * y;
    const Floats inverse_r2 = inverse(along2 + across2), sine2 = smaller(across2 * inverse_r2, all(1.0f));
    const Floats cosine2 = sine2 < 0.5f ? 1.0f - sine2 : along2 * inverse_r2;
    const Floats limited = smaller(larger(cosine2, all(1e-37f)), all(1.0f));
    const Floats j = exp_of(half_power_ * log_of(limited, sine2));
    return along_ > 0.0f ? j : all(0.0f);
  }

private:
  float half_power_;
  Floats along_;
};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
