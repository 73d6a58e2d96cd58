#pragma once
// The one decision on how a frame is summed, made from the setup and from what the device can do. It knows no
// device: whoever makes passes and memory reads it.

#include "engine/error_budget/plan.h"
#include "engine/frame/frame_facts.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pmdsim {

// Where the samples lie: evenly over an upright chip, evenly over a chip in any pose, in tiles of equal
// places in pixels that are filled in part, or along the rays of a lens that bends lines.
enum class SampleGrid { nominal, posed, tiled, distorted };

// The record of a sample before the sum: its IDs and its depth (16 bytes), or its point and surface.
enum class SampleRecord { depth, point };

// The terms that are summed over the sources: powers of r_nm^2 - rho^2, powers of the path difference, or
// each source's return.
enum class Summation { polynomial_moments, moments, per_diode };

// Samples that the host sums over the sources, one by one; partial: those that some source does not reach.
enum class HostSum { none, partial, all };

// The pixels of a class.
enum class PixelsOf {
  all,             // every pixel
  uniform,         // of one surface that every source lights and that faces them all
  uniform_refined, // the same, for which one point of the pixel is not exact enough
  unshadowed,      // every source lights them, but they need all of their samples
  rest,            // all others
  precise,         // those for which float is not exact enough
};

// Pixels that are summed alike: who, with which sources, at how many of a pixel's points, how exactly.
struct PixelClass {
  PixelsOf who;
  bool reduced;         // few weighted sources stand in for all
  std::uint32_t points; // of a pixel: 1, 4, or its samples
  Precision precision;
  bool shadowed;                   // not every source reaches every sample
  std::optional<ErrorBound> bound; // the bound that its error is held against
};

struct FramePath {
  SampleGrid grid;
  SampleRecord record;
  bool host_raster;          // the host finds what samples see
  bool points_first;         // every sample's point is made before the sum, not only those of a class
  std::uint32_t windows;     // of visibility bits; 0: every source reaches every sample
  bool host_sweep;           // the host finds the light that shapes without holes keep off
  bool holes;                // something with holes stands in the light
  std::uint32_t backscatter; // shader::backscatter_*
  std::uint32_t pattern;     // shader::pattern_*
  Summation summation;
  std::uint32_t powers, moments; // of the sum over all sources
  bool equal_weights, coplanar;
  std::uint32_t
      point_dimensions; // of the polynomials that unshadowed samples' sums are; 0: loops over sources
  HostSum host_sum;
  std::optional<InterpolatedField> field; // in which the host's sums are interpolated
  bool single_run;                        // all sources are one run
  bool one_backscatter;                   // need not be looked up
  bool sums_records;                      // the class of all pixels is summed from depth records
  bool direct;                            // and goes to channels at once
  bool host_pixels;                       // which the host does
  bool host_reads_truth;                  // coverage, depth and IDs come off the records
  // The classes in the order in which they are summed: one of all pixels, or several that pixels are sorted
  // into. Pixels that the first ones leave are listed for those that follow.
  std::vector<PixelClass> classes;
  std::optional<Precision> check; // of the spot check; nothing where no error was asked for

  const PixelClass *of(PixelsOf who) const;
  // Whether depths are all that is ever kept of the samples; else points are made for the samples of a class
  // that asks for them, and for those that are checked.
  bool keeps_depths_only() const { return sums_records && !of(PixelsOf::precise) && !check; }
  // Whether pixels are sorted into classes.
  bool is_sorted() const { return classes.front().who != PixelsOf::all; }
  bool lists_pixels() const { return of(PixelsOf::unshadowed) || of(PixelsOf::rest); }
};

FramePath choose_path(const FrameFacts &facts, const FramePlan &plan, const FrameRequest &request,
                      std::size_t windows, std::optional<float> one_backscatter, const PathForms &allowed);

// Names and values, for people and for JSON.
std::vector<std::pair<std::string, std::string>> description(const FramePath &path);

} // namespace pmdsim
