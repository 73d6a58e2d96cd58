// The loops of what a place sees along lines. Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET
// its name; see engine/CMakeLists.txt.
#include "engine/model/lanes.h"
#include "engine/surfaces/scan_board.h"

#include <initializer_list>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr float pi = 3.14159265358979f;
// The angle of the direction (x, y), y >= 0, from the axis of x, to 1e-6 rad.
Floats angle_of(const Floats &x, const Floats &y) {
  const Floats wide = absolute(x), low = smaller(wide, y), high = larger(wide, y);
  const Floats t = low / larger(high, all(1e-37f)), q = t * t;
  // The arc tangent of 0 to 1, by least squares.
  const Floats angle =
      t * (0.99997726f +
           q * (-0.33262347f + q * (0.19354346f + q * (-0.11643287f + q * (0.05265332f - 0.01172120f * q)))));
  const Floats steep = y > wide ? 0.5f * pi - angle : angle;
  return x < 0.0f ? pi - steep : steep;
}

Ints whole(const Floats &v) { return __builtin_convertvector(v, Ints); }

// Vectors that begin at `from`, whose storage has room for the last.
template <class Visit>
void for_each_vector(std::uint32_t count, const Visit &visit) {
  for (std::uint32_t i = 0; i < count; i += lanes)
    visit(i);
}

void see_vertices(const ScanScene &scene, const ScanFrame &frame, const ScanVertices &to) {
  const float lines_per_rad = static_cast<float>(frame.lines) / pi;
  const auto turned = [](const float(&axis)[3], const Floats &x, const Floats &y, const Floats &z) {
    return axis[0] * x + axis[1] * y + axis[2] * z;
  };
  for_each_vector(scene.vertices, [&](std::uint32_t i) {
    const Floats dx = load<Floats>(scene.x_m + i) - frame.from_m[0],
                 dy = load<Floats>(scene.y_m + i) - frame.from_m[1],
                 dz = load<Floats>(scene.z_m + i) - frame.from_m[2];
    const Floats along = turned(frame.y, dx, dy, dz), up = turned(frame.z, dx, dy, dz);
    store(to.x_m + i, turned(frame.x, dx, dy, dz));
    store(to.y_m + i, along);
    store(to.z_m + i, up);
    const Ints is_below = up < 0.0f;
    // The plane of a line goes on below, where a vertex is as its mirror image is above.
    const Floats angle = angle_of(is_below ? -along : along, absolute(up));
    // Lines lie half a step after whole ones.
    const Ints line = whole(angle * lines_per_rad + 0.5f);
    store(to.code + i, 2 * line - is_below);
  });
}

std::uint32_t find_triangles(const ScanScene &scene, const ScanVertices &vertices, const MetTriangles &to) {
  std::uint32_t count = 0;
  for_each_vector(scene.triangles, [&](std::uint32_t i) {
    const Ints triangle = lane_numbers() + static_cast<std::int32_t>(i);
    const auto code = [&](int corner) {
      return gathered(vertices.code, load<Ints>(scene.corners[corner] + i));
    };
    const Ints a = code(0), b = code(1), c = code(2);
    const Ints any_below = (a | b | c) & 1, all_below = a & b & c & 1;
    const Ints first = smaller(smaller(a, b), c) >> 1, end = larger(larger(a, b), c) >> 1;
    const Ints is_met = (all_below == 0) & ((any_below != 0) | (first < end)) &
                        (triangle < static_cast<std::int32_t>(scene.triangles));
    const Packing pack(bits_of(is_met));
    store(to.triangle + count, pack(triangle));
    store(to.first_line + count, pack(any_below != 0 ? all(-1) : first));
    store(to.end_line + count, pack(end));
    count += static_cast<std::uint32_t>(pack.count());
  });
  return count;
}

struct LineCorner {
  Ints vertex;
  Floats x, y, z;   // in the place's frame
  Floats aside, up; // from the line's plane, and in it above the surface
};

struct End {
  Floats x, y, u, v;
};

// The ends of the triangles of a vector, and whether they have any.
struct Ends {
  End of[2];
  Ints are_there, side;
};

LineCorner corner_of(const ScanVertices &vertices, const LineTask &task, const Ints &vertex) {
  LineCorner corner{vertex,
                    gathered(vertices.x_m, vertex),
                    gathered(vertices.y_m, vertex),
                    gathered(vertices.z_m, vertex),
                    Floats{},
                    Floats{}};
  corner.aside = task.cosine * corner.z - task.sine * corner.y;
  corner.up = task.cosine * corner.y + task.sine * corner.z;
  return corner;
}

// Where the edge between two corners meets the line's plane, and how much the second one weighs there. The
// edge runs from the vertex with the lower number, so that triangles on both sides find the same.
struct Meeting {
  Floats x, y, weight;
};
Meeting meet(const LineCorner &a, const LineCorner &b) {
  const Ints in_order = a.vertex < b.vertex;
  const Floats before = in_order ? a.aside : b.aside, after = in_order ? b.aside : a.aside;
  const Floats from_x = in_order ? a.x : b.x, from_y = in_order ? a.up : b.up, to_x = in_order ? b.x : a.x,
               to_y = in_order ? b.up : a.up;
  const Floats part = before / (before - after);
  const Floats t = before != after ? smaller(larger(part, all(0.0f)), all(1.0f)) : all(0.5f);
  return {from_x + t * (to_x - from_x), from_y + t * (to_y - from_y), in_order ? t : 1.0f - t};
}

Ends ends_of(const ScanScene &scene, const ScanVertices &vertices, const LineTask &task,
             const Ints &triangle) {
  const Ints a = gathered(scene.corners[0], triangle), b = gathered(scene.corners[1], triangle),
             c = gathered(scene.corners[2], triangle);
  const auto is_beyond = [&](const Ints &vertex) {
    const Ints code = gathered(vertices.code, vertex);
    return ((code >> 1) > task.line) ^ -(code & 1);
  };
  const Ints of_a = is_beyond(a), of_b = is_beyond(b), of_c = is_beyond(c);
  // The corner that is alone on its side, and those that follow it.
  const Ints a_alone = (of_a ^ of_b) & (of_a ^ of_c), b_alone = (of_b ^ of_a) & (of_b ^ of_c);
  const LineCorner alone = corner_of(vertices, task, a_alone ? a : (b_alone ? b : c)),
                   second = corner_of(vertices, task, a_alone ? b : (b_alone ? c : a)),
                   third = corner_of(vertices, task, a_alone ? c : (b_alone ? a : b));
  const Meeting near = meet(alone, second), far = meet(alone, third);
  const Floats none = all(0.0f);
  Ends ends;
  ends.of[0] = {near.x, near.y, a_alone ? near.weight : (b_alone ? 1.0f - near.weight : none),
                a_alone ? none : (b_alone ? near.weight : 1.0f - near.weight)};
  ends.of[1] = {far.x, far.y, a_alone ? none : (b_alone ? 1.0f - far.weight : far.weight),
                a_alone ? far.weight : (b_alone ? none : 1.0f - far.weight)};
  ends.are_there = (of_a ^ of_b) | (of_a ^ of_c);
  const Floats bx = second.x - alone.x, by = second.y - alone.y, bz = second.z - alone.z,
               cx = third.x - alone.x, cy = third.y - alone.y, cz = third.z - alone.z;
  const Floats front_x = by * cz - bz * cy, front_y = bz * cx - bx * cz, front_z = bx * cy - by * cx;
  const Floats behind = front_x * alone.x + front_y * alone.y + front_z * alone.z;
  // A place on a triangle's plane, as at an edge, may seem to lie just behind it.
  const Floats front2 = front_x * front_x + front_y * front_y + front_z * front_z;
  const Ints is_behind = behind * behind > scene.lowest_m * scene.lowest_m * front2;
  ends.side = (behind > 0.0f) & is_behind & 1;
  return ends;
}

// Moves an end that is not above `lowest_m` there.
End clipped(const End &end, const End &other, float lowest_m) {
  const Floats low = end.y - lowest_m, high = other.y - lowest_m;
  const Ints is_low = low < 0.0f;
  const Floats t = low / (low - high);
  return {is_low ? end.x + t * (other.x - end.x) : end.x, is_low ? all(lowest_m) : end.y,
          is_low ? end.u + t * (other.u - end.u) : end.u, is_low ? end.v + t * (other.v - end.v) : end.v};
}

// The first bin whose middle is not before that angle.
Ints bin_from(const Floats &angle, std::uint32_t bins) {
  const Floats bin = angle * (static_cast<float>(bins) / pi) - 0.5f;
  const Ints below = whole(bin);
  const Ints next = below + (__builtin_convertvector(below, Floats) < bin ? all(1) : all(0));
  return smaller(larger(next, all(0)), all(static_cast<std::int32_t>(bins)));
}

std::uint32_t find_stretches(const ScanScene &scene, const ScanVertices &vertices, const LineTask &task,
                             const Stretches &to) {
  std::uint32_t count = 0;
  for_each_vector(task.count, [&](std::uint32_t i) {
    const Ints triangle = load<Ints>(task.triangles + i);
    const Ends ends = ends_of(scene, vertices, task, triangle);
    const End a = clipped(ends.of[0], ends.of[1], scene.lowest_m),
              b = clipped(ends.of[1], ends.of[0], scene.lowest_m);
    const Ints is_above = (ends.of[0].y > scene.lowest_m) | (ends.of[1].y > scene.lowest_m);
    const Floats a_rad = angle_of(a.x, a.y), b_rad = angle_of(b.x, b.y);
    const Ints in_order = a_rad <= b_rad;
    const auto low = [&](const Floats &of_a, const Floats &of_b) { return in_order ? of_a : of_b; };
    const Floats low_x = low(a.x, b.x), low_y = low(a.y, b.y), high_x = low(b.x, a.x), high_y = low(b.y, a.y);
    const Floats low_rad = low(a_rad, b_rad), high_rad = low(b_rad, a_rad);
    const Floats area = low_x * high_y - low_y * high_x, per_area = 1.0f / area;
    const Ints first = bin_from(low_rad, scene.bins.count), end = bin_from(high_rad, scene.bins.count);
    const Ints is_new =
        ends.are_there & is_above & (area > 0.0f) & (first < end) &
        (lane_numbers() + static_cast<std::int32_t>(i) < static_cast<std::int32_t>(task.count));
    const Packing pack(bits_of(is_new));
    const auto of_x = [&](const Floats &at_low, const Floats &at_high) {
      return pack((at_low * high_y - at_high * low_y) * per_area);
    };
    const auto of_y = [&](const Floats &at_low, const Floats &at_high) {
      return pack((at_high * low_x - at_low * high_x) * per_area);
    };
    const Floats low_u = low(a.u, b.u), high_u = low(b.u, a.u), low_v = low(a.v, b.v), high_v = low(b.v, a.v);
    const Floats one = all(1.0f);
    store(to.nearness_x + count, of_x(one, one));
    store(to.nearness_y + count, of_y(one, one));
    store(to.u_x + count, of_x(low_u, high_u));
    store(to.u_y + count, of_y(low_u, high_u));
    store(to.v_x + count, of_x(low_v, high_v));
    store(to.v_y + count, of_y(low_v, high_v));
    store(to.low_rad + count, pack(low_rad));
    store(to.high_rad + count, pack(high_rad));
    store(to.first_bin + count, pack(first));
    store(to.end_bin + count, pack(end));
    store(to.triangle + count, pack(triangle));
    store(to.side + count, pack(ends.side));
    count += static_cast<std::uint32_t>(pack.count());
  });
  return count;
}

// The nearest stretch in the direction of each bin.
struct Nearest {
  alignas(vector_bytes) float nearness[most_bins + lanes];
  alignas(vector_bytes) std::int32_t stretch[most_bins + lanes];
};

void look_for_masked(const ScanScene &scene, const Stretches &stretches, std::int32_t own, Nearest &nearest) {
  const LineBins &of = scene.bins;
  for (std::int32_t i = stretches.first_bin[own]; i < stretches.end_bin[own]; ++i) {
    const float nearness = stretches.nearness_x[own] * of.x[i] + stretches.nearness_y[own] * of.y[i];
    if (!(nearness > nearest.nearness[i]))
      continue;
    const float u = (stretches.u_x[own] * of.x[i] + stretches.u_y[own] * of.y[i]) / nearness,
                v = (stretches.v_x[own] * of.x[i] + stretches.v_y[own] * of.y[i]) / nearness;
    if (!scene.is_there(scene.is_there_of, stretches.triangle[own], u, v))
      continue;
    nearest.nearness[i] = nearness;
    nearest.stretch[i] = own;
  }
}

void find_nearest(const ScanScene &scene, const Stretches &stretches, std::uint32_t count, Nearest &nearest) {
  constexpr std::int32_t few = 3; // bins, which are faster one by one
  const LineBins &of = scene.bins;
  for (std::uint32_t i = 0; i < of.count + lanes; i += lanes) {
    store(nearest.nearness + i, all(0.0f));
    store(nearest.stretch + i, all(0));
  }
  for (std::int32_t own = 0; own < static_cast<std::int32_t>(count); ++own) {
    if (scene.is_masked && scene.is_masked[stretches.triangle[own]] != 0) {
      look_for_masked(scene, stretches, own, nearest);
      continue;
    }
    const std::int32_t first = stretches.first_bin[own], end = stretches.end_bin[own];
    const float of_x = stretches.nearness_x[own], of_y = stretches.nearness_y[own];
    if (end - first <= few) {
      for (std::int32_t i = first; i < end; ++i) {
        const float nearness = of_x * of.x[i] + of_y * of.y[i];
        const bool is_nearer = nearness > nearest.nearness[i];
        nearest.nearness[i] = is_nearer ? nearness : nearest.nearness[i];
        nearest.stretch[i] = is_nearer ? own : nearest.stretch[i];
      }
      continue;
    }
    for (std::int32_t i = first; i < end; i += lanes) {
      const Floats nearness = of_x * load<Floats>(of.x + i) + of_y * load<Floats>(of.y + i),
                   before = load<Floats>(nearest.nearness + i);
      const Ints is_nearer = (nearness > before) & (lane_numbers() < end - i);
      store(nearest.nearness + i, is_nearer ? nearness : before);
      store(nearest.stretch + i, is_nearer ? all(own) : load<Ints>(nearest.stretch + i));
    }
  }
}

// Where what bin i - 1 sees gives way to what bin i sees, in bins from their border: at an end of these
// between the bins' middles. Ends of small ones are no borders: others that no bin sees may lie beside them,
// and bins are right on average.
float border(const Stretches &stretches, const Nearest &nearest, float per_rad, std::int32_t i) {
  constexpr float large = 3.0f; // bins
  const std::int32_t before = nearest.stretch[i - 1], after = nearest.stretch[i];
  const auto in_bins = [&](float angle) { return angle * per_rad - static_cast<float>(i); };
  const auto is_large = [&](std::int32_t own) {
    return (stretches.high_rad[own] - stretches.low_rad[own]) * per_rad > large;
  };
  const bool sees_before = nearest.nearness[i - 1] > 0.0f, sees_after = nearest.nearness[i] > 0.0f;
  const float end = sees_before && is_large(before) ? in_bins(stretches.high_rad[before]) : 1.0f,
              begin = sees_after && is_large(after) ? in_bins(stretches.low_rad[after]) : 1.0f;
  const bool ends = end >= -0.5f && end <= 0.5f, begins = begin >= -0.5f && begin <= 0.5f;
  if (ends && begins)
    return 0.5f * (end + begin);
  return ends ? end : (begins ? begin : 0.0f);
}

// How wide bins are in the end, and how far their middles move, both in bins.
struct BinParts {
  alignas(vector_bytes) float width[most_bins], shift[most_bins];
};

// Moves the borders between what neighbouring bins see to where they are. Beside a border, as at an end of an
// integral that is summed at the middles of its parts, what the sum leaves out is told by the last two of
// them (the formula of Euler and Maclaurin).
void move_borders(const Stretches &stretches, const Nearest &nearest, std::uint32_t bins, BinParts &parts) {
  constexpr float of_end = 1.0f / 24.0f;
  const float per_rad = static_cast<float>(bins) / pi;
  const auto last = static_cast<std::int32_t>(bins) - 1;
  const auto is_alike = [&](std::int32_t a, std::int32_t b) {
    return nearest.stretch[a] == nearest.stretch[b] && nearest.nearness[b] > 0.0f;
  };
  const auto moved = [&](std::int32_t i) {
    const float by = border(stretches, nearest, per_rad, i);
    parts.width[i - 1] += by;
    parts.width[i] -= by;
    parts.shift[i - 1] += 0.5f * by;
    parts.shift[i] += 0.5f * by;
    if (i > 1 && is_alike(i - 1, i - 2)) {
      parts.width[i - 1] += of_end;
      parts.width[i - 2] -= of_end;
    }
    if (i < last && is_alike(i, i + 1)) {
      parts.width[i] += of_end;
      parts.width[i + 1] -= of_end;
    }
  };
  // The first bin of a vector is compared with the last of the one before.
  for (std::int32_t first = 0; first < static_cast<std::int32_t>(bins); first += lanes) {
    const auto changed = [&](std::int32_t i) {
      return nearest.stretch[i] != nearest.stretch[i - 1] ||
             (nearest.nearness[i] > 0.0f) != (nearest.nearness[i - 1] > 0.0f);
    };
    if (first > 0 && changed(first))
      moved(first);
    const Ints here = load<Ints>(nearest.stretch + first), next = load<Ints>(nearest.stretch + first + 1);
    const Ints sees_here = load<Floats>(nearest.nearness + first) > 0.0f,
               sees_next = load<Floats>(nearest.nearness + first + 1) > 0.0f;
    std::uint32_t bits = bits_of((here != next) | (sees_here != sees_next));
    for (bits &= (1u << (lanes - 1)) - 1u; bits != 0; bits &= bits - 1)
      moved(first + static_cast<std::int32_t>(__builtin_ctz(bits)) + 1);
  }
}

std::int32_t facet_at(const ScanScene &scene, std::int32_t node, float u, float v) {
  while (node >= 0) {
    const FacetCut cut = scene.cuts[node];
    node = cut.next + (cut.at + cut.u * u + cut.v * v >= 0.0f ? 0 : 1);
    if (scene.cuts[node].next < 0)
      return ~scene.cuts[node].next;
  }
  return ~node;
}

void see_line(const ScanScene &scene, const ScanVertices &vertices, const LineTask &task,
              const Stretches &stretches, SeenLine &seen) {
  const LineBins &of = scene.bins;
  const std::uint32_t count = find_stretches(scene, vertices, task, stretches);
  Nearest nearest;
  find_nearest(scene, stretches, count, nearest);
  const Floats none = all(0.0f), one = all(1.0f);
  BinParts parts;
  const auto bins = static_cast<int>(of.count);
  for (int i = 0; i < bins; i += lanes) {
    store(parts.width + i, one);
    store(parts.shift + i, none);
  }
  if (count > 0)
    move_borders(stretches, nearest, of.count, parts);
  const float bin_rad = pi / static_cast<float>(of.count);
  for (int i = 0; i < bins; i += lanes) {
    const Floats nearness = load<Floats>(nearest.nearness + i);
    const Ints is_seen = nearness > none;
    if (bits_of(is_seen) == 0) {
      store(seen.face + i, all(scene.dark_face));
      for (float *values : {seen.u, seen.v, seen.length_m, seen.share})
        store(values + i, none);
      continue;
    }
    const Ints own = load<Ints>(nearest.stretch + i);
    const Floats middle_x = load<Floats>(of.x + i), middle_y = load<Floats>(of.y + i),
                 shift = bin_rad * load<Floats>(parts.shift + i);
    const Floats unit = 1.0f - 0.5f * shift * shift;
    const Floats x = unit * (middle_x - shift * middle_y), y = unit * (middle_y + shift * middle_x);
    const Floats there = gathered(stretches.nearness_x, own) * x + gathered(stretches.nearness_y, own) * y;
    const Floats length = is_seen ? 1.0f / (is_seen ? there : one) : none;
    const auto weight = [&](const float *of_x, const float *of_y) {
      return smaller(larger((gathered(of_x, own) * x + gathered(of_y, own) * y) * length, none), one);
    };
    const Floats u = weight(stretches.u_x, stretches.u_y), v = weight(stretches.v_x, stretches.v_y);
    const Ints triangle = gathered(stretches.triangle, own), along = gathered(scene.cells_along, triangle);
    const Floats cells = __builtin_convertvector(along, Floats);
    const Ints column = smaller(whole(u * cells), along - 1), row = smaller(whole(v * cells), along - 1);
    const Ints cell = gathered(scene.first_cell, triangle) + row * along + column;
    Ints facet = ~gathered(scene.cells, cell);
    store(seen.u + i, u);
    store(seen.v + i, v);
    for (std::uint32_t bits = bits_of(facet < 0); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      facet[lane] = facet_at(scene, ~facet[lane], seen.u[i + lane], seen.v[i + lane]);
    }
    store(seen.face + i, is_seen ? 2 * facet + gathered(stretches.side, own) : all(scene.dark_face));
    store(seen.length_m + i, length);
    store(seen.share + i, is_seen ? task.share * bin_rad * (y * y * load<Floats>(parts.width + i)) : none);
  }
}

} // namespace

extern const ScanLoops scan_loops;
const ScanLoops scan_loops{see_vertices, find_triangles, see_line};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
