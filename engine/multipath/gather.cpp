#include "engine/multipath/gather.h"

#include "engine/radiosity/hemisphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

constexpr std::uint32_t first_edge = 32, most_edge = 480; // rays along the square's edge
// Silhouettes go through cells at random: each puts the middle of its cell off by a variance of at most 1/12
// of the jump squared, and both cells beside it see the jump. Measured over places of three scenes it is
// 1/36. The sum's variance falls with the cube of the edge.
constexpr float variance_of_jump = 1.0f / 36.0f;

// What arrives along the rays of a grid over the unit square, tone by tone.
struct Grid {
  std::uint32_t edge = 0;
  std::vector<Phasor> light;
};

class PlaceGather {
public:
  PlaceGather(const Radiosity &radiosity, const std::vector<double> &turns_per_m, const SurfacePlace &place,
              double turn)
      : radiosity_(radiosity), turns_per_m_(turns_per_m), tones_(turns_per_m.size()), normal_(place.normal),
        turn_(turn), from_m_(place.position_m + radiosity.elements.clearance_m() * place.normal) {}

  // Sums edge * edge rays, a multiple of 4 squared.
  void sum(std::uint32_t edge, Grid &grid, std::vector<Gathered> &sums) const {
    const Hemisphere hemisphere(normal_, turn_, edge);
    grid.edge = edge;
    grid.light.assign(std::size_t{edge} * edge * tones_, {});
    sums.assign(tones_, {});
    for (std::uint32_t row = 0; row < edge; row += packet_rows)
      for (std::uint32_t column = 0; column < edge; column += packet_columns)
        trace(hemisphere, column, row, grid, sums);
    const float share = 1.0f / (static_cast<float>(edge) * static_cast<float>(edge));
    for (Gathered &of_tone : sums) {
      of_tone.irradiance = share * of_tone.irradiance;
      of_tone.missed = share * of_tone.missed;
    }
    add_variance(grid, sums);
  }

private:
  void trace(const Hemisphere &hemisphere, std::uint32_t column, std::uint32_t row, Grid &grid,
             std::vector<Gathered> &sums) const {
    RayPacket packet;
    const auto cell = [&](std::uint32_t i) {
      return glm::uvec2(column + i % packet_columns, row + i / packet_columns);
    };
    for (std::uint32_t i = 0; i < packet_rays; ++i)
      packet.directions[i] = hemisphere.direction(cell(i));
    radiosity_.tree->trace(from_m_, packet);
    for (std::uint32_t i = 0; i < packet_rays; ++i)
      if (packet.facet[i] != no_facet)
        shade(packet, i, &grid.light[(std::size_t{cell(i).y} * grid.edge + cell(i).x) * tones_], sums);
  }

  void shade(const RayPacket &packet, std::uint32_t i, Phasor *light, std::vector<Gathered> &sums) const {
    const std::size_t face = face_of(packet.facet[i], packet.side[i]);
    const float u = packet.u[i], v = packet.v[i];
    for (std::size_t t = 0; t < tones_; ++t) {
      const FaceLight &leaving = radiosity_.exitance.of(face, t);
      const Phasor way = unit_phasor(turns_per_m_[t] * static_cast<double>(packet.length_m[i]));
      light[t] = way * pmdsim::at(leaving.corners, u, v);
      sums[t].irradiance += light[t];
      sums[t].missed += missed_part(u, v) * (way * leaving.missed);
    }
  }

  // Linear changes are summed without an error, so that jumps are told by second differences: along
  // diagonals, as every other cell lies higher.
  void add_variance(const Grid &grid, std::vector<Gathered> &sums) const {
    const std::size_t edge = grid.edge;
    const auto light = [&](std::size_t column, std::size_t row, std::size_t t) {
      return grid.light[(row * edge + column) * tones_ + t];
    };
    const float cells = static_cast<float>(edge) * static_cast<float>(edge);
    for (std::size_t row = 1; row + 1 < edge; ++row)
      for (std::size_t column = 1; column + 1 < edge; ++column)
        for (std::size_t t = 0; t < tones_; ++t) {
          const Phasor twice = 2.0f * light(column, row, t);
          const Phasor rising = light(column - 1, row - 1, t) + light(column + 1, row + 1, t) - twice;
          const Phasor falling = light(column - 1, row + 1, t) + light(column + 1, row - 1, t) - twice;
          sums[t].variance += variance_of_jump / (cells * cells) * std::max(norm(rising), norm(falling));
        }
  }

  const Radiosity &radiosity_;
  const std::vector<double> &turns_per_m_;
  std::size_t tones_;
  glm::dvec3 normal_;
  double turn_;
  glm::dvec3 from_m_;
};

// How many times the variance is that aimed at, of the tone where that is most.
float excess_of(const std::vector<Gathered> &sums, const GatherAim &aim) {
  float excess = 0.0f;
  for (std::size_t t = 0; t < sums.size(); ++t) {
    const float aimed = aim.part[t] * aim.part[t] * norm(aim.direct[t] + sums[t].irradiance);
    excess = std::max(excess, sums[t].variance / std::max(aimed, std::numeric_limits<float>::min()));
  }
  return excess;
}

} // namespace

Gather::Gather(const Radiosity &radiosity, const std::vector<BounceTone> &tones) : radiosity_(radiosity) {
  for (const BounceTone &tone : tones)
    turns_per_m_.push_back(tone.turns_per_m());
}

std::size_t Gather::at(const SurfacePlace &place, double turn, const GatherAim &aim,
                       std::vector<Gathered> &gathered) const {
  thread_local Grid grid;
  PlaceGather gather(radiosity_, turns_per_m_, place, turn);
  gather.sum(first_edge, grid, gathered);
  std::size_t rays = std::size_t{first_edge} * first_edge;
  if (const float excess = excess_of(gathered, aim); excess > 1.0f) {
    const float edge =
        std::min(static_cast<float>(first_edge) * std::cbrt(excess), static_cast<float>(most_edge));
    const auto whole =
        packet_columns * ((static_cast<std::uint32_t>(edge) + packet_columns - 1) / packet_columns);
    gather.sum(static_cast<std::uint32_t>(whole), grid, gathered);
    rays += whole * whole;
  }
  return rays;
}

} // namespace pmdsim
