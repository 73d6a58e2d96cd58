#include "engine/multipath/bounced_image.h"

#include "engine/multipath/image_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr std::uint32_t largest_cell = 16; // samples along the edge of a first cell
constexpr std::uint32_t not_gathered = 0xffffffffu;
// Parts of what a pixel may be off by: what lines leave out at a place (one standard deviation), and what
// corners miss at the middle of a cell, most of which the middle mends.
constexpr float of_lines = 0.5f, of_interpolation = 1.0f;
// Of what corners miss at a middle, squared: what is missed over the cell once its middle counts.
constexpr float left_by_bend = 0.1f;
// Standard deviations of what lines leave out that corners may seem to miss.
constexpr float noise_let_through = 2.5f;

// The part of a variance by lines that corners may miss unseen.
constexpr float hidden_by_noise = 0.25f;

// What is gathered at a sample.
struct Node {
  glm::vec3 normal{0.0f};
  std::uint32_t lines = 0;        // that it takes; at first a guess by its neighbours
  std::vector<Gathered> gathered; // of each tone
};

// Radiance at the lens for each unit of irradiance.
double gain_of(const SeenPlace &seen) { return seen.lens_gain * seen.reflectivity / std::numbers::pi; }

// What diodes make arrive at a place that a sample sees: its pixel's light without the way to the lens.
std::vector<Phasor> direct_at(const std::vector<BounceTone> &tones, const SeenPlaces &seen,
                              const ImageAim &aim, const glm::uvec2 &sample, const SeenPlace &place) {
  const auto gain = static_cast<float>(gain_of(place));
  std::vector<Phasor> direct(tones.size());
  for (std::size_t t = 0; t < tones.size() && gain > 0.0f; ++t)
    direct[t] = (1.0f / gain) *
                (unit_phasor(-tones[t].turns_per_m() * place.range_m) * aim.direct[t][seen.pixel_of(sample)]);
  return direct;
}

class ImageGather {
public:
  ImageGather(const Radiosity &radiosity, const std::vector<BounceTone> &tones, const SeenPlaces &seen,
              const glm::uvec2 &resolution, const ImageAim &aim)
      : gather_(radiosity, tones), tones_(tones), seen_(seen), aim_(aim),
        node_of_sample_(std::size_t{seen.columns()} * seen.rows(), not_gathered) {
    image_.tones.resize(tones.size());
    for (BouncedTone &tone : image_.tones) {
      const std::size_t pixels = std::size_t{resolution.x} * resolution.y;
      tone.z.resize(pixels);
      tone.deviation.resize(pixels);
    }
  }

  BouncedImage run(const std::function<void(double)> &progress) {
    std::vector<ImageCell> cells = first_cells();
    // How many cells will be cut is not known: each turn is taken for half of what is left.
    for (double part = 0.0; !cells.empty(); part += 0.5 * (1.0 - part)) {
      progress(part);
      gather_nodes(cells);
      cells = settle(std::move(cells));
    }
    sum_samples();
    return std::move(image_);
  }

private:
  std::size_t index(const glm::uvec2 &sample) const {
    return std::size_t{sample.y} * seen_.columns() + sample.x;
  }

  std::vector<ImageCell> first_cells() const {
    const glm::uvec2 end(seen_.columns() - 1, seen_.rows() - 1);
    const glm::uvec2 blocks = end / largest_cell + 1u;
    std::vector<std::vector<ImageCell>> of_rows(blocks.y);
    tbb::parallel_for(0u, blocks.y, [&](std::uint32_t row) {
      for (std::uint32_t column = 0; column < blocks.x; ++column) {
        const glm::uvec2 low = largest_cell * glm::uvec2(column, row);
        std::ranges::move(cells_of(seen_, low, glm::min(low + largest_cell, end)),
                          std::back_inserter(of_rows[row]));
      }
    });
    std::vector<ImageCell> cells;
    for (std::vector<ImageCell> &of_row : of_rows)
      std::ranges::move(of_row, std::back_inserter(cells));
    return cells;
  }

  void gather_nodes(const std::vector<ImageCell> &cells) {
    std::vector<glm::uvec2> wanted;
    const std::size_t first = nodes_.size();
    const auto want = [&](const glm::uvec2 &sample, std::uint32_t guess) {
      std::uint32_t &node = node_of_sample_[index(sample)];
      if (node != not_gathered)
        return;
      node = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back({glm::vec3(0.0f), guess, {}});
      wanted.push_back(sample);
    };
    for (const ImageCell &cell : cells) {
      const std::uint32_t guess = most_lines_around(cell);
      for (const glm::uvec2 &corner : cell.corners())
        want(corner, guess);
      if (cell.is_divisible())
        want(cell.middle(), guess);
    }
    std::vector<std::size_t> lines(wanted.size());
    tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t i) {
      Node &node = nodes_[first + i];
      if (const auto seen = seen_.at(wanted[i])) {
        node.normal = glm::vec3(seen->place.normal);
        const Gather::Lines of_node = gather_.at(seen->place, turn_of(index(wanted[i])), node.lines,
                                                 aim_at(wanted[i], *seen), node.gathered);
        node.lines = of_node.needed;
        lines[i] = of_node.looked;
      } else {
        node.gathered.assign(tones_.size(), {});
      }
    });
    image_.lines += std::accumulate(lines.begin(), lines.end(), std::size_t{0});
    image_.gathered += wanted.size();
  }

  // That corners of a cell take, of those that were gathered before.
  std::uint32_t most_lines_around(const ImageCell &cell) const {
    std::uint32_t lines = 0;
    for (const glm::uvec2 &corner : cell.corners())
      if (const std::uint32_t node = node_of_sample_[index(corner)]; node != not_gathered)
        lines = std::max(lines, nodes_[node].lines);
    return lines;
  }

  // Keeps cells over which light can be interpolated, or that have no more to be interpolated. Returns the
  // halves of the others.
  std::vector<ImageCell> settle(std::vector<ImageCell> &&cells) {
    std::vector<std::optional<std::vector<float>>> missed(cells.size());
    tbb::parallel_for(std::size_t{0}, cells.size(),
                      [&](std::size_t i) { missed[i] = missed_at_middle(cells[i]); });
    std::vector<ImageCell> rest;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (missed[i])
        settled_.push_back({std::move(cells[i]), std::move(*missed[i])});
      else
        std::ranges::move(halves_of(cells[i]), std::back_inserter(rest));
    return rest;
  }

  // Across its longer side on its plane.
  std::array<ImageCell, 2> halves_of(const ImageCell &cell) const {
    if (!cell.has_middle_row())
      return halves_by_column(cell);
    if (!cell.has_middle_column())
      return halves_by_row(cell);
    const auto corners = cell.corners();
    const auto distance_m = [&](std::size_t a, std::size_t b) {
      const auto from = seen_.at(corners[a]), to = seen_.at(corners[b]);
      return from && to ? glm::distance(from->place.position_m, to->place.position_m) : 0.0;
    };
    const double along_rows = std::max(distance_m(0, 1), distance_m(2, 3)),
                 along_columns = std::max(distance_m(0, 2), distance_m(1, 3));
    return along_rows >= along_columns ? halves_by_column(cell) : halves_by_row(cell);
  }

  std::vector<Phasor> direct_at(const glm::uvec2 &sample, const SeenPlace &place) const {
    return pmdsim::direct_at(tones_, seen_, aim_, sample, place);
  }

  GatherAim aim_at(const glm::uvec2 &sample, const SeenPlace &place) const {
    GatherAim aim{direct_at(sample, place), aim_.part};
    for (float &part : aim.part)
      part *= of_lines;
    return aim;
  }

  const Node &node(const glm::uvec2 &sample) const { return nodes_[node_of_sample_[index(sample)]]; }

  // Between places at which light was gathered. What elements are off by is alike at all of them.
  struct Interpolated {
    Phasor irradiance;
    float of_lines = 0.0f, of_elements = 0.0f; // variances

    void add(float weight, const Gathered &at) {
      irradiance += weight * at.irradiance;
      of_lines += weight * weight * at.of_lines;
      of_elements = std::max(of_elements, at.of_elements);
    }
  };

  // Sums between places: what arrives, as it is interpolated along a smooth surface, and what a facet's own
  // tilt against that changes.
  class Between {
  public:
    explicit Between(std::size_t tone) : tone_(tone) {}

    void add(float weight, const Node &node) {
      const Gathered &at = node.gathered[tone_];
      sum_.add(weight, at);
      normal_ += weight * node.normal;
      for (std::size_t k = 0; k < by_tilt_.size(); ++k)
        by_tilt_[k] += weight * at.by_tilt[k];
    }

    Interpolated on(const glm::vec3 &normal) const {
      const glm::vec3 tilt = normal - normal_;
      Interpolated made = sum_;
      made.irradiance += tilt.x * by_tilt_[0] + tilt.y * by_tilt_[1] + tilt.z * by_tilt_[2];
      return made;
    }

  private:
    std::size_t tone_;
    Interpolated sum_;
    glm::vec3 normal_{0.0f};
    std::array<Phasor, 3> by_tilt_;
  };

  // By the corners of a cell alone.
  Interpolated between(const ImageCell &cell, const glm::uvec2 &sample, const glm::vec3 &normal,
                       std::size_t tone) const {
    Between sum(tone);
    const auto corners = cell.corners();
    const auto weights = cell.weights(sample);
    for (std::size_t i = 0; i < corners.size(); ++i)
      sum.add(weights[i], node(corners[i]));
    return sum.on(normal);
  }

  // By the corners and the middle, where there is one.
  Interpolated bent(const ImageCell &cell, const glm::uvec2 &sample, const glm::vec3 &normal,
                    std::size_t tone) const {
    if (!cell.is_divisible())
      return between(cell, sample, normal, tone);
    Between sum(tone);
    const auto corners = cell.corners();
    const auto weights = cell.weights(sample), at_middle = cell.weights(cell.middle());
    const float bend = cell.bend(sample);
    for (std::size_t i = 0; i < corners.size(); ++i)
      sum.add(weights[i] - bend * at_middle[i], node(corners[i]));
    sum.add(bend, node(cell.middle()));
    return sum.on(normal);
  }

  // Whether a surface bends so much over a cell that tilts of its facets cannot be told from that.
  bool bends_too_much(const ImageCell &cell) const {
    constexpr float most = 0.97f; // the cosine of some 14 degrees
    const glm::vec3 normal = node(cell.middle()).normal;
    return std::ranges::any_of(cell.corners(), [&](const glm::uvec2 &corner) {
      return glm::dot(node(corner).normal, normal) < most;
    });
  }

  // What corners miss at a cell's middle, |irradiance| of each tone; nothing where that is too much.
  std::optional<std::vector<float>> missed_at_middle(const ImageCell &cell) const {
    std::vector<float> missed(tones_.size());
    const auto seen = cell.is_divisible() ? seen_.at(cell.middle()) : std::nullopt;
    if (seen && bends_too_much(cell))
      return std::nullopt;
    const std::vector<Phasor> direct = seen ? direct_at(cell.middle(), *seen) : std::vector<Phasor>{};
    for (std::size_t t = 0; t < tones_.size() && seen; ++t) {
      const Gathered &found = node(cell.middle()).gathered[t];
      const Interpolated expected = between(cell, cell.middle(), glm::vec3(seen->place.normal), t);
      const float most = of_interpolation * aim_.part[t] * pmdsim::abs(direct[t] + found.irradiance);
      const float variance = expected.of_lines + found.of_lines,
                  off2 = norm(expected.irradiance - found.irradiance);
      if (off2 > std::max(most * most, noise_let_through * noise_let_through * variance))
        return std::nullopt;
      // Beyond what lines leave out; where they leave out more than is missed, that hides some.
      missed[t] = std::sqrt(std::max(off2 - variance, hidden_by_noise * variance));
    }
    return missed;
  }

  struct Settled {
    ImageCell cell;
    std::vector<float> missed;
  };

  // A pixel's samples may lie in several cells, so that these are added up one after the other.
  void sum_samples() {
    for (const Settled &settled : settled_)
      for_each_own(settled.cell, [&](const glm::uvec2 &sample) { add(settled, sample); });
  }

  void add(const Settled &settled, const glm::uvec2 &sample) {
    const auto seen = seen_.at(sample);
    if (!seen)
      return;
    const auto gain = static_cast<float>(gain_of(*seen) / seen_.samples_of_pixel());
    const std::size_t pixel = seen_.pixel_of(sample);
    for (std::size_t t = 0; t < tones_.size(); ++t) {
      const Interpolated here = bent(settled.cell, sample, glm::vec3(seen->place.normal), t);
      const Phasor z = gain * (unit_phasor(tones_[t].turns_per_m() * seen->range_m) * here.irradiance);
      BouncedTone &tone = image_.tones[t];
      tone.z[pixel] += std::complex<float>(z.re, z.im);
      const float missed = settled.missed[t];
      tone.deviation[pixel] +=
          gain * std::sqrt(here.of_lines + here.of_elements + left_by_bend * missed * missed);
    }
  }

  Gather gather_;
  const std::vector<BounceTone> &tones_;
  const SeenPlaces &seen_;
  const ImageAim &aim_;
  std::vector<std::uint32_t> node_of_sample_; // or not_gathered
  std::vector<Node> nodes_;
  std::vector<Settled> settled_;
  BouncedImage image_;
};

} // namespace

std::vector<float> times_off(const Radiosity &radiosity, const std::vector<BounceTone> &tones,
                             const SeenPlaces &seen, const ImageAim &aim) {
  constexpr std::uint32_t places_per_edge = 20;
  const glm::uvec2 samples(seen.columns(), seen.rows());
  const Gather gather(radiosity, tones);
  std::vector<float> times(std::size_t{places_per_edge} * places_per_edge,
                           std::numeric_limits<float>::quiet_NaN());
  tbb::parallel_for(std::size_t{0}, times.size(), [&](std::size_t i) {
    const glm::uvec2 place(i % places_per_edge, i / places_per_edge);
    const glm::uvec2 sample = (2u * place + 1u) * samples / (2u * places_per_edge);
    if (const auto seen_place = seen.at(sample))
      times[i] = gather.times_off(seen_place->place, turn_of(i),
                                  direct_at(tones, seen, aim, sample, *seen_place), aim.part);
  });
  return times;
}

BouncedImage gather_image(const Radiosity &radiosity, const std::vector<BounceTone> &tones,
                          const SeenPlaces &seen, const glm::uvec2 &resolution, const ImageAim &aim,
                          const std::function<void(double)> &progress) {
  return ImageGather(radiosity, tones, seen, resolution, aim).run(progress);
}

} // namespace pmdsim
