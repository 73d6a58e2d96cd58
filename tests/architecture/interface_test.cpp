// shaders/shared/interface.h is read by GLSL and by C++: both must lay its structs out alike. Every member of
// every struct that a compiled shader carries is compared with the compiler's.

#include "engine/vulkan/shader_module.h"
#include "shaders/shadow/holes_interface.h"
#include "shaders/shadow/sweep_interface.h"
#include "tests/architecture/spirv_layout.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace pmdsim::shader;
using namespace pmdsim::test;
using pmdsim::vulkan::shader_modules;
using pmdsim::vulkan::ShaderModule;

namespace {

struct HostLayout {
  std::size_t bytes;
  std::vector<Member> members; // all of them: a shader's must be the same
};

// STRUCT(Name, member...): its row in the table.
#define MEMBER(Struct, member)                                                                               \
  Member { #member, offsetof(Struct, member), sizeof(Struct::member) }
#define AGAIN() MEMBERS
#define PARENTHESES ()
#define MEMBERS(Struct, member, ...)                                                                         \
  MEMBER(Struct, member), __VA_OPT__(AGAIN PARENTHESES(Struct, __VA_ARGS__))
#define EXPAND_5(...) __VA_ARGS__
#define EXPAND_4(...) EXPAND_5(EXPAND_5(__VA_ARGS__))
#define EXPAND_3(...) EXPAND_4(EXPAND_4(EXPAND_4(EXPAND_4(__VA_ARGS__))))
#define EXPAND(...) EXPAND_3(EXPAND_3(EXPAND_3(EXPAND_3(__VA_ARGS__))))
// clang-format off
#define STRUCT(Struct, ...) {#Struct, {sizeof(Struct), {EXPAND(MEMBERS(Struct, __VA_ARGS__))}}}
const std::map<std::string, HostLayout> host_layouts{
    STRUCT(ChipPlace, origin_hi, origin_lo, half_column_hi, half_column_lo, half_row_hi, half_row_lo,
           half_step_x_hi, half_step_x_lo, half_step_y_hi, half_step_y_lo),
    STRUCT(LensModel, chip, radial_hi, radial_lo, tangential, guesses_per_radius, fold_radius, fold_distorted,
           padding),
    STRUCT(RasterView, x, y, z, ray_x, ray_y, ray_corner, columns, rows, padding_1, padding_2),
    STRUCT(EdgeSample, column, row, triangle),
    STRUCT(SettleEdgesConstants, grid, chip, planes, ids, samples, count, column, row, columns, rows, side, resolution_x, padding),
    STRUCT(RimCell, fragment, first_candidate),
    STRUCT(RimCandidate, shape, depth_m),
    STRUCT(MarkRimsConstants, fragments, cells, count, padding),
    STRUCT(TrianglePlane, plane_hi, plane_lo, backscatter, object, along_min, along_max),
    STRUCT(ShapePaint, origin_hi, origin_lo, s_hi, s_lo, t_hi, t_lo, red, green, blue, alpha, surface,
           padding_1, padding_2, padding_3),
    STRUCT(SurfacePaint, backscatter, texels, columns, rows, wrap_u, wrap_v, filtering, alpha,
           alpha_cutoff, padding_1, padding_2, padding_3),
    STRUCT(BlockPlane, x_hi, x_lo, y_hi, y_lo, corner_hi, corner_lo),
    STRUCT(TriangleCorners, corners, beyond, padding),
    STRUCT(GroupSource, position, axis, intensity, order, diagram, theta_steps, first_theta,
           theta_steps_per_rad, row_length, padding, across),
    STRUCT(PreciseSource, rounded, position_rest, axis_rest, intensity_rest, order_rest, diagram,
           padding, across_rest),
    STRUCT(Tone, turns_per_m, wavenumber, harmonic),
    STRUCT(LightRun, reference_hi, reference_lo, phase_turns, radius_m, intensity, heights, diagrams, beam_edges,
           beam_edge_root, beam_edge_most, beams, beams_per_log, brightest, mean_over_modulated,
           padding_1, padding_2, padding_3, detours, moments_of_powers),
    STRUCT(Frequency, turns_per_m, ambiguity_m, below, harmonics, amplitude_scale, first_channel, limit_m, fixed_m,
           per_condition_m, amplitude_limit, amplitude_fixed, amplitude_per_condition, diodes,
           lit_channel, near_fixed_m, near_per_condition_m, per_apart, per_weight_m,
           near_per_weight_m, per_weight, weight_error, even_part, any_weight_m, near_even_part),
    STRUCT(SampleGrid, slope, first, columns, inverse_columns),
    STRUCT(Strip, column, row, columns, rows, resolution_x, resolution_y, samples, padded_pixels),
    STRUCT(IdRasterConstants, shift, tile_x, tile_y, column, row, resolution_x, fragments_per_pixel_side,
           sample_shift, block_x, block_y, block, planes, shapes, surfaces, slope, first, chip),
    STRUCT(RecordDepthsConstants, grid, chip, planes, ids, fragments, padding),
    STRUCT(PointsConstants, strip, slope, chip, ids, planes, position, surface, backscatter, shapes,
           surfaces, list),
    STRUCT(LensSearchConstants, strip, lens, view, fragments, planes, corners, candidates, ids, position, surface,
           backscatter, shapes, surfaces),
    STRUCT(DiodeBox, low, high),
    STRUCT(BundleDiodes, centre, extent, places),
    STRUCT(HolesWindow, box, slope, shining, chip, paints, surfaces, bundles, shapes, first_block, first_range,
           world_rounding),
    STRUCT(TileBox, low, high),
    STRUCT(HolesWork, ranges),
    STRUCT(HolesConstants, strip, position, ids, window, boxes, work, visibility, lit, first_range, range, tiles,
           plane),
    STRUCT(WorkList, groups_x, groups_y, groups_z, count),
    STRUCT(BlockListConstants, records, lit, lists, columns, rows, blocks_across, shining),
    STRUCT(SweepBoard, rows_hi, rows_lo, slope, shining, supports_a, supports_b, lens_z, radius, rest_step, highest,
           diodes_low, diodes_high, leaves_none, padding_1, level_first, level_count, chip, lit, piercers,
           piercer_count, nearest, line_margin, world_rounding),
    STRUCT(TileShaft, slopes_a, slopes_b, sights_a, sights_b, low, high),
    STRUCT(SweepRound, list_groups_x, list_groups_y, list_groups_z, tiles, tile_groups_x, tile_groups_y,
           tile_groups_z, padding, sample_groups_x, sample_groups_y, sample_groups_z, samples),
    STRUCT(SweepWork, rounds, entries, lost, padding_1, padding_2),
    STRUCT(SweepConstants, strip, position, ids, planes, board, shafts, work, entries, visibility, exact, round,
           spare_entry, tiles, plane, diodes, rank_bins),
    STRUCT(SweepPlanes, first_hi, first_lo, second_hi, second_lo),
    STRUCT(Piercer, plane_hi, plane_lo, diodes),
    STRUCT(AccumulateConstants, position, surface, backscatter, sum, run, diodes, tones, diagrams, visibility,
           terms, list, blocks, plane, padded_pixels, adds_terms, columns, samples),
    STRUCT(DepthSumConstants, grid, chip, records, planes, sum, run, diodes, tones, diagrams, blocks,
           plane, samples, is_first, visibility, blocks_of_list),
    STRUCT(PointPolynomials, axis, per_metre, unit_m, unit_m2, padding),
    STRUCT(DirectPixels, channels, shapes, surfaces, lit, errors, backscatter, padding),
    STRUCT(ClaimsConstants, errors, violations, later, pixels, plane, tones, padding),
    STRUCT(DepthDemodulationConstants, grid, chip, records, planes, sum, channels,
           errors, frequency, shapes, surfaces, lit, pixels, padded_pixels, plane, backscatter),
    STRUCT(DemodulationConstants, position, sum, ids, planes, channels, frequency, lit, terms,
           violations, list, later, columns, samples, padded_pixels, pixels, plane, lit_channel, diodes),
    STRUCT(PixelList, sample_groups_x, sample_groups_y, sample_groups_z, pixel_groups_x, pixel_groups_y,
           pixel_groups_z, count, padding),
    STRUCT(PixelListConstants, lists, samples),
    STRUCT(UniformPixelsLight, middle_m, extent_m, diagrams, pattern_slope, spread_m, wavenumber,
           point_spread_m, padding_1, padding_2, tones, frequencies),
    STRUCT(UniformPixelsWork, lists, violations, lit_channel, diodes),
    STRUCT(UniformPixelsConstants, strip, slope, chip, ids, planes, shapes, surfaces, lit, light, diodes,
           channels, work),
};
// clang-format on

} // namespace

TEST_CASE("shaders and host lay every shared struct out alike") {
  std::set<std::string> seen;
  for (const ShaderModule &module : shader_modules())
    for (const StructLayout &layout : struct_layouts(module.spirv)) {
      INFO(module.name << ": " << layout.name);
      REQUIRE(host_layouts.contains(layout.name));
      const HostLayout &expected = host_layouts.at(layout.name);
      CHECK(layout.members == expected.members);
      if (layout.array_stride != 0)
        CHECK(layout.array_stride == expected.bytes);
      seen.insert(layout.name);
    }
  CHECK(seen.size() == host_layouts.size());
}

TEST_CASE("a raster's vertex is the vec3 and the uint that the vertex shader takes") {
  CHECK(offsetof(RasterVertex, x_fragments) == 0);
  CHECK(offsetof(RasterVertex, y_fragments) == 4);
  CHECK(offsetof(RasterVertex, inverse_depth) == 8);
  CHECK(offsetof(RasterVertex, triangle) == 12);
}

TEST_CASE("what breaks a promise, and what is kept, are the five words that the shaders keep") {
  CHECK(offsetof(BudgetViolations, returns) == 0);
  CHECK(offsetof(BudgetViolations, worst_m) == 4);
  CHECK(offsetof(BudgetViolations, amplitude) == 8);
  CHECK(offsetof(BudgetViolations, kept_m) == 12);
  CHECK(offsetof(BudgetViolations, kept_amplitude) == 16);
}
