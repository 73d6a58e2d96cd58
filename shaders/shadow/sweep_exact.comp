#version 460
// Decides what sweep.comp left unclear: any sample, and diodes anywhere. The triangle of sample, lens and diode is tested with every
// edge that may matter; where a float may be wrong, in Real. A workgroup is a subgroup: a sample and,
// where its list is long, a bundle of diodes.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/sweep.glsl"
#include "shaders/shadow/sweep_weight.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Piercers { Piercer at[]; };
layout(local_size_x_id = constant_lanes) in;

const uint most_items = 512;      // of a segment
const uint longest_for_all = 400; // of a tile's list, for one workgroup to do all diodes
shared uint kept[most_items + 1];
shared int weights[most_items + 1];
shared int surfaces[bundles_per_window * 32u]; // before each diode

// Six times the volume of the tetrahedron of the origin and three points.
Real volume(Real3 a, Real3 b, Real3 c) { return dot3(cross3(a, b), c); }
float volume(vec3 a, vec3 b, vec3 c) {
  precise float v = dot(cross(a, b), c);
  return v;
}
float size_of(vec3 a) { return abs(a.x) + abs(a.y) + abs(a.z); }

// The signs of the volumes that decide whether an edge crosses the triangle of sample, lens and diode.
struct Crossing {
  bool start, end;             // of the edge: on which side of the triangle's plane
  bool at_lens, at_diode, far; // on which side of the edge they lie; of the way from lens to diode
  bool unsure;
};

bool crosses(Crossing c) { return c.start != c.end && c.at_lens != c.at_diode && c.at_lens == c.far; }

// Edge a b, lens and diode relative to the sample.
Crossing cross_in_float(vec3 a, vec3 b, vec3 lens, vec3 diode) {
  const float rounding = 1e-6;
  float start = volume(lens, diode, a), end = volume(lens, diode, b), at_lens = volume(a, b, lens), at_diode = volume(a, b, diode);
  vec3 a_lens = a - lens, b_lens = b - lens, diode_lens = diode - lens;
  float far = volume(a_lens, b_lens, diode_lens);
  float size_a = size_of(a), size_b = size_of(b), size_lens = size_of(lens), size_diode = size_of(diode);
  float both = rounding * size_lens * size_diode, edge = rounding * size_a * size_b;
  bool unsure = abs(start) <= both * size_a || abs(end) <= both * size_b || abs(at_lens) <= edge * size_lens ||
                abs(at_diode) <= edge * size_diode ||
                abs(far) <= rounding * (size_a + size_lens) * (size_b + size_lens) * (size_diode + size_lens);
  return Crossing(start > 0.0, end > 0.0, at_lens > 0.0, at_diode > 0.0, far > 0.0, unsure);
}

Crossing cross_in_real(Real3 a, Real3 b, Real3 lens, Real3 diode) {
  Real far = volume(subtract3(a, lens), subtract3(b, lens), subtract3(diode, lens));
  return Crossing(high(volume(lens, diode, a)) > 0.0, high(volume(lens, diode, b)) > 0.0, high(volume(a, b, lens)) > 0.0,
                  high(volume(a, b, diode)) > 0.0, high(far) > 0.0, false);
}

// Counts the triangles between the sample and the lens that the lens does not see, an invocation a triangle.
int count_hidden(SweepLists lists, uint tile, Real3 point, Real3 lens, SweepBoard board) {
  uint length = lists.list[length_at(list_hidden, tile)], first = list_begin(lists, list_hidden, tile);
  int count = 0;
  for (uint i = 0; i < length; i += lanes) {
    Item item = load_hidden(Words(constants.entries).at[first + min(i + lane(), length - 1u)]);
    bool between = i + lane() < length && may_hide(floats(item.a) - high3(point), floats(item.b) - high3(point),
                                                   floats(item.first) - high3(point), high3(lens));
    bool unsure = between;
    while (subgroupAny(unsure)) { // a loop, because lavapipe takes both sides of a branch
      Real3 a = subtract3(real3(floats(item.a), rest_of(item.first.w, board.rest_step)), point);
      Real3 b = subtract3(real3(floats(item.b), rest_of(item.second.w, board.rest_step)), point);
      Real3 c = subtract3(real3(floats(item.first), rest_of(item.second.x, board.rest_step)), point);
      bool ab = high(volume(a, b, lens)) > 0.0, bc = high(volume(b, c, lens)) > 0.0, ca = high(volume(c, a, lens)) > 0.0;
      // The sample in front of it, the lens behind.
      Real3 normal = cross3(subtract3(b, a), subtract3(c, a));
      between = between && ab == bc && bc == ca && high(dot3(normal, a)) < 0.0 && high(dot3(normal, subtract3(lens, a))) < 0.0;
      unsure = false;
    }
    count += between ? 1 : 0;
  }
  return subgroupAdd(count);
}

// Finds the segment's items whose silhouettes count for the sample, an invocation an item: indices go to `kept`, what they
// count to `weights`.
uint keep_items(uint first, uint length, uint own, Ways ways, Real3 point, SweepBoard board) {
  uint met = 0u, count = 0u;
  for (uint i = 0; i < length; i += lanes) {
    uint index = Words(constants.entries).at[first + min(i + lane(), length - 1u)];
    Item item = load_item(index);
    bool matters = i + lane() < length && may_matter(ways, item) && item.a.w != own && item.b.w != own;
    uint ballot = subgroupBallot(matters).x;
    kept[matters ? met + bitCount(ballot & lanes_below()) : most_items] = index;
    met += bitCount(ballot);
  }
  for (uint i = 0; i < met; i += lanes) {
    uint index = kept[min(i + lane(), met - 1u)];
    Item item = load_item(index);
    int weight = exact_weight(index, item.first.w >> 30, item.second.w >> 30, item.b.w == item_boundary, point, board);
    bool counts = i + lane() < met && weight != 0;
    uint ballot = subgroupBallot(counts).x, to = counts ? count + bitCount(ballot & lanes_below()) : most_items;
    kept[to] = index;
    weights[to] = weight;
    count += bitCount(ballot);
  }
  return count;
}

// Puts right what sweep.comp stored.
void correct(uint bundle, uint i, uint reached, SweepBoard board) {
  Words words = Words(constants.visibility);
  uint at = bundle * constants.plane + i, shining = board.shining[bundle / 4u][bundle % 4u];
  Words(board.lit).at[i] += uint(bitCount(shining & reached) - bitCount(shining & words.at[at]));
  words.at[at] = reached;
}

void main() {
  SweepBoard board = Boards(constants.board).at;
  SweepLists lists = SweepLists(constants.work);
  if (entry_of_workgroup() >= lists.at.rounds[constants.round].samples)
    return;
  uint sample_ = lists.list[sample_at(entry_of_workgroup())], tile = sample_ / tile_samples;
  TileSample at = tile_sample(constants.strip, tile, sample_ % tile_samples);
  uint length = lists.list[length_at(list_edges, tile)], first = list_begin(lists, list_edges, tile);
  bool is_long = length > longest_for_all;
  if (!is_long && gl_WorkGroupID.x > 0u)
    return;
  uint begin = is_long ? diodes_per_bundle * gl_WorkGroupID.x : 0u, end = is_long ? begin + diodes_per_bundle : constants.diodes;
  // The turns of all loops, asked before any: a loop that is too long takes the others' turns.
  uint steps = lists.list[length_at(list_hidden, tile)] / 2u + (3u + board.piercer_count) * ((end - begin) / lanes + 2u);
  if (steps > most_steps) {
    atomicMax(lists.at.lost, 1u);
    return;
  }
  uint own = shape_seen(at);
  Real3 point = in_board_frame(point_of(at, board), board);
  vec4 slopes_a, slopes_b;
  slopes_of(high3(point), board, slopes_a, slopes_b);
  Ways ways = ways_anywhere(high3(point), high3(point), board);
  if (is_in_front(high3(point), board))
    ways = ways_of(slopes_a, slopes_b, high3(point), high3(point), board);
  Real3 lens = subtract3(Real3(real(0.0), real(0.0), real(board.lens_z)), point);

  int hidden = count_hidden(lists, tile, point, lens, board);
  for (uint d = begin + lane(); d < end; d += lanes)
    surfaces[d] = hidden;
  for (uint i = 0; i < board.piercer_count; ++i) {
    Piercer piercer = Piercers(board.piercers).at[i];
    int side = exact_side(piercer.plane_hi, piercer.plane_lo, point, board);
    for (uint d = begin + lane(); d < end; d += lanes)
      surfaces[d] += (piercer.diodes[d / 32u] >> d % 32u & 1u) != 0u ? side : 0;
  }
  for (uint segment = 0; segment < length; segment += most_items) {
    uint count = keep_items(first + segment, min(length - segment, most_items), own, ways, point, board);
    steps += most_items / 4u + 4u + count * (2u + 3u * (end - begin) / lanes);
    if (steps > most_steps) {
      atomicMax(lists.at.lost, 1u);
      break;
    }
    for (uint i = 0; i < count; ++i) {
      Item item = load_item(kept[i]);
      int weight = weights[i];
      Real3 a = subtract3(real3(floats(item.a), rest_of(item.first.w, board.rest_step)), point);
      Real3 b = subtract3(real3(floats(item.b), rest_of(item.second.w, board.rest_step)), point);
      for (uint d = begin + lane(); d < end; d += lanes) {
        Real3 diode = subtract3(diode_place(int(d)), point);
        Crossing crossing = cross_in_float(high3(a), high3(b), high3(lens), high3(diode));
        while (subgroupAny(crossing.unsure))
          crossing = cross_in_real(a, b, lens, diode);
        surfaces[d] += crosses(crossing) ? (crossing.at_lens ? -weight : weight) : 0;
      }
    }
  }
  vec3 normal = normal_in_board_frame(own, board);
  uint reached = 0u;
  for (uint d = begin + lane(); d < end; d += lanes) {
    vec3 to_diode = high3(subtract3(diode_place(int(d)), point));
    bool reaches = surfaces[d] == 0 && dot(normal, to_diode) > 0.0;
    uint within = d - lane();
    reached |= subgroupBallot(reaches).x << within % 32u;
    if (within % 32u + lanes == 32u) {
      if (lane() == 0u)
        correct(within / 32u, at.i, reached, board);
      reached = 0u;
    }
  }
}
