// The interface of the host and the shaders: structs, workgroup sizes, values of specialization constants.
// GLSL and C++ both read it. Structs hold only 32-bit scalars, vec2 and vec4, so that both languages lay them
// out in the same way; a double travels as a pair of floats (high part, rest), a buffer's device address as a
// uvec2.
#ifndef PMDSIM_INTERFACE_H
#define PMDSIM_INTERFACE_H

#include "shaders/shared/languages.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

PMDSIM_CONSTANT workgroup_size = 64;
// Diodes are summed in blocks of this size, the blocks' sums in stretches of a run, whose sums are then added
// (a sum of three levels keeps float32 exact to a few units in the last place).
PMDSIM_CONSTANT diodes_per_block = 16;
PMDSIM_CONSTANT blocks_per_stretch = 16;
// A sample has a word for each bundle of a run's diodes, with a bit for each diode: whether it reaches the
// sample.
PMDSIM_CONSTANT diodes_per_bundle = 32;
PMDSIM_CONSTANT no_triangle = 0xffffffffu;
PMDSIM_CONSTANT fragment_hit = 1;

PMDSIM_CONSTANT distortion_brown = 0;
PMDSIM_CONSTANT distortion_fisheye = 1;

PMDSIM_CONSTANT wrap_repeat = 0;
PMDSIM_CONSTANT wrap_mirrored_repeat = 1;
PMDSIM_CONSTANT wrap_clamp = 2;
PMDSIM_CONSTANT filter_nearest = 0;
PMDSIM_CONSTANT filter_linear = 1;

PMDSIM_CONSTANT backscatter_flat = 0;    // rho, every diode is in front of every surface
PMDSIM_CONSTANT backscatter_facing = 1;  // rho where the diode is in front of the surface
PMDSIM_CONSTANT backscatter_lambert = 2; // rho / pi * cosine
PMDSIM_CONSTANT pattern_isotropic = 0;   // of every diode
PMDSIM_CONSTANT pattern_power = 1;       // max(0, cos)^n, the same n for every diode
PMDSIM_CONSTANT pattern_general = 2;     // an order of its own for every diode, any real
PMDSIM_CONSTANT pattern_axial = 3;       // a diagram for every diode, the same all around its axis
PMDSIM_CONSTANT pattern_any = 4;         // a diagram of any kind or an order of its own for every diode

PMDSIM_CONSTANT waveform_sine = 0;
PMDSIM_CONSTANT waveform_square = 1;
PMDSIM_CONSTANT waveform_harmonics = 2;

// A vertex of a triangle as it lies on a raster.
struct RasterVertex {
  float x_fragments;   // from the raster block's left edge, a multiple of 1/256
  float y_fragments;   // from its top edge, likewise
  float inverse_depth; // 0.5 * nearest depth of the frame / depth, 0 to 0.5
  uint triangle;       // id in the scene
};

// The plane normal . P = offset that a triangle lies in, camera frame; the normal is turned to the lens.
struct TrianglePlane {
  vec4 plane_hi;     // normal, offset_m
  vec4 plane_lo;     // their rests
  float backscatter; // rho (constant) or rho / pi (lambert), 1/sr
  uint object;       // id in the scene
  float along_min;   // where a ray can meet the triangle, a hair wider than exact: depth, with distortion
                     // range, m
  float along_max;
};

// How a triangle or a disc is painted, in scenes that have any paint: affine functions of a point's offset
// from the shape's origin (camera frame, m), their gradients in xyz, their values at the origin in w.
struct ShapePaint {
  vec4 origin_hi,
      origin_lo;   // a triangle's first corner, a disc's centre; w: a disc's radius, 0 of a triangle
  vec4 s_hi, s_lo; // column of the texture, texels
  vec4 t_hi, t_lo; // row
  vec4 red, green, blue, alpha; // vertex colour
  uint surface;                 // index into SurfacePaint[]
  uint padding_1, padding_2, padding_3;
};

// rho (constant) or rho / pi (lambert) of a colour is dot(backscatter.rgb, colour.rgb) + backscatter.a.
struct SurfacePaint {
  vec4 backscatter;
  uvec2 texels;        // vec4[]: linear RGBA, row by row
  uint columns, rows;  // of the texture
  uint wrap_u, wrap_v; // wrap_*
  uint filtering;      // filter_*
  float alpha;         // of the surface, times the colour's
  float alpha_cutoff;  // the surface is not there below it
  uint padding_1, padding_2, padding_3;
};

// The plane of a raster block: the ray through (x, y), fragments from its top left corner, is x * X + y * Y +
// corner.
struct BlockPlane {
  vec4 x_hi, x_lo, y_hi, y_lo, corner_hi, corner_lo;
};

// A triangle's corners a, b, c, camera frame, m, and what lies beyond its edges.
struct TriangleCorners {
  vec2 corners[9]; // x, y, z of each: hi, rest
  uint beyond[3];  // the visible triangle that shares the edge ab, bc, ca; no_triangle where there is none
  uint padding;
};

// Where a sample lies in the camera frame, on the chip as seen in front of the lens, m:
//   origin + (2 column + 1 - columns) half_column + (2 row + 1 - rows) half_row      of the whole frame
//          + (2 k_x + 1 - S) half_step_x + (2 k_y + 1 - S) half_step_y               within the pixel
struct ChipPlace {
  vec4 origin_hi, origin_lo;
  vec4 half_column_hi, half_column_lo;
  vec4 half_row_hi, half_row_lo;
  vec4 half_step_x_hi, half_step_x_lo;
  vec4 half_step_y_hi, half_step_y_lo;
};

// The lens's distortion, from the slopes on the chip's side back to the ray. A table of lens_guesses floats
// follows: how many times its distorted radius the undistorted one (or the angle) is, at radii i /
// guesses_per_radius.
struct LensModel {
  ChipPlace chip;
  vec4 radial_hi; // k1, k2, k3, and of a fisheye k4
  vec4 radial_lo;
  vec4 tangential; // p1, p2: hi, lo, hi, lo
  float guesses_per_radius;
  float fold_radius, fold_distorted; // where the model folds over or ends: undistorted radius or angle, and distorted
  float padding;
};
PMDSIM_CONSTANT lens_guesses = 1024;

// The raster of fragments in which a distorted strip searches: fragment coordinates are (x . ray, y . ray) /
// (z . ray), and the ray through (x, y) is x * ray_x + y * ray_y + ray_corner.
struct RasterView {
  vec4 x, y, z;
  vec4 ray_x, ray_y, ray_corner;
  uint columns, rows; // fragments
  uint padding_1, padding_2;
};

// A fragment of a raster view that a rim crosses, and where the shapes that may be seen in it begin among all
// candidates.
struct RimCell {
  uint fragment; // row by row
  uint first_candidate;
};

// A shape, or no_triangle after the last one of a cell.
struct RimCandidate {
  uint shape;
  float depth_m; // along the view's axis, at least; a hair less than exact
};

// A diode, relative to the reference point of its group, camera frame.
struct GroupSource {
  vec4 position;   // -2 * position_m, |position_m|^2
  vec4 axis;       // unit axis, axis . position_m
  float intensity; // over the frame's largest
  float order;     // of the cosine; below 0 the number of another law (engine/light/radiation_laws.cpp)
  // The members below are the law's own; for a measured diagram:
  uint diagram; // index of its first value in the table of all (diagram_tables.h)
  float theta_steps;
  float first_theta; // rad
  float theta_steps_per_rad;
  uint row_length; // angles to the axis of a diagram that is not the same for all phi, else 0
  float padding;
  vec4 across; // camera frame, unit length, where the diagram's first phi is; steps of phi in a turn
};

// The same for the precise sum, with what rounding to float took.
struct PreciseSource {
  GroupSource rounded;
  vec4 position_rest;
  vec4 axis_rest;
  float intensity_rest;
  float order_rest;
  uint diagram; // of a measured one, the index of its first number (engine/light/precise_diagrams.h)
  float padding;
  vec4 across_rest;
};

// Properties that the diodes of a run share.
struct LightRun {
  vec4 reference_hi; // the group's reference point (camera frame, m)
  vec4 reference_lo; // its rest
  vec2 phase_turns;  // of the group's illuminator, -1/2 to 1/2: hi, lo
  float radius_m;    // at most, of its diodes about the reference point
  float intensity;   // of all its diodes, relative
  float heights;    // with Lambert's law: what rounding the diodes' heights counts as in sum of |terms|, over
                    // I / r^3, m
  float diagrams;   // likewise of measured diagrams, times r^2
  float beam_edges; // likewise of cosines to the diodes' axes beyond 45 degrees, over weights *
                    // W^-beam_edge_root
  float beam_edge_root; // W = sum of weights / (I / r^2)
  float beam_edge_most; // and the most that this comes to, over I / r^2
  float beams, beams_per_log; // the square of what rounding does to a beam's weights, over -ln W and over that
                              // for each -ln W
  float brightest; // I of these W: as intensity, each diode's times its largest J, if that is above 1
  float mean_over_modulated; // of the illuminator's light
  float padding_1, padding_2, padding_3;
  vec4 detours; // sum of the diodes' GroupSource::position, where they are alike (constant_equal_weights)
  // Moment k over rho^k is the sum of moments_of_powers[3 k + i / 4][i % 4] * S_i / rho^(2 i)
  // (moment_polynomials.h).
  vec4 moments_of_powers[27];
};
PMDSIM_CONSTANT largest_powers = 12; // of q
PMDSIM_CONSTANT largest_moments = 9;

// The sums of powers of q of a run as polynomials of the point (engine/light/point_polynomials.h). The
// coefficients follow behind it, those of S_0 first, term by term, and the components of each term.
struct PointPolynomials {
  vec4 axis;       // as in GroupSource, of all diodes
  float per_metre; // 1 / unit
  float unit_m;    // of lengths in the coefficients, a power of two
  float unit_m2;   // its square
  float padding;
};

// A harmonic of a modulation frequency.
struct Tone {
  vec2 turns_per_m; // of path, frequency / c: hi, lo
  float wavenumber; // 2 pi frequency / c, rad/m
  float harmonic;   // how many of its turns a turn of the fundamental is
};

// A strip's samples where they are an even grid over the chip, row by row. Counted in half samples from the
// frame's middle they lie at first + 2 (column, row).
struct SampleGrid {
  vec4 slope;   // nominal chip: half a sample's width in units of the image distance: x hi, x lo, y hi, y lo
  vec2 first;   // of the strip's first sample
  uint columns; // samples in a row
  float inverse_columns; // 1 / columns
};

// Where the strip of pixels that is being computed lies in the frame.
struct Strip {
  uint column, row;   // of its first pixel
  uint columns, rows; // pixels
  uint resolution_x;  // of the whole frame, pixels
  uint resolution_y;
  uint samples;       // S
  uint padded_pixels; // columns * rows, rounded up to whole workgroups, and one more of these
};

// IDs are uvec2(pixel id, triangle id); the pixel id is row * resolution_x + column + 1, or 0 where nothing
// was hit. Those of samples that are an even grid over the whole strip lie row by row. Where pixels are
// filled in part, there are S x S tiles of one sample a pixel each. With distortion, fragments are no
// samples: their IDs only say what is seen, and the samples' IDs follow from a search, row by row. In place of a
// pixel id they have fragment_hit, 0 where nothing is hit, and of a rim cell 2 (1 + its first candidate) more.
struct IdRasterConstants {
  vec2 shift;          // of the tile's samples from the fragments' centres, fragments, a multiple of 1/256
  uint tile_x, tile_y; // of its first fragment
  uint column, row;    // of the strip's first pixel
  uint resolution_x;   // of the frame
  uint fragments_per_pixel_side; // 0: with distortion
  // Where shapes have holes:
  vec2 sample_shift;     // of the tile's samples from the fragments' centres, fragments
  uint block_x, block_y; // of the strip's first fragment, from its block's corner
  uvec2 block;           // in: BlockPlane
  uvec2 planes;          // in: TrianglePlane[]
  uvec2 shapes;          // in: ShapePaint[]
  uvec2 surfaces;        // in: SurfacePaint[]
  // Where fragments leave their depth, too, as in SampleGrid:
  vec4 slope;
  vec2 first;
  uvec2 chip; // in: ChipPlace
};

// Adds the depths to records that the raster left without.
struct RecordDepthsConstants {
  SampleGrid grid; // of all fragments
  uvec2 chip;      // in: ChipPlace
  uvec2 planes;    // in: TrianglePlane[]
  uvec2 ids;       // in: records without depths; out: with them
  uint fragments;  // in all
  uint padding;
};

// A sample of the frame, by its column and row among all samples, and the triangle that it sees, or no_triangle.
struct EdgeSample {
  uint column, row;
  uint triangle;
};

// Gives samples near edges what they see.
struct SettleEdgesConstants {
  SampleGrid grid; // where they have records
  uvec2 chip;      // in: ChipPlace, likewise
  uvec2 planes;    // in: TrianglePlane[], likewise
  uvec2 ids;       // in and out: ids or records
  uvec2 samples;   // in: EdgeSample[]
  uint count;
  uint column, row;   // of the strip's first pixel
  uint columns, rows; // of the strip, pixels
  uint side;          // S
  uint resolution_x;  // of the frame
  uint padding;
};

// Sample (sx, sy) of the strip's pixel p is stored at (sy * S + sx) * padded_pixels + p.
struct PointsConstants {
  Strip strip;
  vec4 slope;   // nominal chip: half a sample's width in units of the image distance: x hi, x lo, y hi, y lo
  uvec2 chip;   // in, else: ChipPlace
  uvec2 ids;    // in: ids
  uvec2 planes; // in: TrianglePlane[]
  uvec2 position; // out: Real[3] a sample, the point in the camera frame, m; z = 0 where nothing was hit
  uvec2 surface;  // out: vec4[], normal turned to the lens, distance lens - plane (m), where the sum asks for
                  // it; where it is precise each followed by its rest
  uvec2 backscatter; // out: float[], as in TrianglePlane, 0 where nothing was hit
  uvec2 shapes;      // in, where painted: ShapePaint[]
  uvec2 surfaces;    // in, where painted: SurfacePaint[]
  uvec2 list;        // in, where listed: PixelList and its pixels
};

// Marks the fragments that are rim cells.
struct MarkRimsConstants {
  uvec2 fragments; // in and out
  uvec2 cells;     // in: RimCell[]
  uint count;
  uint padding;
};

struct LensSearchConstants {
  Strip strip;
  uvec2 lens;      // in: LensModel and its table
  uvec2 view;      // in: RasterView
  uvec2 fragments; // in: ids of the view's fragments, marked
  uvec2 planes;    // in: TrianglePlane[]
  uvec2 corners;   // in: TriangleCorners[]
  uvec2 candidates; // in: RimCandidate[]
  uvec2 ids;       // out: ids of the samples
  uvec2 position;  // out, as in PointsConstants
  uvec2 surface;
  uvec2 backscatter;
  uvec2 shapes;
  uvec2 surfaces;
};

// The sum is made of planes, vec4[] over the samples: two sums and what rounding took from either. For each
// tone of a sine or of harmonics one plane holds the complex return relative to twice the sample's range; for
// square light, of each frequency, plane p holds the taps 2 p and 2 p + 1. An even N makes do with the taps
// below N / 2: the triangle wave half a turn on is its negative.
struct AccumulateConstants {
  uvec2 position; // in, as the points pass left them
  uvec2 surface;
  uvec2 backscatter;
  uvec2 sum;    // in (but for the first run) and out: of the first tone, or of the frequency
  uvec2 run;    // in: LightRun
  uvec2 diodes; // in: the run's, GroupSource[] or, precise, PreciseSource[]; of alike ones
                // (constant_equal_weights) only the positions, vec4[], which take a fifth of a processor's
                // cache
  uvec2 tones;      // in: Tone[]
  uvec2 diagrams;   // in: vec2[], the diagrams' values, each with the next theta's
  uvec2 visibility; // in, where shadowed: the words of the run's bundles, bundle by bundle
  uvec2 terms; // in (but for the first run) and out, where terms are kept: float[], sum of |terms| of each
               // sample, then the others (PixelSum in shaders/signal/demodulation.glsl), likewise
  uvec2 list;  // in, where listed: PixelList and its pixels
  uint blocks; // blocks of diodes to sum, for the looped variant
  uint plane;  // elements of a plane of the sum
  uint padded_pixels;
  uint adds_terms; // 0: another dispatch for the same diodes does
  uint columns;    // of the strip, pixels
  uint samples;    // S
};

// How a modulation frequency becomes channels, and what was asked for of it: a distance within limit_m and an
// amplitude within amplitude_limit. Both are off by fixed + per_condition * condition at most, the condition
// being sum of |terms| / |sum|.
struct Frequency {
  vec2 turns_per_m;      // of range, 2 f / c: hi, lo
  vec2 ambiguity_m;      // c / (2 f): hi, lo
  vec2 below;            // the largest floats below 2 pi and below c / (2 f)
  uvec2 harmonics;       // float[]: their amplitudes in the correlation function
  float amplitude_scale; // amplitude per unit of the mean return
  uint first_channel;
  float limit_m, fixed_m, per_condition_m;
  float amplitude_limit, amplitude_fixed, amplitude_per_condition;
  uint diodes;      // of all illuminators
  uint lit_channel; // where the share of them that reaches a pixel goes
  // For samples at one range; and what near_per_condition_m grows by for each metre that they are apart.
  float near_fixed_m, near_per_condition_m, per_apart;
  // The errors of weights that are off, in units of engine/model/accuracy.h: as distance, as distance of
  // samples at one range, and as amplitude, which is also what the second grows by a metre.
  float per_weight_m, near_per_weight_m, per_weight;
  // What all weights are off by, in the same units; the part of the first that this has, and what it does as distance over
  // sqrt(condition^2 - 1).
  float weight_error, even_part, any_weight_m;
  float near_even_part; // of the second
};

struct DemodulationConstants {
  uvec2 position;
  uvec2 sum; // of the frequency, the first plane
  uvec2 ids;
  uvec2 planes;
  uvec2 channels;   // out: pair by pair of channels (channel_*), of each pixel two values of 32 bits
  uvec2 frequency;  // in: Frequency
  uvec2 lit;        // in: uint a sample, the diodes that reach it
  uvec2 terms;      // in, where terms are kept: as in AccumulateConstants
  uvec2 violations; // in and out, where terms are kept: BudgetViolations; or as ClaimsConstants::errors, of the frequency
  uvec2 list;       // in, where listed: PixelList and its pixels
  uvec2 later;      // out, where pixels pass on: PixelList of those that a later class sums again
  uint columns;     // of the strip
  uint samples;
  uint padded_pixels;
  uint pixels; // of the strip
  uint plane;  // elements of a plane of the sum
  uint lit_channel;
  uint diodes; // of all illuminators
};

// A list of work begins with the arguments of a dispatch over it, workgroups along y and then z; its entries follow.
PMDSIM_CONSTANT workgroups_per_row = 32768; // along y; devices may end at 65,535
struct WorkList {
  uint groups_x, groups_y, groups_z;
  uint count;
};

// Samples row by row, taken in tiles of so many a side.
PMDSIM_CONSTANT tile_side = 8;
PMDSIM_CONSTANT tile_samples = tile_side * tile_side;

// Depth records in blocks of neighbours in a row, listed by what there is to do for them. A block is of one
// row, so that the treatment of a sample does not depend on where strips end. An entry is `block_samples`
// times the block's first sample, plus the number of its other samples.
PMDSIM_CONSTANT block_samples = 8;
PMDSIM_CONSTANT no_blocks = 0;     // no list: all samples
PMDSIM_CONSTANT blocks_lit = 1;    // every diode reaches all that they see
PMDSIM_CONSTANT blocks_shaded = 2; // some diode does not
PMDSIM_CONSTANT blocks_empty = 3;  // nothing is seen
PMDSIM_CONSTANT block_lists = 3;

struct BlockListConstants {
  uvec2 records;
  uvec2 lit;                // in: uint a sample, the diodes that reach it
  uvec2 lists[block_lists]; // out, of blocks_lit and what follows: WorkList
  uint columns, rows;       // of samples
  uint blocks_across;
  uint shining; // diodes, of all illuminators
};

// The sum over depth records and what becomes of it: all samples alike, row by row, each with a record of two
// words of IDs and two of depth (Real). The sum has no backscatter in it; its planes hold a vec4 a sample, as
// above, or, of a frame's only run, a vec2.
struct DepthSumConstants {
  SampleGrid grid;
  uvec2 chip; // in: ChipPlace
  uvec2 records;
  uvec2 planes; // in: TrianglePlane[]
  uvec2 sum;    // as in AccumulateConstants, from here on
  uvec2 run;
  uvec2 diodes;
  uvec2 tones;
  uvec2 diagrams;
  uint blocks;
  uint plane;
  uint samples;  // of the strip, in all
  uint is_first; // of the frame's runs: nothing is in the sum yet
  uvec2 visibility; // in, where shadowed: as in AccumulateConstants
  uvec2 blocks_of_list; // in, where only those of a list are summed: WorkList
};

// The demodulation of a sum that goes to a pixel's channels at once. DepthSumConstants::sum leads here. Each
// Frequency follows behind it.
struct DirectPixels {
  uvec2 channels, shapes, surfaces, lit; // as in DepthDemodulationConstants
  uvec2 errors; // out, where terms are kept: vec2 of each tone and pixel, what it may be off by (ClaimsConstants)
  float backscatter;
  uint padding;
};

// Judges the errors that the pixels may have.
struct ClaimsConstants {
  uvec2 errors; // in, of each tone plane by plane: distance, m, and relative amplitude, both negative where they are not
                // within what was asked for
  uvec2 violations, later; // as in DemodulationConstants
  uint pixels;             // of the strip
  uint plane;
  uint tones;
  uint padding;
};
PMDSIM_CONSTANT claims_per_invocation = 64; // pixels

struct DepthDemodulationConstants {
  SampleGrid grid;
  uvec2 chip;
  uvec2 records;
  uvec2 planes;
  uvec2 sum; // as in DemodulationConstants, from here on
  uvec2 channels;
  uvec2 errors;    // out, where terms are kept: as ClaimsConstants::errors
  uvec2 frequency; // in: Frequency[]
  uvec2 shapes; // as in PointsConstants
  uvec2 surfaces;
  uvec2 lit; // in: uint a sample, the diodes that reach it
  uint pixels; // of the strip
  uint padded_pixels;
  uint plane;
  float backscatter; // as in TrianglePlane, where all surfaces have the same
};

// Pixels that wait for their samples to be summed; their numbers follow. Numbers of workgroups are counted
// once all are there.
struct PixelList {
  uint sample_groups_x, sample_groups_y, sample_groups_z; // an invocation for each sample
  uint pixel_groups_x, pixel_groups_y, pixel_groups_z;    // an invocation for each pixel
  uint count;
  uint padding;
};
PMDSIM_CONSTANT pixel_lists = 4;
PMDSIM_CONSTANT list_unshadowed = 0; // every diode lights whatever they see
PMDSIM_CONSTANT list_rest = 1;       // not every one does
PMDSIM_CONSTANT list_refined = 2;    // one surface that every diode lights, which few points may do for
PMDSIM_CONSTANT list_precise = 3;    // float may not be exact enough

struct PixelListConstants {
  uvec2 lists[pixel_lists]; // in and out: PixelList
  uint samples;             // of a pixel, S x S
};

// Pixels that may be off by more than was asked for.
struct BudgetViolations {
  uint returns;    // of pixels, each at each frequency
  float worst_m;   // as far as is known; bits of a float >= 0 compare as the float does
  float amplitude; // relative, likewise
  float kept_m;    // the largest bound of those that are not, likewise
  float kept_amplitude;
  uint padding;
};

// The light as the uniform-pixel pass sees it. The LightRuns of the diodes that stand in for all follow.
// (Lavapipe fetches for each lane whatever has an address in memory.)
PMDSIM_CONSTANT uniform_tones = 4; // at most
struct UniformPixelsLight {
  vec4 middle_m;       // of the box around the light, camera frame
  vec4 extent_m;       // half of it; w: the radius of the sphere around it
  uvec2 diagrams;      // vec2[]
  float pattern_slope; // at most, of ln J, per radian
  float spread_m;   // at most, how much the paths of two diodes over one point differ; 1 rad of phase where
                    // theirs do
  float wavenumber; // of the highest frequency, rad/m
  float point_spread_m; // at most, how much the ranges of the points of a pixel may differ
  uint padding_1, padding_2;
  Tone tones[uniform_tones];
  Frequency frequencies[uniform_tones];
};

// Sees a pixel from its IDs to its channels, or lists it.
struct UniformPixelsConstants {
  Strip strip;
  vec4 slope; // as in PointsConstants
  uvec2 chip; // likewise
  uvec2 ids;
  uvec2 planes;
  uvec2 shapes;
  uvec2 surfaces;
  uvec2 lit;      // in, where shadowed: uint a sample, the diodes that reach it
  uvec2 light;    // in: UniformPixelsLight and its LightRuns
  uvec2 diodes;   // in, as in AccumulateConstants, run by run
  uvec2 channels; // out, as in DemodulationConstants
  uvec2 work;     // in and out: UniformPixelsWork
};

// Where the uniform-pixel pass leaves the pixels that it cannot do.
struct UniformPixelsWork {
  uvec2 lists[pixel_lists]; // PixelList
  uvec2 violations;         // BudgetViolations
  uint lit_channel;
  uint diodes; // of all illuminators
};

#ifdef __cplusplus
} // namespace pmdsim::shader
#endif

#endif
