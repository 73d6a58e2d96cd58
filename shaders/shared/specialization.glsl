// Numbers of the passes' specialization constants. The host gives them in this order, from 0 on.
#ifndef PMDSIM_SPECIALIZATION_GLSL
#define PMDSIM_SPECIALIZATION_GLSL

// Specialization constants of the accumulate pass, by moments and direct.
const uint constant_moments = 0;     // by moments: K, the number of moments
const uint constant_backscatter = 1; // one of backscatter_*
const uint constant_pattern = 2;     // one of pattern_*
const uint constant_order = 3;       // of pattern_power
const uint constant_blocks = 4;      // blocks of diodes that one dispatch sums
const uint constant_first = 5;       // but for the plain form: 1: of the frame's runs this is the first, there is no sum yet
const uint constant_tones = 6;       // by moments: tones that one dispatch sums
const uint constant_waveform = 7;    // direct: one of waveform_*
const uint constant_taps = 8;        // direct, square waveform: N
const uint constant_distinct = 9;    // direct: taps that are summed, N or N / 2; of a sine 1
const uint constant_phased = 10;     // 1: an illuminator has a modulation phase
const uint constant_shadowed = 11;   // 1: not every diode reaches every sample
const uint constant_listed = 12;     // 1: only the samples of a list of pixels
const uint constant_promised = 13;   // 1: keep what the terms come to without their phases
const uint constant_powers = 14;     // by moments: powers of q that are summed for them; 0: none, but e's
const uint constant_alike = 15;      // by powers: 1: every diode has the same weight but for its distance, and is there as a position
const uint constant_planar = 16;     // by powers: 1: all diodes of a run lie in the reference's plane across the view
// And of its plain form:
const uint constant_only = 17;         // 1: the frame has no other run
const uint constant_general_chip = 18; // 1: the chip stands anyhow; 0: nominal

// Specialization constants of the resolve pass.
const uint constant_planes = 0;           // of the sum that belong to one frequency
const uint constant_resolve_waveform = 1; // one of waveform_*
const uint constant_resolve_taps = 2;     // N
const uint constant_keep_taps = 3;        // 1: the taps are channels, too
const uint constant_ground_truth = 4;     // 1: store the ground truth, too
const uint constant_resolve_tiled = 5;    // 1: the tags lie in tiles
const uint constant_resolve_lit = 6;      // 1: store how much of the light reaches the pixel, too
const uint constant_resolve_listed = 7;   // 1: only the pixels of a list
const uint constant_resolve_promised = 8; // 1: an error was promised
const uint constant_resolve_precise = 9;  // 1: samples' returns are turned and added in Real

// Specialization constants of the plain resolve pass: those of the resolve and the points pass, one after the other, then its
// own.
const uint plain_resolve_points = 10;
const uint constant_plain_only = 16; // as constant_only
const uint constant_plain_side = 17; // S
const uint constant_plain_frequencies = 18; // that one dispatch resolves
const uint constant_plain_one = 19; // all surfaces have one backscatter, that of PlainResolveConstants

// Specialization constants of the points passes.
const uint constant_surfaces = 0;   // vectors a sample that the sum asks for: 0, 1 or, precise, 2
const uint constant_vignetting = 1; // 1: cos^4
const uint constant_chip = 2;       // points: 1: the chip stands anyhow or is filled in part; 0: nominal
const uint constant_tiled = 3;      // points: 1: the tags lie in tiles
const uint constant_distortion = 2; // search: one of distortion_*
const uint constant_painted = 4;    // 1: shapes have paint
const uint constant_masked = 3;     // search: 1: shapes may have holes
const uint constant_points_listed = 5; // points: 1: only the samples of a list of pixels

// Specialization constants of the short way: those of the accumulate, the resolve and the points pass, one
// after the other, then its own.
const uint short_way_resolve = 17;
const uint short_way_points = 27;
const uint constant_runs = 33;    // of diodes; 0: no pixel goes the short way, they are only listed
const uint constant_samples = 34; // S
const uint constant_places = 35;  // at which a pixel of several samples is evaluated: 1, its centre; 4,
                                      // only pixels of list_few; 0: at its samples, elsewhere
const uint constant_lists_pixels = 36; // 0: all pixels go the short way and none can break the promise
const uint constant_few_follow = 37;   // 1: list_few is for pixels that one place does not do for

#endif
