// Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET its name; see host/CMakeLists.txt. Loops
// over a tile become a few wide instructions each, with the sums in registers.
#include "host/bench/native/kernel_sums.h"

#include <cmath>

#define PMDSIM_TEXT_OF(name) #name
#define PMDSIM_TEXT(name) PMDSIM_TEXT_OF(name)

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr std::size_t tile = native_tile_points;

// The phases that follow from the moments of a tile's points.
void write_phases(const float (&moment)[native_moments][tile], float k, float *phase_rad) {
  for (std::size_t i = 0; i < tile; ++i)
    phase_rad[i] = std::atan2(k * moment[1][i] - k * k * k / 6.0f * moment[3][i],
                              moment[0][i] - k * k / 2.0f * moment[2][i]);
}

struct RangeAndWeight {
  float range_m, weight;
};

// GCC makes the root and the quotient of an estimate and a step of Newton's each. It makes a reciprocal root
// so up to 256 bits only; there that saves the quotient.
inline RangeAndWeight range_and_weight(float square_m2, float intensity_w_sr) {
#ifdef __AVX512F__
  return {std::sqrt(square_m2), intensity_w_sr / square_m2};
#else
  const float reciprocal = 1.0f / std::sqrt(square_m2);
  return {square_m2 * reciprocal, intensity_w_sr * reciprocal * reciprocal};
#endif
}

void find_moments(const NativeTile &points, const NativeDiode *diodes, std::size_t diode_count,
                  float (&moment)[native_moments][tile]) {
  float m0[tile] = {}, m1[tile] = {}, m2[tile] = {}, m3[tile] = {};
  for (std::size_t m = 0; m < diode_count; ++m) {
    const NativeDiode diode = diodes[m];
    for (std::size_t i = 0; i < tile; ++i) {
      const float x = points.x_m[i] - diode.x_m;
      const float y = points.y_m[i] - diode.y_m;
      const float z = points.z_m[i] - diode.z_m;
      const auto [range_m, weight] = range_and_weight(x * x + y * y + z * z, diode.intensity_w_sr);
      const float excess_m = range_m - points.range_m[i];
      float term = weight;
      m0[i] += term;
      term *= excess_m;
      m1[i] += term;
      term *= excess_m;
      m2[i] += term;
      term *= excess_m;
      m3[i] += term;
    }
  }
  for (std::size_t i = 0; i < tile; ++i)
    moment[0][i] = m0[i], moment[1][i] = m1[i], moment[2][i] = m2[i], moment[3][i] = m3[i];
}

void sum_by_moments(const NativeTile *tiles, std::size_t tile_count, const NativeDiode *diodes,
                    std::size_t diode_count, float wavenumber_per_m, float *phase_rad) {
  float moment[native_moments][tile];
  for (std::size_t t = 0; t < tile_count; ++t) {
    find_moments(tiles[t], diodes, diode_count, moment);
    write_phases(moment, wavenumber_per_m, phase_rad + t * tile);
  }
}

// factor[k][n] is the factor of u^n in (sqrt(1 + u) - 1)^k / (1 + u), so that
// w e^k = I |P|^(k - 2) sum_n factor[k][n] u^n.
template <std::size_t powers>
struct SeriesFactors {
  float factor[native_moments][powers] = {};

  constexpr SeriesFactors() {
    double root[powers] = {}, term[powers] = {}; // of sqrt(1 + u) - 1; of the row
    double binomial = 1.0;
    for (std::size_t n = 1; n < powers; ++n)
      root[n] = binomial *= (1.5 - static_cast<double>(n)) / static_cast<double>(n);
    for (std::size_t n = 0; n < powers; ++n)
      term[n] = n % 2 == 0 ? 1.0 : -1.0;
    for (auto &row : factor) {
      for (std::size_t n = 0; n < powers; ++n)
        row[n] = static_cast<float>(term[n]);
      for (std::size_t n = powers; n-- > 0;) {
        double product = 0.0;
        for (std::size_t i = 0; i <= n; ++i)
          product += term[i] * root[n - i];
        term[n] = product;
      }
    }
  }
};

// All diodes in one, each times its intensity.
NativeDiode sum_of(const NativeDiode *diodes, std::size_t diode_count) {
  NativeDiode sum{};
  for (const NativeDiode *diode = diodes; diode != diodes + diode_count; ++diode) {
    sum.x_m += diode->intensity_w_sr * diode->x_m;
    sum.y_m += diode->intensity_w_sr * diode->y_m;
    sum.z_m += diode->intensity_w_sr * diode->z_m;
    sum.square_m2 += diode->intensity_w_sr * diode->square_m2;
    sum.intensity_w_sr += diode->intensity_w_sr;
  }
  return sum;
}

// The sums of I u^n. Those of n = 0 and 1 follow from `all`.
template <std::size_t powers>
void find_power_sums(const NativeTile &points, const NativeDiode *diodes, std::size_t diode_count,
                     const NativeDiode &all, float (&sum)[powers][tile]) {
  float x[tile], y[tile], z[tile], reciprocal[tile]; // -2 P / |P|^2 and 1 / |P|^2
  float total[powers][tile] = {};
  for (std::size_t i = 0; i < tile; ++i) {
    reciprocal[i] = 1.0f / (points.range_m[i] * points.range_m[i]);
    x[i] = -2.0f * points.x_m[i] * reciprocal[i];
    y[i] = -2.0f * points.y_m[i] * reciprocal[i];
    z[i] = -2.0f * points.z_m[i] * reciprocal[i];
  }
  for (std::size_t m = 0; m < diode_count; ++m) {
    const NativeDiode diode = diodes[m];
    for (std::size_t i = 0; i < tile; ++i) {
      const float u =
          x[i] * diode.x_m + (y[i] * diode.y_m + (z[i] * diode.z_m + reciprocal[i] * diode.square_m2));
      float term = diode.intensity_w_sr * u;
#pragma GCC unroll 12
      for (std::size_t n = 2; n < powers; ++n) {
        total[n][i] += term * u;
        term *= u;
      }
    }
  }
  for (std::size_t i = 0; i < tile; ++i) {
    sum[0][i] = all.intensity_w_sr;
    sum[1][i] = x[i] * all.x_m + (y[i] * all.y_m + (z[i] * all.z_m + reciprocal[i] * all.square_m2));
    for (std::size_t n = 2; n < powers; ++n)
      sum[n][i] = total[n][i];
  }
}

template <std::size_t powers>
void find_moments_of_sums(const NativeTile &points, const float (&sum)[powers][tile],
                          float (&moment)[native_moments][tile]) {
  static constexpr SeriesFactors<powers> series;
  for (std::size_t i = 0; i < tile; ++i) {
    float scale = 1.0f / (points.range_m[i] * points.range_m[i]);
    for (std::size_t k = 0; k < native_moments; ++k) {
      float value = 0.0f;
      for (std::size_t n = powers; n-- > k;) // the smallest first
        value += series.factor[k][n] * sum[n][i];
      moment[k][i] = scale * value;
      scale *= points.range_m[i];
    }
  }
}

template <std::size_t powers>
void sum_by_series(const NativeTile *tiles, std::size_t tile_count, const NativeDiode *diodes,
                   std::size_t diode_count, float wavenumber_per_m, float *phase_rad) {
  const NativeDiode all = sum_of(diodes, diode_count);
  float sum[powers][tile], moment[native_moments][tile];
  for (std::size_t t = 0; t < tile_count; ++t) {
    find_power_sums<powers>(tiles[t], diodes, diode_count, all, sum);
    find_moments_of_sums<powers>(tiles[t], sum, moment);
    write_phases(moment, wavenumber_per_m, phase_rad + t * tile);
  }
}

} // namespace

extern const NativeSums sums;
const NativeSums sums{
    PMDSIM_TEXT(PMDSIM_INSTRUCTION_SET),
    sum_by_moments,
    {{4, sum_by_series<4>}, {6, sum_by_series<6>}, {8, sum_by_series<8>}, {12, sum_by_series<12>}}};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
