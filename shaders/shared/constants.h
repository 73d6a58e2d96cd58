// Specialization constants: one number and one name for each meaning in all modules. Where a module declares one, it is called as
// here without `constant_`. Read by GLSL and C++ alike.
#ifndef PMDSIM_CONSTANTS_H
#define PMDSIM_CONSTANTS_H

#include "shaders/shared/languages.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

PMDSIM_CONSTANT constant_straight = 0; // 1: what a dispatch sums is one straight line; 0: a loop over blocks of diodes
PMDSIM_CONSTANT constant_blocks_per_run = 1; // blocks of diodes of a run, as a straight line has to know them
PMDSIM_CONSTANT constant_runs = 2; // of diodes; 0: no pixel is summed, pixels are only listed
PMDSIM_CONSTANT constant_moments = 3; // K, the number of moments
PMDSIM_CONSTANT constant_powers = 4; // of q that are summed for the moments; 0: none, but those of e
PMDSIM_CONSTANT constant_equal_weights = 5; // by powers: 1: every diode has the same weight but for its distance, and is there as a position
PMDSIM_CONSTANT constant_coplanar = 6; // by powers: 1: all diodes of a run lie in the reference's plane across the view
PMDSIM_CONSTANT constant_backscatter_model = 7; // one of backscatter_*
PMDSIM_CONSTANT constant_pattern_model = 8; // one of pattern_*
PMDSIM_CONSTANT constant_cosine_order = 9; // of pattern_power, its whole part
PMDSIM_CONSTANT constant_phased = 10; // 1: an illuminator has a modulation phase
PMDSIM_CONSTANT constant_shadowed = 11; // 1: not every diode reaches every sample
PMDSIM_CONSTANT constant_tones = 12; // that one dispatch sums
PMDSIM_CONSTANT constant_waveform = 13; // one of waveform_*
PMDSIM_CONSTANT constant_taps = 14; // N
PMDSIM_CONSTANT constant_planes = 15; // of the sum that belong to one frequency
PMDSIM_CONSTANT constant_frequencies = 16; // that one dispatch resolves
PMDSIM_CONSTANT constant_is_first = 17; // 1: of the runs or windows that follow each other this is the first: there is nothing yet
PMDSIM_CONSTANT constant_is_only = 18; // 1: the frame has no other run
PMDSIM_CONSTANT constant_listed = 19; // 1: only the samples or pixels of a list
PMDSIM_CONSTANT constant_keeps_terms = 20; // 1: an error was asked for; what the terms come to without their phases is kept
PMDSIM_CONSTANT constant_precise_sum = 21; // 1: samples' returns are turned and added in Real
PMDSIM_CONSTANT constant_keep_taps = 22; // 1: the taps are channels, too
PMDSIM_CONSTANT constant_ground_truth = 23; // 1: store the ground truth, too
PMDSIM_CONSTANT constant_lit_is_kept = 24; // 1: store how much of the light reaches the pixel, too
PMDSIM_CONSTANT constant_side = 25; // S: a pixel has S x S samples
PMDSIM_CONSTANT constant_tiled = 26; // 1: the IDs lie in tiles
PMDSIM_CONSTANT constant_general_chip = 27; // 1: the chip stands anyhow or is filled in part; 0: nominal
PMDSIM_CONSTANT constant_distortion = 28; // one of distortion_*
PMDSIM_CONSTANT constant_vignetting = 29; // 1: cos^4
PMDSIM_CONSTANT constant_painted = 30; // 1: shapes have paint
PMDSIM_CONSTANT constant_cutouts = 31; // 1: shapes may have holes
PMDSIM_CONSTANT constant_one_backscatter = 32; // 1: all surfaces have one backscatter
PMDSIM_CONSTANT constant_surface_vectors = 33; // a sample that the sum asks for: 0, 1 or, precise, 2
PMDSIM_CONSTANT constant_quadrature_points = 34; // at which a pixel of several samples is evaluated: 1, its centre; 4, pixels of list_refined; 0: none
PMDSIM_CONSTANT constant_lists_pixels = 35; // one of lists_*
PMDSIM_CONSTANT constant_lanes = 36; // of a subgroup
PMDSIM_CONSTANT constant_most_steps = 37; // of all loops of an invocation
PMDSIM_CONSTANT constant_bundles = 38; // of the window
PMDSIM_CONSTANT constant_half_viewport = 39; // float, fragments: a power of two
PMDSIM_CONSTANT constant_depth_records = 40; // 1: samples are records; 0: they have ids alone

PMDSIM_CONSTANT constant_lens_apart = 41; // 1: the lens does not lie in the plane of the diodes
PMDSIM_CONSTANT constant_all_facing = 42; // 1: every surface faces every diode
PMDSIM_CONSTANT constant_lists_hidden = 43; // 1: of triangles that the lens does not see
PMDSIM_CONSTANT constant_exact_only = 44; // 1: nothing is decided in float
PMDSIM_CONSTANT constant_point_dimensions = 45; // by powers: 2 or 3: their sums are polynomials of the point in so many coordinates; 0: loops over the diodes
PMDSIM_CONSTANT constant_keeps_bounds = 46; // 1: what each pixel may be off by is a channel, too
PMDSIM_CONSTANT constant_passes_on = 47; // 1: pixels that may be off by more than was asked for are listed for a later class
PMDSIM_CONSTANT constant_reports_kept = 48; // 1: the largest bound of the pixels that keep theirs is wanted
PMDSIM_CONSTANT constant_block_list = 49; // one of no_blocks and blocks_*: of depth records only those of a list
PMDSIM_CONSTANT constant_beam_edges = 50; // 1: what rounding does where beams end counts as light
PMDSIM_CONSTANT constant_holds_pixels = 51; // 1: what each pixel may be off by is held against what was asked for
PMDSIM_CONSTANT constant_summed_by_host = 52; // a run's moments, at each sample
PMDSIM_CONSTANT constant_bits_by_row = 53; // 1: a sample's bits lie where its record does, not sub-sample by sub-sample
PMDSIM_CONSTANT constant_cosine_fraction = 54; // float; of pattern_power, what is left of its order
PMDSIM_CONSTANT constant_beams = 55; // 1: what rounding does within beams is kept beside the light
PMDSIM_CONSTANT constant_keeps_mean = 56; // 1: the last frequency is 0 Hz, whose sum is the mean light's
PMDSIM_CONSTANT constant_keeps_rests = 57; // 1: what rounding takes from distance and range is a channel, too
PMDSIM_CONSTANT constant_dark_beyond_fold = 58; // 1: places without a ray see nothing; 0: there are none

PMDSIM_CONSTANT lists_no_pixel = 0; // the uniform-pixel pass takes all, and none can be beyond the bound
PMDSIM_CONSTANT lists_in_two = 1;   // what does not: in list_unshadowed or list_rest
PMDSIM_CONSTANT lists_in_three = 2; // list_refined is for pixels that one point does not do for
PMDSIM_CONSTANT lists_in_rest = 3;  // all in list_rest

#ifdef __cplusplus
} // namespace pmdsim::shader
#endif

#endif
