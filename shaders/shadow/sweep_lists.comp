#version 460
// Lists the items that may stand between a tile's samples and the board. A workgroup is a subgroup, an invocation a tile: they go
// through the tree together, breadth first, an invocation a box, and then each tests every item that is left for its own tile.
// The first run counts, so that each list has its place; the second one writes.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/sweep.glsl"

layout(local_size_x_id = constant_lanes) in;
layout(constant_id = constant_is_first) const uint is_first = 1;
layout(constant_id = constant_lists_hidden) const uint lists_hidden = 0; // triangles, in place of edges

const uint boxes_of_root = tree_width;                     // taken at a time
const uint most_1 = tree_width * boxes_of_root, most_0 = tree_width * most_1;
shared uint boxes_1[most_1 + 1], boxes_0[most_0 + 1];
const uint most_items = 512; // of a segment
shared uint found[most_items + 1];

// Neighbouring tiles of the frame, four beside each other.
uint tile_of_invocation() {
  uvec2 tiles = tiles_of(constants.strip);
  const uint wide = 4u, high = lanes / wide;
  uvec2 groups = (tiles + uvec2(wide, high) - 1u) / uvec2(wide, high);
  uint of_subsample = groups.x * groups.y;
  uint group = interleaved(gl_WorkGroupID.x, gl_NumWorkGroups.x);
  uint subsample = group / of_subsample, within = group % of_subsample;
  uvec2 at = uvec2(within % groups.x, within / groups.x) * uvec2(wide, high) + uvec2(lane() % wide, lane() / wide);
  return at.x < tiles.x && at.y < tiles.y ? subsample * tiles.x * tiles.y + at.y * tiles.x + at.x : constants.tiles;
}

// The ways from some tiles' samples to the board and to the lens.
struct Outlook {
  Ways ways;
  Sights sights;
};

Outlook outlook_of(TileShaft shaft, SweepBoard board) {
  Sights sights = sights_of(shaft.sights_a, shaft.sights_b, shaft.low.xyz, shaft.high.xyz, board.lens_z);
  if (shaft.high.w == 0.0)
    return Outlook(ways_of(shaft.slopes_a, shaft.slopes_b, shaft.low.xyz, shaft.high.xyz, board), sights);
  sights.slopes_a = sights.slopes_b = vec4(0.0);
  sights.anywhere = 1e30;
  return Outlook(ways_anywhere(shaft.low.xyz, shaft.high.xyz, board), sights);
}

bool meets_box(Outlook of, uint level_first, uint box) {
  int at = int(2u * (level_first + box));
  vec3 low = texelFetch(box_texels, at).xyz, high = texelFetch(box_texels, at + 1).xyz;
  return lists_hidden != 0 ? may_cross(of.sights, low, high) : may_meet_box(of.ways, low, high);
}

bool is_concerned(Outlook of, Item item) { return lists_hidden != 0 ? may_hide(of.sights, item) : may_matter(of.ways, item); }

uint listed; // items of this invocation's tile so far
uint first_entry;
bool writes;

// Tests the segment's items, an invocation for its own tile, and lists them.
void list_items(uint count, Outlook own) {
  Words entries = Words(constants.entries);
  for (uint i = 0; i < count; i += gl_SubgroupSize) {
    uint index = found[min(i + lane(), count - 1u)];
    Item item = load_item(index);
    for (uint j = 0; j < lanes; j += 8u)
      [[unroll]] for (uint k = j; k < j + 8u; ++k) {
        Item one = Item(subgroupShuffle(item.a, k), subgroupShuffle(item.b, k), subgroupShuffle(item.first, k), subgroupShuffle(item.second, k));
        uint of_one = subgroupShuffle(index, k);
        bool is_listed = i + k < count && is_concerned(own, one);
        if (is_first == 0) // an unconditional store costs a fourth of a conditional one on lavapipe
          entries.at[is_listed && writes ? first_entry + listed : constants.spare_entry] = of_one;
        listed += is_listed ? 1u : 0u;
      }
  }
}

// Makes room for both lists of a tile, and finds a place among the tiles of a round.
void make_room(SweepLists lists, uint tile, bool is_shaded) {
  uint hidden = lists.list[length_at(list_hidden, tile)];
  uint place = listed + hidden > 0u ? atomicAdd(lists.at.entries, listed + hidden) : 0u, round_ = round_of(place);
  lists.list[place_at(list_edges, tile)] = place;
  lists.list[place_at(list_hidden, tile)] = place + listed;
  if (listed + hidden == 0u && !is_shaded)
    return;
  if (round_ == sweep_rounds) {
    atomicMax(lists.at.lost, 1u);
    return;
  }
  uint entry = atomicAdd(lists.at.rounds[round_].tiles, 1u);
  lists.list[active_at(round_, entry)] = tile;
  atomicMax(lists.at.rounds[round_].list_groups_x, gl_NumWorkGroups.x);
  atomicMax(lists.at.rounds[round_].tile_groups_y, min(entry + 1u, workgroups_per_row));
  atomicMax(lists.at.rounds[round_].tile_groups_z, entry / workgroups_per_row + 1u);
}

void main() {
  SweepBoard board = Boards(constants.board).at;
  uint tile = tile_of_invocation();
  bool is_there = tile < constants.tiles;
  TileShaft shaft = Shafts(constants.shafts).at[is_there ? tile : 0u];
  if (!is_there)
    shaft = TileShaft(vec4(-1e9), vec4(-1e9), vec4(-1e9), vec4(-1e9), vec4(1e9, 1e9, 1e9, 0.0), vec4(-1e9, -1e9, -1e9, 0.0));
  Outlook own = outlook_of(shaft, board);
  Outlook all = outlook_of(TileShaft(subgroupMax(shaft.slopes_a), subgroupMax(shaft.slopes_b), subgroupMax(shaft.sights_a),
                                     subgroupMax(shaft.sights_b), subgroupMin(shaft.low), subgroupMax(shaft.high)), board);
  if (shaft.low.x > shaft.high.x) { // nothing is seen
    own.ways.farthest = own.sights.low.z = 1e30;
    own.sights.anywhere = 0.0;
  }
  listed = 0u;
  SweepLists lists = SweepLists(constants.work);
  uint place = is_first == 0 && is_there ? lists.list[place_at(lists_hidden, tile)] : 0u;
  // Both lists of a tile belong to the round of its edges.
  uint round_ = is_first == 0 && is_there ? round_of(lists.list[place_at(list_edges, tile)]) : sweep_rounds;
  first_entry = place - constants.round * entries_per_round;
  writes = is_there && round_ == constants.round;
  if (is_first == 0 && !subgroupAny(writes))
    return;

  uint steps = 0u;
  for (uint root = 0; root < board.level_count[2] && steps < most_steps; root += boxes_of_root) {
    steps += 16u;
    uint hits = subgroupBallot(lane() < boxes_of_root && root + lane() < board.level_count[2] && meets_box(all, board.level_first[2], root + lane())).x;
    uint count_1 = 0u, count_0 = 0u, count = 0u;
    for (; hits != 0u; hits &= hits - 1u) {
      uint box = (root + findLSB(hits)) * tree_width + lane();
      bool meets = lane() < tree_width && meets_box(all, board.level_first[1], box);
      uint met = subgroupBallot(meets).x;
      boxes_1[meets ? count_1 + bitCount(met & lanes_below()) : most_1] = box;
      count_1 += bitCount(met);
    }
    steps += 2u * count_1;
    for (uint i = 0; i < count_1; ++i) {
      uint box = boxes_1[i] * tree_width + lane();
      bool meets = lane() < tree_width && meets_box(all, board.level_first[0], box);
      uint met = subgroupBallot(meets).x;
      boxes_0[meets ? count_0 + bitCount(met & lanes_below()) : most_0] = box;
      count_0 += bitCount(met);
    }
    steps += 4u * count_0; // three of them of the items found
    for (uint i = 0; i < count_0; ++i) {
      uint index = boxes_0[i] * tree_width + lane();
      bool matters = lane() < tree_width && is_concerned(all, load_item(index));
      uint met = subgroupBallot(matters).x;
      found[matters ? count + bitCount(met & lanes_below()) : most_items] = index;
      count += bitCount(met);
      if (count > most_items - tree_width || i + 1u == count_0) {
        list_items(count, own);
        count = 0u;
      }
    }
  }
  if (is_first != 0 && steps >= most_steps)
    atomicMax(lists.at.lost, 1u);
  if (is_first == 0 || !is_there)
    return;
  lists.list[length_at(lists_hidden, tile)] = listed;
  if (lists_hidden == 0) // hidden triangles are counted before edges
    make_room(lists, tile, shaft.low.w != 0.0 || (board.leaves_none != 0u && shaft.low.x <= shaft.high.x));
}
