// shaders/shared/interface.h is read by GLSL and by C++: both must lay its structs out alike. Every member of
// every struct that a compiled shader carries is compared with the compiler's.

#include "shaders/shadow/lit_interface.h"
#include "spirv/accumulate_looped_double_float.h"
#include "spirv/accumulate_looped_fp64.h"
#include "spirv/accumulate_per_diode_looped_double_float.h"
#include "spirv/accumulate_per_diode_looped_fp64.h"
#include "spirv/accumulate_per_diode_straight_double_float.h"
#include "spirv/accumulate_per_diode_straight_fp64.h"
#include "spirv/accumulate_plain_looped_double_float.h"
#include "spirv/accumulate_plain_looped_fp64.h"
#include "spirv/accumulate_plain_straight_double_float.h"
#include "spirv/accumulate_plain_straight_fp64.h"
#include "spirv/accumulate_precise_looped_double_float.h"
#include "spirv/accumulate_precise_looped_fp64.h"
#include "spirv/accumulate_precise_straight_fp64.h"
#include "spirv/accumulate_straight_double_float.h"
#include "spirv/accumulate_straight_fp64.h"
#include "spirv/lit_clear_double_float.h"
#include "spirv/lit_clear_fp64.h"
#include "spirv/lit_count.h"
#include "spirv/lit_gather_double_float.h"
#include "spirv/lit_gather_fp64.h"
#include "spirv/lit_open.h"
#include "spirv/lit_tiles_double_float.h"
#include "spirv/lit_tiles_fp64.h"
#include "spirv/lit_trace_double_float.h"
#include "spirv/lit_trace_fp64.h"
#include "spirv/lit_try_double_float.h"
#include "spirv/lit_try_fp64.h"
#include "spirv/pixel_list_count.h"
#include "spirv/points_double_float.h"
#include "spirv/points_fp64.h"
#include "spirv/resolve_double_float.h"
#include "spirv/resolve_fp64.h"
#include "spirv/resolve_plain_double_float.h"
#include "spirv/resolve_plain_fp64.h"
#include "spirv/search_double_float.h"
#include "spirv/search_fp64.h"
#include "spirv/short_way_looped_double_float.h"
#include "spirv/short_way_looped_fp64.h"
#include "spirv/short_way_straight_double_float.h"
#include "spirv/short_way_straight_fp64.h"
#include "spirv/tags_double_float.h"
#include "spirv/tags_fp64.h"
#include "spirv/visibility_depth_frag_double_float.h"
#include "spirv/visibility_depth_frag_fp64.h"
#include "spirv/visibility_depth_masked_double_float.h"
#include "spirv/visibility_depth_masked_fp64.h"
#include "spirv/visibility_depth_vert_double_float.h"
#include "spirv/visibility_depth_vert_fp64.h"
#include "spirv/visibility_frag.h"
#include "spirv/visibility_keys_frag.h"
#include "spirv/visibility_keys_masked_double_float.h"
#include "spirv/visibility_keys_masked_fp64.h"
#include "spirv/visibility_masked_double_float.h"
#include "spirv/visibility_masked_fp64.h"
#include "spirv/visibility_vert.h"
#include "tests/architecture/spirv_layout.h"

#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace pmdsim::shader;
using namespace pmdsim::test;

namespace {

struct HostLayout {
  std::size_t bytes;
  std::vector<Member> members; // all of them: a shader's must be the same
};

#define MEMBER(Struct, member)                                                                               \
  { #member, offsetof(Struct, member), sizeof(Struct::member) }

const std::map<std::string, HostLayout> chip_and_lens{
    {"ChipPlace",
     {sizeof(ChipPlace),
      {MEMBER(ChipPlace, origin_hi), MEMBER(ChipPlace, origin_lo), MEMBER(ChipPlace, half_column_hi),
       MEMBER(ChipPlace, half_column_lo), MEMBER(ChipPlace, half_row_hi), MEMBER(ChipPlace, half_row_lo),
       MEMBER(ChipPlace, half_step_x_hi), MEMBER(ChipPlace, half_step_x_lo),
       MEMBER(ChipPlace, half_step_y_hi), MEMBER(ChipPlace, half_step_y_lo)}}},
    {"LensModel",
     {sizeof(LensModel),
      {MEMBER(LensModel, chip), MEMBER(LensModel, radial_hi), MEMBER(LensModel, radial_lo),
       MEMBER(LensModel, tangential), MEMBER(LensModel, guesses_per_radius), MEMBER(LensModel, padding_1),
       MEMBER(LensModel, padding_2), MEMBER(LensModel, padding_3)}}},
    {"RasterView",
     {sizeof(RasterView),
      {MEMBER(RasterView, x), MEMBER(RasterView, y), MEMBER(RasterView, z), MEMBER(RasterView, columns),
       MEMBER(RasterView, rows), MEMBER(RasterView, padding_1), MEMBER(RasterView, padding_2)}}},
};

const std::map<std::string, HostLayout> scene_and_light{
    {"TrianglePlane",
     {sizeof(TrianglePlane),
      {MEMBER(TrianglePlane, plane_hi), MEMBER(TrianglePlane, plane_lo), MEMBER(TrianglePlane, backscatter),
       MEMBER(TrianglePlane, object), MEMBER(TrianglePlane, along_min), MEMBER(TrianglePlane, along_max)}}},
    {"ShapePaint",
     {sizeof(ShapePaint),
      {MEMBER(ShapePaint, origin_hi), MEMBER(ShapePaint, origin_lo), MEMBER(ShapePaint, s_hi),
       MEMBER(ShapePaint, s_lo), MEMBER(ShapePaint, t_hi), MEMBER(ShapePaint, t_lo), MEMBER(ShapePaint, red),
       MEMBER(ShapePaint, green), MEMBER(ShapePaint, blue), MEMBER(ShapePaint, alpha),
       MEMBER(ShapePaint, surface), MEMBER(ShapePaint, padding_1), MEMBER(ShapePaint, padding_2),
       MEMBER(ShapePaint, padding_3)}}},
    {"SurfacePaint",
     {sizeof(SurfacePaint),
      {MEMBER(SurfacePaint, backscatter), MEMBER(SurfacePaint, texels), MEMBER(SurfacePaint, columns),
       MEMBER(SurfacePaint, rows), MEMBER(SurfacePaint, wrap_u), MEMBER(SurfacePaint, wrap_v),
       MEMBER(SurfacePaint, filtering), MEMBER(SurfacePaint, alpha), MEMBER(SurfacePaint, alpha_cutoff),
       MEMBER(SurfacePaint, padding_1), MEMBER(SurfacePaint, padding_2), MEMBER(SurfacePaint, padding_3)}}},
    {"BlockPlane",
     {sizeof(BlockPlane),
      {MEMBER(BlockPlane, x_hi), MEMBER(BlockPlane, x_lo), MEMBER(BlockPlane, y_hi), MEMBER(BlockPlane, y_lo),
       MEMBER(BlockPlane, corner_hi), MEMBER(BlockPlane, corner_lo)}}},
    {"TriangleCorners",
     {sizeof(TriangleCorners),
      {MEMBER(TriangleCorners, hi), MEMBER(TriangleCorners, lo), MEMBER(TriangleCorners, beyond),
       MEMBER(TriangleCorners, padding)}}},
    {"GroupDiode",
     {sizeof(GroupDiode),
      {MEMBER(GroupDiode, position), MEMBER(GroupDiode, axis), MEMBER(GroupDiode, intensity),
       MEMBER(GroupDiode, order), MEMBER(GroupDiode, diagram), MEMBER(GroupDiode, theta_steps),
       MEMBER(GroupDiode, first_theta), MEMBER(GroupDiode, theta_steps_per_rad),
       MEMBER(GroupDiode, row_length), MEMBER(GroupDiode, padding), MEMBER(GroupDiode, across)}}},
    {"PreciseDiode",
     {sizeof(PreciseDiode),
      {MEMBER(PreciseDiode, rounded), MEMBER(PreciseDiode, position_rest), MEMBER(PreciseDiode, axis_rest),
       MEMBER(PreciseDiode, intensity_rest), MEMBER(PreciseDiode, order_rest),
       MEMBER(PreciseDiode, padding_1), MEMBER(PreciseDiode, padding_2)}}},
    {"Tone", {sizeof(Tone), {MEMBER(Tone, turns_per_m), MEMBER(Tone, wavenumber), MEMBER(Tone, harmonic)}}},
    {"LightRun",
     {sizeof(LightRun),
      {MEMBER(LightRun, reference_hi), MEMBER(LightRun, reference_lo), MEMBER(LightRun, phase_turns),
       MEMBER(LightRun, radius_m), MEMBER(LightRun, intensity), MEMBER(LightRun, heights),
       MEMBER(LightRun, diagrams), MEMBER(LightRun, rims), MEMBER(LightRun, rim_root),
       MEMBER(LightRun, detours), MEMBER(LightRun, moments_of_powers)}}},
    {"Frequency",
     {sizeof(Frequency),
      {MEMBER(Frequency, turns_per_m), MEMBER(Frequency, ambiguity_m), MEMBER(Frequency, below),
       MEMBER(Frequency, amplitude_scale), MEMBER(Frequency, first_channel), MEMBER(Frequency, limit_m),
       MEMBER(Frequency, fixed_m), MEMBER(Frequency, per_condition_m), MEMBER(Frequency, amplitude_limit),
       MEMBER(Frequency, amplitude_fixed), MEMBER(Frequency, amplitude_per_condition),
       MEMBER(Frequency, padding_1), MEMBER(Frequency, padding_2)}}},
};

const std::map<std::string, HostLayout> constants_until_points{
    {"SampleGrid",
     {sizeof(SampleGrid),
      {MEMBER(SampleGrid, slope), MEMBER(SampleGrid, first), MEMBER(SampleGrid, columns),
       MEMBER(SampleGrid, inverse_columns)}}},
    {"Strip",
     {sizeof(Strip),
      {MEMBER(Strip, column), MEMBER(Strip, row), MEMBER(Strip, columns), MEMBER(Strip, rows),
       MEMBER(Strip, resolution_x), MEMBER(Strip, resolution_y), MEMBER(Strip, samples),
       MEMBER(Strip, padded_pixels)}}},
    {"VisibilityConstants",
     {sizeof(VisibilityConstants),
      {MEMBER(VisibilityConstants, shift),
       MEMBER(VisibilityConstants, tile_x),
       MEMBER(VisibilityConstants, tile_y),
       MEMBER(VisibilityConstants, column),
       MEMBER(VisibilityConstants, row),
       MEMBER(VisibilityConstants, resolution_x),
       MEMBER(VisibilityConstants, fragments_per_pixel_side),
       MEMBER(VisibilityConstants, sample_shift),
       MEMBER(VisibilityConstants, block_x),
       MEMBER(VisibilityConstants, block_y),
       MEMBER(VisibilityConstants, block),
       MEMBER(VisibilityConstants, planes),
       MEMBER(VisibilityConstants, shapes),
       MEMBER(VisibilityConstants, surfaces),
       MEMBER(VisibilityConstants, tags),
       MEMBER(VisibilityConstants, tag_columns),
       MEMBER(VisibilityConstants, tag_stride),
       MEMBER(VisibilityConstants, slope),
       MEMBER(VisibilityConstants, first),
       MEMBER(VisibilityConstants, chip)}}},
    {"TagsConstants",
     {sizeof(TagsConstants),
      {MEMBER(TagsConstants, grid), MEMBER(TagsConstants, chip), MEMBER(TagsConstants, planes),
       MEMBER(TagsConstants, tags), MEMBER(TagsConstants, fragments), MEMBER(TagsConstants, tile_columns),
       MEMBER(TagsConstants, tile_rows), MEMBER(TagsConstants, column), MEMBER(TagsConstants, row),
       MEMBER(TagsConstants, resolution_x), MEMBER(TagsConstants, fragments_per_pixel_side),
       MEMBER(TagsConstants, padding)}}},
    {"PointsConstants",
     {sizeof(PointsConstants),
      {MEMBER(PointsConstants, strip), MEMBER(PointsConstants, slope), MEMBER(PointsConstants, chip),
       MEMBER(PointsConstants, tags), MEMBER(PointsConstants, planes), MEMBER(PointsConstants, position),
       MEMBER(PointsConstants, surface), MEMBER(PointsConstants, backscatter),
       MEMBER(PointsConstants, shapes), MEMBER(PointsConstants, surfaces), MEMBER(PointsConstants, list)}}},
    {"SearchConstants",
     {sizeof(SearchConstants),
      {MEMBER(SearchConstants, strip), MEMBER(SearchConstants, lens), MEMBER(SearchConstants, view),
       MEMBER(SearchConstants, fragments), MEMBER(SearchConstants, planes), MEMBER(SearchConstants, corners),
       MEMBER(SearchConstants, tags), MEMBER(SearchConstants, position), MEMBER(SearchConstants, surface),
       MEMBER(SearchConstants, backscatter), MEMBER(SearchConstants, shapes),
       MEMBER(SearchConstants, surfaces)}}},
};

const std::map<std::string, HostLayout> shadows{
    {"Occluder",
     {sizeof(Occluder),
      {MEMBER(Occluder, plane_hi), MEMBER(Occluder, plane_lo), MEMBER(Occluder, a_hi), MEMBER(Occluder, b_hi),
       MEMBER(Occluder, c_hi), MEMBER(Occluder, a_lo), MEMBER(Occluder, b_lo), MEMBER(Occluder, c_lo),
       MEMBER(Occluder, id), MEMBER(Occluder, edges), MEMBER(Occluder, may_be_absent),
       MEMBER(Occluder, body)}}},
    {"TreeNode",
     {sizeof(TreeNode),
      {MEMBER(TreeNode, low_x), MEMBER(TreeNode, low_y), MEMBER(TreeNode, low_z), MEMBER(TreeNode, skip),
       MEMBER(TreeNode, high_x), MEMBER(TreeNode, high_y), MEMBER(TreeNode, high_z),
       MEMBER(TreeNode, occluder)}}},
    {"DiodeBox", {sizeof(DiodeBox), {MEMBER(DiodeBox, low), MEMBER(DiodeBox, high)}}},
    {"BundleDiodes",
     {sizeof(BundleDiodes),
      {MEMBER(BundleDiodes, centre), MEMBER(BundleDiodes, extent), MEMBER(BundleDiodes, places)}}},
    {"TilePart",
     {sizeof(TilePart),
      {MEMBER(TilePart, low), MEMBER(TilePart, high), MEMBER(TilePart, nearest_m),
       MEMBER(TilePart, farthest_m), MEMBER(TilePart, own), MEMBER(TilePart, body),
       MEMBER(TilePart, own_ids)}}},
    {"Dispatch",
     {sizeof(Dispatch),
      {MEMBER(Dispatch, x), MEMBER(Dispatch, y), MEMBER(Dispatch, z), MEMBER(Dispatch, count)}}},
    {"LitWork", {sizeof(LitWork), {MEMBER(LitWork, list)}}},
    {"LitScene",
     {sizeof(LitScene),
      {MEMBER(LitScene, planes), MEMBER(LitScene, occluders), MEMBER(LitScene, tree),
       MEMBER(LitScene, bodies), MEMBER(LitScene, shapes), MEMBER(LitScene, surfaces),
       MEMBER(LitScene, nodes), MEMBER(LitScene, world_rounding)}}},
};

const std::map<std::string, HostLayout> constants_of_shadows{
    {"LitTilesConstants",
     {sizeof(LitTilesConstants),
      {MEMBER(LitTilesConstants, strip), MEMBER(LitTilesConstants, position), MEMBER(LitTilesConstants, tags),
       MEMBER(LitTilesConstants, scene), MEMBER(LitTilesConstants, parts)}}},
    {"LitGatherConstants",
     {sizeof(LitGatherConstants),
      {MEMBER(LitGatherConstants, strip), MEMBER(LitGatherConstants, position),
       MEMBER(LitGatherConstants, tags), MEMBER(LitGatherConstants, parts), MEMBER(LitGatherConstants, scene),
       MEMBER(LitGatherConstants, boxes), MEMBER(LitGatherConstants, work),
       MEMBER(LitGatherConstants, candidates), MEMBER(LitGatherConstants, part_count),
       MEMBER(LitGatherConstants, bundle), MEMBER(LitGatherConstants, slots)}}},
    {"LitDecideConstants",
     {sizeof(LitDecideConstants),
      {MEMBER(LitDecideConstants, strip), MEMBER(LitDecideConstants, position),
       MEMBER(LitDecideConstants, tags), MEMBER(LitDecideConstants, parts), MEMBER(LitDecideConstants, scene),
       MEMBER(LitDecideConstants, diodes), MEMBER(LitDecideConstants, work),
       MEMBER(LitDecideConstants, candidates), MEMBER(LitDecideConstants, reached),
       MEMBER(LitDecideConstants, bundle), MEMBER(LitDecideConstants, part_count),
       MEMBER(LitDecideConstants, slots), MEMBER(LitDecideConstants, first_node),
       MEMBER(LitDecideConstants, last_node)}}},
    {"LitCountConstants",
     {sizeof(LitCountConstants),
      {MEMBER(LitCountConstants, reached), MEMBER(LitCountConstants, diodes), MEMBER(LitCountConstants, lit),
       MEMBER(LitCountConstants, plane)}}},
};

const std::map<std::string, HostLayout> constants_of_the_sum{
    {"AccumulateConstants",
     {sizeof(AccumulateConstants),
      {MEMBER(AccumulateConstants, position), MEMBER(AccumulateConstants, surface),
       MEMBER(AccumulateConstants, backscatter), MEMBER(AccumulateConstants, sum),
       MEMBER(AccumulateConstants, run), MEMBER(AccumulateConstants, diodes),
       MEMBER(AccumulateConstants, tones), MEMBER(AccumulateConstants, diagrams),
       MEMBER(AccumulateConstants, reached), MEMBER(AccumulateConstants, terms),
       MEMBER(AccumulateConstants, list), MEMBER(AccumulateConstants, blocks),
       MEMBER(AccumulateConstants, plane), MEMBER(AccumulateConstants, padded_pixels),
       MEMBER(AccumulateConstants, adds_terms)}}},
    {"PlainSumConstants",
     {sizeof(PlainSumConstants),
      {MEMBER(PlainSumConstants, grid), MEMBER(PlainSumConstants, chip), MEMBER(PlainSumConstants, records),
       MEMBER(PlainSumConstants, planes), MEMBER(PlainSumConstants, sum), MEMBER(PlainSumConstants, run),
       MEMBER(PlainSumConstants, diodes), MEMBER(PlainSumConstants, tones),
       MEMBER(PlainSumConstants, diagrams), MEMBER(PlainSumConstants, blocks),
       MEMBER(PlainSumConstants, plane), MEMBER(PlainSumConstants, samples),
       MEMBER(PlainSumConstants, is_first)}}},
    {"PlainResolveConstants",
     {sizeof(PlainResolveConstants),
      {MEMBER(PlainResolveConstants, grid), MEMBER(PlainResolveConstants, chip),
       MEMBER(PlainResolveConstants, records), MEMBER(PlainResolveConstants, planes),
       MEMBER(PlainResolveConstants, sum), MEMBER(PlainResolveConstants, channels),
       MEMBER(PlainResolveConstants, harmonics), MEMBER(PlainResolveConstants, frequency),
       MEMBER(PlainResolveConstants, shapes), MEMBER(PlainResolveConstants, surfaces),
       MEMBER(PlainResolveConstants, pixels), MEMBER(PlainResolveConstants, padded_pixels),
       MEMBER(PlainResolveConstants, plane), MEMBER(PlainResolveConstants, backscatter)}}},
    {"ResolveConstants",
     {sizeof(ResolveConstants),
      {MEMBER(ResolveConstants, position), MEMBER(ResolveConstants, sum), MEMBER(ResolveConstants, tags),
       MEMBER(ResolveConstants, planes), MEMBER(ResolveConstants, channels),
       MEMBER(ResolveConstants, harmonics), MEMBER(ResolveConstants, frequency),
       MEMBER(ResolveConstants, lit), MEMBER(ResolveConstants, terms), MEMBER(ResolveConstants, broken),
       MEMBER(ResolveConstants, list), MEMBER(ResolveConstants, columns), MEMBER(ResolveConstants, samples),
       MEMBER(ResolveConstants, padded_pixels), MEMBER(ResolveConstants, pixels),
       MEMBER(ResolveConstants, plane), MEMBER(ResolveConstants, lit_channel),
       MEMBER(ResolveConstants, diodes)}}},
};

const std::map<std::string, HostLayout> short_way{
    {"PixelList",
     {sizeof(PixelList),
      {MEMBER(PixelList, sample_groups_x), MEMBER(PixelList, sample_groups_y),
       MEMBER(PixelList, sample_groups_z), MEMBER(PixelList, pixel_groups_x),
       MEMBER(PixelList, pixel_groups_y), MEMBER(PixelList, pixel_groups_z), MEMBER(PixelList, count),
       MEMBER(PixelList, padding)}}},
    {"PixelListConstants",
     {sizeof(PixelListConstants), {MEMBER(PixelListConstants, lists), MEMBER(PixelListConstants, samples)}}},
    {"ShortWayLight",
     {sizeof(ShortWayLight),
      {MEMBER(ShortWayLight, middle_m), MEMBER(ShortWayLight, extent_m), MEMBER(ShortWayLight, diagrams),
       MEMBER(ShortWayLight, pattern_slope), MEMBER(ShortWayLight, spread_m),
       MEMBER(ShortWayLight, wavenumber), MEMBER(ShortWayLight, place_spread_m),
       MEMBER(ShortWayLight, padding_1), MEMBER(ShortWayLight, padding_2), MEMBER(ShortWayLight, tones),
       MEMBER(ShortWayLight, frequencies)}}},
    {"ShortWayWork",
     {sizeof(ShortWayWork),
      {MEMBER(ShortWayWork, lists), MEMBER(ShortWayWork, lit_channel), MEMBER(ShortWayWork, diodes)}}},
    {"ShortWayConstants",
     {sizeof(ShortWayConstants),
      {MEMBER(ShortWayConstants, strip), MEMBER(ShortWayConstants, slope), MEMBER(ShortWayConstants, chip),
       MEMBER(ShortWayConstants, tags), MEMBER(ShortWayConstants, planes), MEMBER(ShortWayConstants, shapes),
       MEMBER(ShortWayConstants, surfaces), MEMBER(ShortWayConstants, lit), MEMBER(ShortWayConstants, light),
       MEMBER(ShortWayConstants, diodes), MEMBER(ShortWayConstants, channels),
       MEMBER(ShortWayConstants, work)}}},
};

std::map<std::string, HostLayout> host_layouts() {
  std::map<std::string, HostLayout> all;
  for (const auto &some : {chip_and_lens, scene_and_light, shadows, constants_until_points,
                           constants_of_shadows, constants_of_the_sum, short_way})
    all.insert(some.begin(), some.end());
  return all;
}

struct Shader {
  std::string name;
  std::span<const std::uint32_t> spirv;
};

const std::vector<Shader> shaders{
    {"id_raster.vert", visibility_vert_spirv},
    {"id_raster.frag", visibility_frag_spirv},
    {"id_raster.vert, depths, fp64", visibility_depth_vert_fp64_spirv},
    {"id_raster.vert, depths, float pairs", visibility_depth_vert_double_float_spirv},
    {"id_raster_depth.frag, fp64", visibility_depth_frag_fp64_spirv},
    {"id_raster_depth.frag, float pairs", visibility_depth_frag_double_float_spirv},
    {"id_raster_depth.frag, masked, fp64", visibility_depth_masked_fp64_spirv},
    {"id_raster_depth.frag, masked, float pairs", visibility_depth_masked_double_float_spirv},
    {"id_raster_masked.frag, fp64", visibility_masked_fp64_spirv},
    {"id_raster_masked.frag, float pairs", visibility_masked_double_float_spirv},
    {"id_raster.frag, keys", visibility_keys_frag_spirv},
    {"id_raster_masked.frag, keys, fp64", visibility_keys_masked_fp64_spirv},
    {"id_raster_masked.frag, keys, float pairs", visibility_keys_masked_double_float_spirv},
    {"tags, fp64", tags_fp64_spirv},
    {"tags, float pairs", tags_double_float_spirv},
    {"points, fp64", points_fp64_spirv},
    {"points, float pairs", points_double_float_spirv},
    {"search, fp64", search_fp64_spirv},
    {"search, float pairs", search_double_float_spirv},
    {"lit_tiles, fp64", lit_tiles_fp64_spirv},
    {"lit_tiles, float pairs", lit_tiles_double_float_spirv},
    {"lit_open", lit_open_spirv},
    {"lit_gather, fp64", lit_gather_fp64_spirv},
    {"lit_gather, float pairs", lit_gather_double_float_spirv},
    {"lit_try, fp64", lit_try_fp64_spirv},
    {"lit_try, float pairs", lit_try_double_float_spirv},
    {"lit_clear, fp64", lit_clear_fp64_spirv},
    {"lit_clear, float pairs", lit_clear_double_float_spirv},
    {"lit_trace, fp64", lit_trace_fp64_spirv},
    {"lit_trace, float pairs", lit_trace_double_float_spirv},
    {"lit_count", lit_count_spirv},
    {"accumulate, straight, fp64", accumulate_straight_fp64_spirv},
    {"accumulate, straight, float pairs", accumulate_straight_double_float_spirv},
    {"accumulate, looped, fp64", accumulate_looped_fp64_spirv},
    {"accumulate, looped, float pairs", accumulate_looped_double_float_spirv},
    {"accumulate plain, straight, fp64", accumulate_plain_straight_fp64_spirv},
    {"accumulate plain, straight, float pairs", accumulate_plain_straight_double_float_spirv},
    {"accumulate plain, looped, fp64", accumulate_plain_looped_fp64_spirv},
    {"accumulate plain, looped, float pairs", accumulate_plain_looped_double_float_spirv},
    {"accumulate precise, straight, fp64", accumulate_precise_straight_fp64_spirv},
    {"accumulate precise, looped, fp64", accumulate_precise_looped_fp64_spirv},
    {"accumulate precise, looped, float pairs", accumulate_precise_looped_double_float_spirv},
    {"accumulate direct, straight, fp64", accumulate_per_diode_straight_fp64_spirv},
    {"accumulate direct, straight, float pairs", accumulate_per_diode_straight_double_float_spirv},
    {"accumulate direct, looped, fp64", accumulate_per_diode_looped_fp64_spirv},
    {"accumulate direct, looped, float pairs", accumulate_per_diode_looped_double_float_spirv},
    {"short way, straight, fp64", short_way_straight_fp64_spirv},
    {"short way, straight, float pairs", short_way_straight_double_float_spirv},
    {"short way, looped, fp64", short_way_looped_fp64_spirv},
    {"short way, looped, float pairs", short_way_looped_double_float_spirv},
    {"pixel_list_count", pixel_list_count_spirv},
    {"resolve, fp64", resolve_fp64_spirv},
    {"resolve, float pairs", resolve_double_float_spirv},
    {"resolve plain, fp64", resolve_plain_fp64_spirv},
    {"resolve plain, float pairs", resolve_plain_double_float_spirv},
};

} // namespace

TEST_CASE("shaders and host lay every shared struct out alike") {
  const auto host = host_layouts();
  std::set<std::string> seen;
  for (const Shader &shader : shaders)
    for (const StructLayout &layout : struct_layouts(shader.spirv)) {
      INFO(shader.name << ": " << layout.name);
      REQUIRE(host.contains(layout.name));
      const HostLayout &expected = host.at(layout.name);
      CHECK(layout.members == expected.members);
      if (layout.array_stride != 0)
        CHECK(layout.array_stride == expected.bytes);
      seen.insert(layout.name);
    }
  CHECK(seen.size() == host.size());
}

TEST_CASE("a raster's vertex is the vec3 and the uint that the vertex shader takes") {
  CHECK(offsetof(RasterVertex, x_fragments) == 0);
  CHECK(offsetof(RasterVertex, y_fragments) == 4);
  CHECK(offsetof(RasterVertex, inverse_depth) == 8);
  CHECK(offsetof(RasterVertex, triangle) == 12);
}

TEST_CASE("what breaks a promise is the three words that the shaders keep") {
  CHECK(offsetof(BrokenPromise, returns) == 0);
  CHECK(offsetof(BrokenPromise, worst_m) == 4);
  CHECK(offsetof(BrokenPromise, amplitude) == 8);
}
