#pragma once
// The inner loops of the native kernel. Their source is compiled once for each instruction set, so that a
// program runs on any processor of its kind and is as fast as each of them allows.

#include <cstddef>

namespace pmdsim {

// Points that are summed together; more of them leave no registers for the sums.
inline constexpr std::size_t native_tile_points = 32;
// The moments of the excess e: sum w e^k, k = 0 ... 3.
inline constexpr std::size_t native_moments = 4;

// Relative to the light's reference point, camera axes. Plain arrays: an inline function that is instantiated
// for one instruction set must not be the one that the linker keeps for all.
struct NativeTile {
  float x_m[native_tile_points], y_m[native_tile_points], z_m[native_tile_points];
  float range_m[native_tile_points]; // |(x, y, z)|
};

struct NativeDiode {
  float x_m, y_m, z_m; // relative to the reference point
  float intensity_w_sr;
  float square_m2; // |(x, y, z)|^2
};

// Writes for each point of the tiles the phase of sum w exp(j wavenumber e), in [-pi, pi]: w = I / r^2, r the
// way from the diode, e = r - range.
using NativeSum = void (*)(const NativeTile *tiles, std::size_t tile_count, const NativeDiode *diodes,
                           std::size_t diode_count, float wavenumber_per_m, float *phase_rad);

// The same by the sums of I u^k, k below `powers`, with u = (|D|^2 - 2 P.D) / |P|^2, D the diode and P the
// point: r^2 = |P|^2 (1 + u), so the moments are power series in u and the loop has no root and no division.
struct NativeSeries {
  std::size_t powers;
  NativeSum sum;
};

struct NativeSums {
  const char *instructions;
  NativeSum by_moments; // as anyone would write it: root and weight of every way, four moments of the excess
  NativeSeries by_series[4]; // of ever more powers
};

} // namespace pmdsim
