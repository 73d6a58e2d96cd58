#version 460
// Decides which diodes of a window reach which sample, without a ray. Let the light's place move from the lens, which sees the sample,
// to a diode: the number of surfaces between changes only where the triangle of sample, lens and place meets an edge of a silhouette.
// So an edge counts for the diodes in the angle that it takes about the lens's foot on the board, as far as they lie beyond it.
//
// A workgroup is a subgroup, its invocations neighbouring samples of a tile. Samples that cannot be decided here are left to
// sweep_exact.comp.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/sweep.glsl"
#include "shaders/shadow/sweep_weight.glsl"

layout(local_size_x_id = constant_lanes) in;
layout(constant_id = constant_bundles) const uint bundles = bundles_per_window;
layout(constant_id = constant_lens_apart) const uint lens_apart = 0; // from the board's plane
layout(constant_id = constant_all_facing) const uint all_facing = 0;
layout(constant_id = constant_exact_only) const uint exact_only = 0; // every sample is left to sweep_exact.comp

// Of a segment: pairs take 16 KiB of the workgroup's memory, of which GPUs have 32 KiB or 48.
const uint most_items = lanes > 8u ? 4096u / lanes : 512u;
const uint most_hidden = 1000;
const uint most_close = 32;  // close decisions of an invocation in a segment
shared uint kept[most_items + 1], pairs[(most_items + 1) * lanes], close[most_close * lanes];

// Counts of surfaces in front of each diode, bit by bit, two's complement: a plane of bits each.
const uint planes_of_bits = 6;
uint counts[bundles][planes_of_bits];
uint overflows = 0u;

// Adds 1 or 2 (`doubled`), or what `negative` makes of it, to the counts of the diodes in `mask`.
void count_diodes(uint mask[bundles], bool doubled, uint negative) {
  [[unroll]] for (uint w = 0; w < bundles; ++w) {
    uint carry = doubled ? 0u : mask[w];
    [[unroll]] for (uint p = 0; p < planes_of_bits; ++p) {
      if (p == 1)
        carry = doubled ? mask[w] : carry;
      uint before = counts[w][p];
      counts[w][p] = before ^ carry;
      if (p == planes_of_bits - 1)
        overflows |= carry & ~(before ^ negative);
      carry &= before ^ negative;
    }
  }
}

// An angle's measure that grows with it, 0 to 4.
float turn_of(vec2 q) {
  float t = q.y / max(abs(q.x) + abs(q.y), 1e-30);
  return q.x < 0.0 ? 2.0 - t : q.y < 0.0 ? 4.0 + t : t;
}

// The number of diodes of a smaller angle. A texel holds three ranks and the two angles between them.
uint rank_of(float turn) {
  uvec4 bin = texelFetch(rank_texels, int(clamp(turn * (float(constants.rank_bins) / 4.0), 0.0, float(constants.rank_bins - 1u))));
  uint shift = (turn > uintBitsToFloat(bin.y) ? 10u : 0u) + (turn > uintBitsToFloat(bin.z) ? 10u : 0u);
  return bitfieldExtract(bin.x, int(shift), 10);
}

// A pair of sample and edge whose angle holds a diode.
const uint pair_wraps = 1u << 27, pair_doubled = 1u << 28, pair_negative = 1u << 29, pair_turned = 1u << 30, pair_unsure = 1u << 31;

SweepBoard board;
// The sample of this invocation, board frame.
bool sees, unclear; // whether it sees anything; whether it has to be left to sweep_exact.comp
uint own;           // the shape that it sees
Real3 exact_point;
vec3 point, point_rest, to_lens;
float depth;         // under the board
float reach, beside; // where edges matter about the board's centre; where ends at the sample's own height have no angle
float tolerance;     // of a line's value at a diode, times the edge's size
uint base;           // surfaces before the board's centre, two's complement
uint found, close_count; // of a segment: its pairs, its close decisions
uint steps;          // of all loops

// From the sample to an item's end.
vec3 to_end(uvec4 texel, uint rest, float rest_step) { return (floats(texel) - point) + (rest_of(rest, rest_step) - point_rest); }

// The first bit that is set: the word it is in, and the word with it alone.
uint next_bit(uint words[bundles], out uint bit) {
  uint word = 0u, bits = 0u;
  [[unroll]] for (uint down = 0; down < bundles; ++down) {
    uint w = bundles - 1u - down;
    word = words[w] != 0u ? w : word;
    bits = words[w] != 0u ? words[w] : bits;
  }
  bit = bits & -bits;
  return word;
}

// The cell of the table for the half-plane of diodes L with line.xy . L + offset < 0.
int cell_of(vec2 normal, float offset, float per_length, float radius) {
  float place = -offset * per_length / radius;
  int direction = int(clamp(turn_of(normal) * (float(line_directions) / 4.0), 0.0, float(line_directions - 1u)));
  int step = int(clamp((0.5 * place + 0.5) * float(line_offsets - 2u) + 1.0, 0.0, float(line_offsets - 1u)));
  return (direction * int(line_offsets) + step) * int(bundles_per_window / 2u);
}

// The diodes in front of the sample's own surface.
void find_facing(out uint facing[bundles]) {
  [[unroll]] for (uint w = 0; w < bundles; ++w)
    facing[w] = ~0u;
  if (all_facing != 0)
    return;
  vec3 normal = normal_in_board_frame(sees ? own : 0u, board);
  // A diode's height over the surface: normal . (L - point).
  float offset = dot(normal, high3(exact_point)), per_length = 1.0 / max(sqrt(dot(normal.xy, normal.xy)), 1e-30);
  int cell = cell_of(-normal.xy, offset, per_length, board.radius);
  uint unknown[bundles], any_unknown = 0u;
  [[unroll]] for (uint w = 0; w < bundles; w += 2) {
    uvec4 known = texelFetch(line_texels, cell + int(w / 2u));
    [[unroll]] for (uint v = 0; v < 2; ++v)
      if (w + v < bundles) {
        facing[w + v] = known[2u * v];
        unknown[w + v] = known[2u * v + 1u];
        any_unknown |= unknown[w + v];
      }
  }
  while (any_unknown != 0u) {
    uint bit, word = next_bit(unknown, bit);
    vec2 diode = texelFetch(diode_texels, int(2u * (word * 32u + findLSB(bit)))).xy;
    bool faces = dot(normal.xy, diode) > offset;
    any_unknown = 0u;
    [[unroll]] for (uint w = 0; w < bundles; ++w) {
      facing[w] |= w == word && faces ? bit : 0u;
      unknown[w] ^= w == word ? bit : 0u;
      any_unknown |= unknown[w];
    }
  }
}

// Whether a triangle that the lens does not see may lie between it and the sample, which it sees.
bool is_perhaps_hidden(SweepLists lists, uint tile) {
  uint length = lists.list[length_at(list_hidden, tile)], first = list_begin(lists, list_hidden, tile);
  bool perhaps = length > most_hidden;
  for (uint i = 0; i < min(length, most_hidden); ++i) {
    Item item = load_hidden(Words(constants.entries).at[first + i]);
    perhaps = perhaps || may_hide(floats(item.a) - point, floats(item.b) - point, floats(item.first) - point, to_lens);
  }
  return perhaps;
}

// Writes to `kept` the tile's items in a segment that may matter here, an invocation an item; returns how many.
uint keep_items(Ways ways, uint first, uint length) {
  uint count = 0u;
  for (uint i = 0; i < length; i += lanes) {
    uint index = Words(constants.entries).at[first + min(i + lane(), length - 1u)];
    bool matters = i + lane() < length && may_matter(ways, load_item(index));
    uint met = subgroupBallot(matters).x;
    kept[matters ? count + bitCount(met & lanes_below()) : most_items] = index;
    count += bitCount(met);
  }
  return count;
}

// Each invocation loads an item; then all take the same item, each for its own sample, and find which angle it takes. The pairs
// of those that take some go to `pairs`.
void find_pairs(uint count) {
  found = 0u;
  for (uint i = 0; i < count; i += lanes) {
    Item item = load_item(kept[min(i + lane(), count - 1u)]);
    vec3 rest_a = rest_of(item.first.w, board.rest_step), rest_b = rest_of(item.second.w, board.rest_step);
    uint many = min(lanes, count - i);
    for (uint k = 0; k < many; ++k) {
      uvec4 texel_a = subgroupShuffle(item.a, k), texel_b = subgroupShuffle(item.b, k);
      uvec4 texel_1 = subgroupShuffle(item.first, k), texel_2 = subgroupShuffle(item.second, k);
      vec3 a = (floats(texel_a) - point) + (subgroupShuffle(rest_a, k) - point_rest);
      vec3 b = (floats(texel_b) - point) + (subgroupShuffle(rest_b, k) - point_rest);
      bool is_boundary = texel_b.w == item_boundary;
      bool counted = sees && texel_a.w != own && texel_b.w != own && max(a.z, b.z) > 0.0;
      // The sides of its triangles.
      float h1 = dot(floats(texel_1), a), h2 = dot(floats(texel_2), a), size_a = abs(a.x) + abs(a.y) + abs(a.z);
      float unsure_height = 6e-7 * size_a;
      bool unsure = abs(h1) < unsure_height || (!is_boundary && abs(h2) < unsure_height);
      int w1 = weight_of(h1 < 0.0 ? 1 : -1, texel_1.w >> 30), w2 = weight_of(h2 < 0.0 ? 1 : -1, texel_2.w >> 30);
      int weight = is_boundary ? -w1 : w2 - w1;
      counted = counted && (weight != 0 || unsure);
      // Its ends, as far as it lies between the depths of sample and board, projected on the board.
      vec3 way = b - a;
      float per_height = 1.0 / (abs(way.z) < 1e-30 ? 1e-30 : way.z);
      vec3 low_end = vec3(a.xy - a.z * per_height * way.xy, 0.0);
      vec3 high_end = vec3(a.xy + (depth - a.z) * per_height * way.xy, depth);
      vec3 clipped_a = a.z < 0.0 ? low_end : a.z > depth ? high_end : a;
      vec3 clipped_b = b.z < 0.0 ? low_end : b.z > depth ? high_end : b;
      counted = counted && min(a.z, b.z) < depth;
      if (lens_apart != 0)
        unclear = unclear || (counted && max(a.z, b.z) > board.nearest + depth);
      vec2 qa = point.xy * clipped_a.z + clipped_a.xy * depth, qb = point.xy * clipped_b.z + clipped_b.xy * depth;
      float size_qa = abs(qa.x) + abs(qa.y), size_qb = abs(qb.x) + abs(qb.y);
      // The edge's line on the board: normal . L + offset, negative beyond it as seen from a counter-clockwise edge.
      vec3 line = cross(a, way);
      float offset = line.z * depth - dot(line.xy, point.xy);
      float near_line = tolerance * size_a * (abs(way.x) + abs(way.y) + abs(way.z));
      // Its least distance from the centre is at most that of the diodes: of the ends where one is nearest, else of the line.
      vec2 along = qb * clipped_a.z - qa * clipped_b.z; // positive multiple of the projected way
      bool past_a = dot(qa, along) > 0.0 && clipped_a.z > 0.0, past_b = dot(qb, along) < 0.0 && clipped_b.z > 0.0;
      bool near_a = size_qa <= 1.5 * reach * clipped_a.z, near_b = size_qb <= 1.5 * reach * clipped_b.z;
      bool line_is_near = offset * offset <= reach * reach * dot(line.xy, line.xy) * 1.001 + near_line * near_line;
      counted = counted && line_is_near && (!past_a || near_a) && (!past_b || near_b);
      // An end before the centre has no angle, nor one beside the sample at its own height.
      bool at_centre = size_qa <= max(5e-6 * clipped_a.z, a.z < 0.0 ? beside * depth : 0.0) ||
                       size_qb <= max(5e-6 * clipped_b.z, b.z < 0.0 ? beside * depth : 0.0);
      float turn_a = turn_of(qa), turn_b = turn_of(qb), turn = turn_b - turn_a;
      turn = turn > 2.0 ? turn - 4.0 : turn < -2.0 ? turn + 4.0 : turn;
      unclear = unclear || (counted && (at_centre || (abs(offset) < near_line && abs(turn) > 0.5)));
      bool turned = abs(turn) > 1.9 ? offset < 0.0 : turn < 0.0;
      float from = turned ? turn_b : turn_a, to = turned ? turn_a : turn_b;
      uint rank_from = rank_of(from), rank_to = rank_of(to);
      bool wraps = from > to;
      if (lens_apart != 0) {
        // The way of the light from the lens to the board's centre.
        vec3 lens_plane = cross(to_lens, vec3(-point.xy, depth));
        float side_a = dot(lens_plane, clipped_a), side_b = dot(lens_plane, clipped_b);
        float at_lens = dot(line, to_lens);
        bool crosses = counted && (side_a > 0.0) != (side_b > 0.0) && (at_lens > 0.0) != (offset > 0.0);
        unclear = unclear || (counted && unsure && crosses) ||
                  (counted && (side_a > 0.0) != (side_b > 0.0) && (abs(at_lens) < near_line || abs(offset) < near_line));
        base += crosses ? uint(at_lens > 0.0 ? -weight : weight) : 0u;
      }
      counted = counted && int(rank_to - rank_from) + (wraps ? int(constants.diodes) : 0) > 0;
      bool negative = (weight > 0) != turned;
      pairs[found * lanes + lane()] = (i + k) | rank_from << 9 | rank_to << 18 | (wraps ? pair_wraps : 0u) | (abs(weight) == 2 ? pair_doubled : 0u) |
          (negative ? pair_negative : 0u) | (turned ? pair_turned : 0u) | (unsure ? pair_unsure : 0u);
      found += counted ? 1u : 0u;
    }
  }
}

// Each invocation takes its own pairs, and finds which diodes of the angle lie beyond the line.
void work_off_pairs() {
  uint most_found = subgroupMax(found);
  close_count = 0u;
  steps += 4u * most_found;
  for (uint y = 0; y < most_found; ++y) {
    uint pair = pairs[min(y, max(found, 1u) - 1u) * lanes + lane()];
    bool is_there = y < found;
    pair = is_there ? pair : 0u;
    uint index = kept[pair & 511u];
    int texel = int(4u * index);
    uvec4 texel_a = texelFetch(item_texels, texel), texel_b = texelFetch(item_texels, texel + 1);
    uint packed_a = texelFetch(item_texels, texel + 2).w, packed_b = texelFetch(item_texels, texel + 3).w;
    vec3 a = to_end(texel_a, packed_a, board.rest_step), b = to_end(texel_b, packed_b, board.rest_step);
    bool turned = (pair & pair_turned) != 0u;
    bool doubled = (pair & pair_doubled) != 0u;
    uint negative = (pair & pair_negative) != 0u ? ~0u : 0u;
    bool unsure = (pair & pair_unsure) != 0u;
    while (subgroupAny(unsure)) { // a loop, because lavapipe takes both sides of a branch
      int weight = exact_weight(index, packed_a >> 30, packed_b >> 30, texel_b.w == item_boundary, exact_point, board);
      is_there = is_there && !(unsure && weight == 0);
      doubled = unsure ? abs(weight) == 2 : doubled;
      negative = unsure ? ((weight > 0) != turned ? ~0u : 0u) : negative;
      unsure = false;
    }
    pairs[(y < found ? y : most_items) * lanes + lane()] =
        (pair & ~(pair_doubled | pair_negative)) | (doubled ? pair_doubled : 0u) | (negative != 0u ? pair_negative : 0u);
    vec3 way = b - a, line = cross(a, way);
    float offset = line.z * depth - dot(line.xy, point.xy);
    float near_line = tolerance * (abs(a.x) + abs(a.y) + abs(a.z)) * (abs(way.x) + abs(way.y) + abs(way.z));
    line = turned ? -line : line;
    offset = turned ? -offset : offset;

    uint beyond[bundles], unknown[bundles];
    int from = int(2u * bitfieldExtract(pair, 9, 9)), to = int(2u * bitfieldExtract(pair, 18, 9));
    uint wraps = (pair & pair_wraps) != 0u ? ~0u : 0u;
    float per_length = 1.0 / max(sqrt(line.x * line.x + line.y * line.y), 1e-30);
    int cell = cell_of(line.xy, offset, per_length, board.radius);
    bool blurred = near_line * per_length > board.line_margin; // the table's margin is not enough
    uint any_unknown = 0u;
    [[unroll]] for (uint w = 0; w < bundles; w += 4) {
      uvec4 in_angle = texelFetch(prefix_texels, from + int(w / 4u)) ^ texelFetch(prefix_texels, to + int(w / 4u)) ^ wraps;
      in_angle = is_there ? in_angle : uvec4(0u);
      [[unroll]] for (uint half_ = 0; half_ < 2; ++half_) {
        uvec4 known = texelFetch(line_texels, cell + int(w / 2u + half_)); // sure, unsure, sure, unsure
        [[unroll]] for (uint v = 0; v < 2; ++v) {
          uint word = w + 2u * half_ + v;
          if (word < bundles) {
            uint of_angle = in_angle[2u * half_ + v];
            beyond[word] = of_angle & (blurred ? 0u : known[2u * v]);
            unknown[word] = of_angle & (blurred ? ~0u : known[2u * v + 1u]);
            any_unknown |= unknown[word];
          }
        }
      }
    }
    while (subgroupAny(any_unknown != 0u) && steps < most_steps) { // diodes near the line, one by one
      uint bit, word = next_bit(unknown, bit), d = bit != 0u ? word * 32u + findLSB(bit) : 0u;
      vec2 diode = texelFetch(diode_texels, int(2u * d)).xy;
      float f = line.x * diode.x + line.y * diode.y + offset;
      bool is_beyond = f < 0.0, is_close = bit != 0u && abs(f) < near_line;
      close[min(close_count, most_close - 1u) * lanes + lane()] = y | d << 16 | (is_beyond ? 1u << 31 : 0u);
      close_count += is_close ? 1u : 0u;
      any_unknown = 0u;
      [[unroll]] for (uint w = 0; w < bundles; ++w) {
        uint here = w == word ? bit : 0u;
        beyond[w] |= is_beyond ? here : 0u;
        unknown[w] ^= here;
        any_unknown |= unknown[w];
      }
      ++steps;
    }
    unclear = unclear || (sees && any_unknown != 0u); // too many of them
    count_diodes(beyond, doubled, negative);
  }
}

// Decides in Real what was too close for floats, and puts the counts right where the float was wrong.
void decide_close() {
  unclear = unclear || close_count > most_close;
  uint most = subgroupMax(min(close_count, most_close));
  steps += most;
  for (uint z = 0; z < most; ++z) {
    bool is_there = z < close_count;
    uint entry_ = close[z * lanes + lane()];
    entry_ = is_there ? entry_ : 0u;
    uint pair = pairs[(entry_ & 0xffffu) * lanes + lane()], d = entry_ >> 16 & 0x3fffu;
    pair = is_there ? pair : 0u;
    Item item = load_item(kept[pair & 511u]);
    Real3 a = subtract3(real3(floats(item.a), rest_of(item.first.w, board.rest_step)), exact_point);
    Real3 b = subtract3(real3(floats(item.b), rest_of(item.second.w, board.rest_step)), exact_point);
    Real3 to_diode = subtract3(diode_place(int(d)), exact_point);
    float volume = high(dot3(cross3(a, b), to_diode));
    bool is_beyond = (pair & pair_turned) != 0u ? volume > 0.0 : volume < 0.0;
    bool wrong = is_there && is_beyond != ((entry_ >> 31) != 0u);
    uint negative = (pair & pair_negative) != 0u ? ~0u : 0u;
    uint mask[bundles];
    [[unroll]] for (uint w = 0; w < bundles; ++w)
      mask[w] = wrong && w == d / 32u ? 1u << d % 32u : 0u;
    count_diodes(mask, (pair & pair_doubled) != 0u, is_beyond ? negative : ~negative);
  }
}

// The number of surfaces before the board's centre joins all diodes' counts.
void add_base() {
  uint everywhere[bundles];
  [[unroll]] for (uint w = 0; w < bundles; ++w)
    everywhere[w] = ~0u;
  int surfaces = int(base);
  while (surfaces != 0) {
    bool doubled = abs(surfaces) > 1;
    count_diodes(everywhere, doubled, surfaces < 0 ? ~0u : 0u);
    surfaces -= (surfaces < 0 ? -1 : 1) * (doubled ? 2 : 1);
  }
}

// Stores the sample's bits, and its count of diodes.
void store_bits(uint i) {
  uint facing[bundles];
  find_facing(facing);
  // A count below zero means nothing for a diode behind the sample's own surface; elsewhere something was left out.
  uint below_zero = 0u;
  uint to_store[bundles];
  [[unroll]] for (uint w = 0; w < bundles; ++w) {
    uint blocked = 0u;
    [[unroll]] for (uint p = 0; p < planes_of_bits; ++p)
      blocked |= counts[w][p];
    to_store[w] = facing[w] & ~blocked;
    below_zero |= counts[w][planes_of_bits - 1] & facing[w];
  }
  unclear = unclear || overflows != 0u || below_zero != 0u;
  uint to = sees ? i : constants.plane - 1u, missing = 0u;
  [[unroll]] for (uint w = 0; w < bundles; ++w)
    Words(constants.visibility).at[w * constants.plane + to] = to_store[w];
  [[unroll]] for (uint w = 0; w < bundles; ++w)
    missing += bitCount(board.shining[w / 4u][w % 4u] & ~to_store[w]);
  Words(board.lit).at[to] -= missing;
}

// Lists the sample for sweep_exact.comp.
void leave_sample(SweepLists lists, uint number) {
  uint place = atomicAdd(lists.at.rounds[constants.round].samples, 1u);
  lists.list[sample_at(place)] = number;
  atomicMax(lists.at.rounds[constants.round].sample_groups_y, min(place + 1u, workgroups_per_row));
  atomicMax(lists.at.rounds[constants.round].sample_groups_z, place / workgroups_per_row + 1u);
}

void main() {
  board = Boards(constants.board).at;
  SweepLists lists = SweepLists(constants.work);
  uint tiles = lists.at.rounds[constants.round].tiles;
  if (entry_of_workgroup() >= tiles)
    return;
  uint tile = lists.list[active_at(constants.round, interleaved(entry_of_workgroup(), tiles))];
  const uint wide = lanes == 8u ? 4u : 8u, high_ = lanes / wide;
  uint across = tile_side / wide;
  uvec2 block = uvec2(gl_WorkGroupID.x % across, gl_WorkGroupID.x / across) * uvec2(wide, high_);
  uint within = (block.y + lane() / wide) * tile_side + block.x + lane() % wide;
  TileSample at = tile_sample(constants.strip, tile, within);
  Real3 camera_point = point_of(at, board);
  sees = at.is_there && high3(camera_point) != vec3(0.0);
  own = sees ? shape_seen(at) : 0xfffffff0u;
  exact_point = in_board_frame(camera_point, board);
  point = sees ? high3(exact_point) : vec3(0.0, 0.0, -1.0);
  point_rest = sees ? rest3(exact_point) : vec3(0.0);
  depth = -point.z;
  // Where edges matter about the centre: as far as diodes stand, and the lens, projected on the board.
  reach = 1.0005 * board.radius;
  if (lens_apart != 0)
    reach = max(reach, 1.0005 * length(point.xy * board.lens_z / (board.lens_z + depth)));
  beside = 2e-5 * (abs(point.x) + abs(point.y) + board.radius) + 1e-6;
  tolerance = 5e-7 * (abs(point.x) + abs(point.y) + depth + board.radius);

  vec4 slopes_a, slopes_b;
  slopes_of(point, board, slopes_a, slopes_b);
  Ways ways = ways_of(subgroupMax(sees ? slopes_a : vec4(-1e9)), subgroupMax(sees ? slopes_b : vec4(-1e9)),
                      subgroupMin(sees ? point : vec3(1e9)), subgroupMax(sees ? point : vec3(-1e9)), board);

  [[unroll]] for (uint w = 0; w < bundles; ++w)
    [[unroll]] for (uint p = 0; p < planes_of_bits; ++p)
      counts[w][p] = 0u;
  unclear = sees && (exact_only != 0 || !is_in_front(point, board));
  to_lens = vec3(-point.xy, board.lens_z + depth);
  base = 0u;
  uint length = exact_only != 0 ? 0u : lists.list[length_at(list_edges, tile)], first = list_begin(lists, list_edges, tile);
  steps = 0u;
  if (exact_only == 0 && sees && is_perhaps_hidden(lists, tile))
    unclear = true;
  for (uint segment = 0; segment < length; segment += most_items) {
    uint end = min(length - segment, most_items), count = keep_items(ways, first + segment, end);
    steps += end / lanes + 2u * count + 8u;
    if (steps > most_steps) {
      unclear = sees;
      break;
    }
    find_pairs(count);
    work_off_pairs();
    decide_close();
  }
  if (lens_apart != 0)
    add_base();
  store_bits(at.i);
  if (sees && unclear)
    leave_sample(lists, tile * tile_samples + within);
}
