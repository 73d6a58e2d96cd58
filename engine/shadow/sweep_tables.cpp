#include "engine/shadow/sweep_tables.h"

#include "engine/model/turn.h"
#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace pmdsim {
namespace {

using shader::uvec4;

constexpr std::size_t bit_words = shader::bundles_per_window;
using Bits = std::array<std::uint32_t, bit_words>;

void set(Bits &bits, std::size_t diode) { bits[diode / 32] |= 1u << diode % 32; }

struct AngleClass {
  float turn;
  std::uint32_t before; // diodes of smaller angles
  std::uint32_t after;  // these and the class's own
};

std::vector<AngleClass> angle_classes(const std::vector<std::pair<float, std::uint32_t>> &ordered) {
  std::vector<AngleClass> classes;
  for (std::uint32_t i = 0; i < ordered.size(); ++i)
    if (classes.empty() || ordered[i].first > classes.back().turn + same_turn)
      classes.push_back({ordered[i].first, i, i + 1});
    else
      classes.back().after = i + 1;
  return classes;
}

constexpr std::size_t least_bins = 4096, most_bins = std::size_t{1} << 17;

std::size_t bin_of(float turn, std::size_t bins) {
  return std::min(bins - 1, static_cast<std::size_t>(turn * (static_cast<float>(bins) / 4.0f)));
}

// Whether some bin holds more than two classes.
bool is_too_coarse(const std::vector<AngleClass> &classes, std::size_t bins) {
  for (std::size_t i = 2; i < classes.size(); ++i)
    if (bin_of(classes[i - 2].turn, bins) == bin_of(classes[i].turn, bins))
      return true;
  return false;
}

std::size_t bins_for(const std::vector<AngleClass> &classes) {
  std::size_t bins = least_bins;
  while (bins < most_bins && is_too_coarse(classes, bins))
    bins *= 2;
  return bins;
}

std::vector<uvec4> rank_table(const std::vector<AngleClass> &classes, std::size_t bins) {
  const auto above_all = std::bit_cast<std::uint32_t>(8.0f);
  std::vector<uvec4> table(bins, uvec4(0, above_all, above_all, 0));
  std::size_t next = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    const std::uint32_t base = next > 0 ? classes[next - 1].after : 0;
    std::array<std::uint32_t, 3> ranks{base, base, base};
    for (std::size_t slot = 0; next < classes.size() && bin_of(classes[next].turn, bins) == bin;
         ++next, ++slot) {
      table[bin][1 + static_cast<glm::length_t>(slot)] = std::bit_cast<std::uint32_t>(classes[next].turn);
      for (std::size_t after = slot + 1; after < 3; ++after)
        ranks[after] = classes[next].after;
    }
    table[bin].x = ranks[0] | ranks[1] << 10 | ranks[2] << 20;
  }
  return table;
}

std::vector<uvec4> prefix_table(const std::vector<std::pair<float, std::uint32_t>> &ordered) {
  std::vector<uvec4> table;
  Bits bits{};
  for (std::size_t rank = 0; rank <= ordered.size(); ++rank) {
    for (std::size_t w = 0; w < bit_words; w += 4)
      table.push_back({bits[w], bits[w + 1], bits[w + 2], bits[w + 3]});
    if (rank < ordered.size())
      set(bits, ordered[rank].second);
  }
  return table;
}

// A bin of directions of lines. Each diode has two offsets between which it may be beyond a line or not.
struct DirectionBin {
  glm::dvec2 middle;
  double half_angle_rad;
};

glm::dvec2 direction_at(double turn) {
  const double quadrant = std::floor(turn), t = turn - quadrant;
  const glm::dvec2 first(1.0 - t, t); // |x| + |y| = 1 in the first quadrant, where turn = y
  switch (static_cast<int>(quadrant)) {
  case 0:
    return glm::normalize(first);
  case 1:
    return glm::normalize(glm::dvec2(-first.y, first.x));
  case 2:
    return glm::normalize(-first);
  default:
    return glm::normalize(glm::dvec2(first.y, -first.x));
  }
}

DirectionBin direction_bin(std::size_t direction) {
  constexpr double per_turn = shader::line_directions / 4.0;
  const double low = static_cast<double>(direction) / per_turn;
  const glm::dvec2 a = direction_at(low), b = direction_at(std::fmod(low + 1.0 / per_turn, 4.0));
  const glm::dvec2 middle = glm::normalize(a + b);
  // A little wider: the shader finds the direction in float.
  return {middle, 0.5 * std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) + 2e-6};
}

// The offsets of a direction, as the shader counts them: cells of places from -1 to 1 of the radius.
double cell_of(double place) { return (0.5 * place + 0.5) * (shader::line_offsets - 2.0) + 1.0; }

void add_direction(const DirectionBin &bin, const Board &board, const std::vector<glm::dvec2> &diodes_m,
                   std::vector<uvec4> &lines) {
  std::array<Bits, shader::line_offsets> beyond{}, perhaps{};
  const double slack = line_margin_m(board) / board.radius_m;
  for (std::size_t d = 0; d < diodes_m.size(); ++d) {
    const glm::dvec2 place = diodes_m[d] / board.radius_m;
    // How far along a normal of this bin it lies.
    const double along = glm::dot(place, bin.middle),
                 across = std::abs(place.x * bin.middle.y - place.y * bin.middle.x);
    const double spread = across * std::sin(bin.half_angle_rad) +
                          (1.0 - std::cos(bin.half_angle_rad)) * std::abs(along) + slack;
    const double first = cell_of(along - spread), last = cell_of(along + spread);
    const auto cell = [](double at) {
      return static_cast<std::size_t>(std::clamp(at, 0.0, shader::line_offsets - 1.0));
    };
    // The cell `first` lies in holds offsets above `along`, too; the one after `last` holds none below.
    for (std::size_t i = cell(std::floor(first)); i <= cell(std::floor(last)); ++i)
      set(perhaps[i], d);
    if (const std::size_t sure = cell(std::floor(last)) + 1; sure < shader::line_offsets)
      set(beyond[sure], d);
  }
  Bits sure{};
  for (std::size_t i = 0; i < shader::line_offsets; ++i) {
    for (std::size_t w = 0; w < bit_words; ++w)
      sure[w] |= beyond[i][w];
    for (std::size_t w = 0; w < bit_words; w += 2)
      lines.push_back({sure[w], perhaps[i][w] & ~sure[w], sure[w + 1], perhaps[i][w + 1] & ~sure[w + 1]});
  }
}

std::vector<uvec4> line_table(const Board &board, const std::vector<glm::dvec2> &diodes_m) {
  std::vector<uvec4> lines;
  lines.reserve(std::size_t{shader::line_directions} * shader::line_offsets * bit_words / 2);
  for (std::size_t direction = 0; direction < shader::line_directions; ++direction)
    add_direction(direction_bin(direction), board, diodes_m, lines);
  return lines;
}

} // namespace

double line_margin_m(const Board &board) { return 1e-3 * board.radius_m; }

SweepTables sweep_tables(const Board &board, const std::vector<glm::dvec3> &places_m) {
  SweepTables tables;
  std::vector<std::pair<float, std::uint32_t>> ordered;
  std::vector<glm::dvec2> flat_m;
  for (std::uint32_t d = 0; d < places_m.size(); ++d) {
    const glm::dvec3 place_m = board.in_frame(places_m[d]);
    const glm::vec2 x = float_pair(place_m.x), y = float_pair(place_m.y), z = float_pair(place_m.z);
    tables.diodes.push_back({x.x, y.x, x.y, y.y});
    tables.diodes.push_back({z.x, z.y, 0.0f, 0.0f});
    ordered.emplace_back(turn_of({x.x, y.x}), d);
    flat_m.emplace_back(place_m);
  }
  std::ranges::sort(ordered);
  const std::vector<AngleClass> classes = angle_classes(ordered);
  const std::size_t bins = bins_for(classes);
  tables.tells_angles = !is_too_coarse(classes, bins);
  tables.ranks = tables.tells_angles ? rank_table(classes, bins) : std::vector<uvec4>(1);
  tables.prefixes = prefix_table(ordered);
  tables.lines = line_table(board, flat_m);
  return tables;
}

} // namespace pmdsim
