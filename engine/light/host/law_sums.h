#pragma once
// The data of the host's sums over the sources, as plain arrays: its loops are compiled once for each
// instruction set, so they share no code with the rest of the program.

#include "engine/model/exponent.h"
#include "engine/sampling/host/sample_source.h"
#include "engine/view/field_grid.h"

#include <cstdint>

namespace pmdsim {

// A measured diagram on even grids, linear between; 0 outside of the angles that it has.
struct LawTable {
  // For a diagram that is the same for all phi: J at each step of theta, and its rise to the next one.
  // table_margin zeros stand before the first and behind the last.
  const float *values = nullptr, *rises = nullptr;
  // For any other: for each cell, row by row of phi, J at its corner of least angles, the rises of J along
  // theta and along phi, and the rise of the latter along theta.
  const float *cells = nullptr;
  float first_step = 0.0f; // theta's, from 0 rad
  float steps_per_rad = 1.0f;
  std::int32_t steps = 0;
  std::int32_t phi_steps = 0; // of a turn
};
constexpr std::int32_t table_margin = 40;

constexpr std::uint32_t most_host_sums = 12; // over the sources, of a sample; or moments and their weights
static_assert(most_host_sums >= shader::largest_powers && most_host_sums > shader::largest_moments);

constexpr std::uint32_t most_visibility_words = 128; // of a sample

// A source in its batch's frame, m, from the run's reference point.
struct BatchSource {
  float x_m, y_m;
  float square_m2; // of its distance from the reference point
  float intensity; // as GroupSource::intensity
};

// Sources of one law that look along one axis and stand in one plane across it.
struct SourceBatch {
  const LawTable *table; // nullptr: J = cos^power
  Exponent power;        // 0: J = 1
  bool of_lengths;       // W has J r^power, the power of lengths
  bool is_multiplied;    // else a power is taken by its logarithm
  double rotation[3][3]; // batch_from_camera: where phi is 0, where it is 90 degrees, the axis
  double along_m;        // the plane's distance along the axis from the reference point
  float radius_m;        // of the sources about the reference point, across the axis
  const BatchSource *sources;
  const std::uint32_t *bits; // of each source, among all that a sample has
  std::uint32_t count;
};

// NearPolynomials, for places where |u| is at most `largest_u`.
struct PowerTable {
  float largest_u;
  std::uint32_t powers;
  float of_moments[shader::largest_moments][shader::largest_powers];
};

struct RunOfBatches {
  double reference_m[3]; // camera frame
  float radius_m;        // of the sources about it
  const SourceBatch *batches;
  std::uint32_t count;
  const PowerTable *tables; // the shortest first; for places that are nearer, roots are drawn
  std::uint32_t table_count;
  Exponent inverse_powers; // p of W r^-p (moment_polynomials.h)
};

// The moments of each run at each sample (shaders/light/moments.glsl).
struct LawSums {
  SampleSource samples;        // records
  const std::uint32_t *blocks; // of samples, as BlockLists lists them, where they are listed
  const RunOfBatches *runs;
  std::uint32_t run_count;
  std::uint32_t moments;
  bool lambert; // W has the cosine's height over the surface; else only sources in front count
  const std::uint32_t *visibility; // a word a sample and 32 sources, plane by plane; nullptr: all reach it
  const std::uint32_t *lit;        // sources that reach the sample
  std::uint32_t visibility_words;  // of a sample
  std::uint32_t shining;           // all of them
  std::uint32_t plane;             // words of one
  // Out: for each run a plane for each moment, and one for the sum of W rho^-p, which the terms of
  // polynomials are relative to, or of w where roots are drawn. nullptr where the host makes the pixels.
  float *run_moments;
  const FieldGrid *field; // nullptr: each sample has sums of its own
  const FieldBeam *beams; // of each run
};

// Sums for some rows of all samples, or for listed blocks, the last one excluded. One for each instruction
// set.
struct SumLaws {
  void (*sum_rows)(const LawSums &of, std::uint32_t first, std::uint32_t last);
  void (*sum_blocks)(const LawSums &of, std::uint32_t first, std::uint32_t last);
};

} // namespace pmdsim
