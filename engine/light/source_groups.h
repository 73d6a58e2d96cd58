#pragma once
// The diodes cut into groups with a reference point each, so that their moments (docs/theory.md, "The sum
// by moments") converge fast and nothing cancels, and laid out as the accumulate pass reads them.

#include "engine/light/camera_light.h"
#include "engine/light/moment_polynomials.h"
#include "engine/light/path_difference.h"
#include "engine/model/accuracy.h"
#include "shaders/shared/interface.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace pmdsim {

// The largest (kappa * e)^K / K! of the moments left out, over the sum of the weights (docs/theory.md, "The
// sum by moments").
inline double largest_remainder(Precision precision) {
  return precision == Precision::fp64 ? 0x1p-45 : 0x1p-26;
}

// The largest remainder where kappa * e is `phase_rad`: where a wavelength is long, that much of a turn would
// be a long way, so it is no more than 16 times as much of e, too.
inline double largest_term(double phase_rad, double remainder) {
  return remainder * std::min(1.0, 16.0 * phase_rad);
}

// One dispatch of the accumulate pass: a run of whole blocks of diodes that share a reference point.
struct SourceRun {
  glm::dvec3 reference_m;  // camera frame
  std::uint32_t first;     // index into SourceGroups::diodes
  double phase_turns;      // the illuminator's modulation phase, -1/2 to 1/2
  double modulation_depth; // the illuminator's
  PathDifference reach;    // of its group; the radius is at most half of the range to what it lights
};

// A diode among all of all illuminators.
struct SourcePosition {
  glm::dvec3 position_m;        // camera frame
  std::uint32_t number = no_id; // counted through the illuminators; no_id of a dark one that pads a run
  double law_error = 0.0;       // of its J, beside what rounding does (radiation_laws.h)
  double brightest = 1.0;       // its largest J, or 1
};

struct SourceGroups {
  std::uint32_t moments = 1; // K, the same for every group
  // What series may leave out of a sum beyond rounding: of the relative weights, and as an angle at the
  // highest frequency, rad.
  double tolerance = 0.0;
  // How much rounding may grow in tables of powers that stand for roots.
  double near_growth = largest_near_growth;
  std::uint32_t blocks_per_run =
      1; // of shader::diodes_per_block diodes; short runs are padded with dark ones
  double largest_intensity_w_sr = 0; // what GroupSource::intensity is relative to
  bool phased = false;               // an illuminator has a modulation phase
  std::vector<SourceRun> runs;
  std::vector<shader::GroupSource> diodes;
  std::vector<shader::PreciseSource> precise_diodes; // the same; only for fp64
  std::vector<SourcePosition> positions; // beside `diodes`; those that stand together lie together
  std::vector<glm::vec2> diagrams;       // of all: as in DiagramTables, of fp64 as in PreciseDiagrams
  std::uint32_t diode_count = 0;         // without the dark ones
  double path_difference_m =
      0.0;               // at most, of any group: |r_nm - rho| over its diodes and all that is visible
  double radius_m = 0.0; // of the largest group
  double radius_over_range = 0.0; // at most, of any group: its radius over the range to what is visible
  MomentPolynomials polynomials;  // what the moments are summed by, run by run
  // Where these have no powers: of the tables that the host may have for places that are not near, whose
  // errors the frame's bounds contain.
  std::optional<MomentPolynomials> near_polynomials;
};

// The most blocks of a run, one straight line of code: of any diodes, and of such as are alike
// (MomentPolynomials), which take little code.
constexpr std::uint32_t usual_run_blocks = 16, long_run_blocks = 64;

// A group's diodes are of one illuminator, whose modulation phase they share. `visible` bounds the points
// that they light; wavenumber = 2 pi f / c, rad/m. Throws Error: input where intensities are too far apart.
SourceGroups group_diodes(const std::vector<CameraIlluminator> &illuminators,
                          const std::vector<VisibleBox> &visible, double wavenumber_rad_m,
                          Precision precision = Precision::fp32, std::uint32_t most_blocks = usual_run_blocks,
                          double tolerance = 0.0);

// The same diodes as `groups` in the same order and runs, in fp64.
SourceGroups precise_groups(const std::vector<CameraIlluminator> &illuminators,
                            const std::vector<VisibleBox> &visible, double wavenumber_rad_m,
                            const SourceGroups &groups);

// The smallest K whose remainder (kappa * e)^K / K! is at most that, or within the tolerance.
std::uint32_t moments_needed(double phase_rad, double remainder, double tolerance = 0.0);

// The number of diodes that are no padding.
std::uint32_t shining_diodes(const SourceGroups &groups);

} // namespace pmdsim
