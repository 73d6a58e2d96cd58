#include "engine/multipath/bounced_image.h"

#include "engine/multipath/image_cells.h"
#include "engine/radiosity/hemisphere.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr std::uint32_t largest_cell = 16; // samples along the edge of a first cell
constexpr std::uint32_t no_node = 0xffffffffu;
// Parts of what a pixel may be off by: what rays leave out (one standard deviation), and interpolation.
constexpr float of_rays = 0.5f, of_interpolation = 0.4f;
// Standard deviations of what rays leave out that interpolation may seem to miss.
constexpr float noise_let_through = 2.5f;

// The part of a variance by rays that interpolation may miss unseen.
constexpr float hidden_by_noise = 0.25f;

// What is gathered at a sample.
using Node = std::vector<Gathered>;

class ImageGather {
public:
  ImageGather(const Radiosity &radiosity, const std::vector<BounceTone> &tones, const SeenPlaces &seen,
              const glm::uvec2 &resolution, const ImageAim &aim)
      : gather_(radiosity, tones), tones_(tones), seen_(seen), aim_(aim),
        node_of_sample_(std::size_t{seen.columns()} * seen.rows(), no_node) {
    image_.tones.resize(tones.size());
    for (BouncedTone &tone : image_.tones) {
      const std::size_t pixels = std::size_t{resolution.x} * resolution.y;
      tone.z.resize(pixels);
      tone.deviation.resize(pixels);
      tone.missed.resize(pixels);
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
    const auto want = [&](const glm::uvec2 &sample) {
      std::uint32_t &node = node_of_sample_[index(sample)];
      if (node != no_node)
        return;
      node = static_cast<std::uint32_t>(nodes_.size() + wanted.size());
      wanted.push_back(sample);
    };
    for (const ImageCell &cell : cells) {
      for (const glm::uvec2 &corner : cell.corners())
        want(corner);
      if (cell.is_divisible())
        want(cell.middle());
    }
    const std::size_t first = nodes_.size();
    nodes_.resize(first + wanted.size());
    std::vector<std::size_t> rays(wanted.size());
    tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t i) {
      if (const auto seen = seen_.at(wanted[i]))
        rays[i] =
            gather_.at(seen->place, turn_of(index(wanted[i])), aim_at(wanted[i], *seen), nodes_[first + i]);
      else
        nodes_[first + i].assign(tones_.size(), {});
    });
    image_.rays += std::accumulate(rays.begin(), rays.end(), std::size_t{0});
    image_.gathered += wanted.size();
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

  // Radiance at the lens for each unit of irradiance.
  static double gain_of(const SeenPlace &seen) {
    return seen.lens_gain * seen.reflectivity / std::numbers::pi;
  }

  // What diodes make arrive at a place that a sample sees: its pixel's light without the way to the lens.
  Phasor direct_at(const glm::uvec2 &sample, const SeenPlace &seen, std::size_t tone) const {
    const auto gain = static_cast<float>(gain_of(seen));
    const Phasor back = unit_phasor(-tones_[tone].turns_per_m() * seen.range_m);
    return gain > 0.0f ? (1.0f / gain) * (back * aim_.direct[tone][seen_.pixel_of(sample)]) : Phasor{};
  }

  GatherAim aim_at(const glm::uvec2 &sample, const SeenPlace &seen) const {
    GatherAim aim{{}, aim_.part};
    for (std::size_t t = 0; t < tones_.size(); ++t) {
      aim.direct.push_back(direct_at(sample, seen, t));
      aim.part[t] *= of_rays;
    }
    return aim;
  }

  const Node &node(const glm::uvec2 &sample) const { return nodes_[node_of_sample_[index(sample)]]; }

  // Interpolated between the corners of a cell, their largest |missed| beside it.
  Gathered between(const ImageCell &cell, const glm::uvec2 &sample, std::size_t tone) const {
    Gathered sum;
    const auto corners = cell.corners();
    const auto weights = cell.weights(sample);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Gathered &corner = node(corners[i])[tone];
      sum.irradiance += weights[i] * corner.irradiance;
      sum.variance += weights[i] * weights[i] * corner.variance;
      sum.missed.re = std::max(sum.missed.re, pmdsim::abs(corner.missed));
    }
    return sum;
  }

  // What interpolation misses at a cell's middle, |irradiance| of each tone; nothing where that is too much.
  std::optional<std::vector<float>> missed_at_middle(const ImageCell &cell) const {
    std::vector<float> missed(tones_.size());
    const auto seen = cell.is_divisible() ? seen_.at(cell.middle()) : std::nullopt;
    for (std::size_t t = 0; t < tones_.size() && seen; ++t) {
      const Gathered &found = node(cell.middle())[t];
      const Gathered expected = between(cell, cell.middle(), t);
      const float most = of_interpolation * aim_.part[t] *
                         pmdsim::abs(direct_at(cell.middle(), *seen, t) + found.irradiance);
      const float variance = expected.variance + found.variance,
                  off2 = norm(expected.irradiance - found.irradiance);
      if (off2 > std::max(most * most, noise_let_through * noise_let_through * variance))
        return std::nullopt;
      // Beyond what rays leave out; where they leave out more than is missed, that hides some.
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
      const Gathered here = between(settled.cell, sample, t);
      const Phasor z = gain * (unit_phasor(tones_[t].turns_per_m() * seen->range_m) * here.irradiance);
      BouncedTone &tone = image_.tones[t];
      tone.z[pixel] += std::complex<float>(z.re, z.im);
      const float missed = settled.missed[t];
      tone.deviation[pixel] += gain * std::sqrt(here.variance + 0.5f * missed * missed);
      tone.missed[pixel] += gain * here.missed.re;
    }
  }

  Gather gather_;
  const std::vector<BounceTone> &tones_;
  const SeenPlaces &seen_;
  const ImageAim &aim_;
  std::vector<std::uint32_t> node_of_sample_; // or no_node
  std::vector<Node> nodes_;
  std::vector<Settled> settled_;
  BouncedImage image_;
};

} // namespace

BouncedImage gather_image(const Radiosity &radiosity, const std::vector<BounceTone> &tones,
                          const SeenPlaces &seen, const glm::uvec2 &resolution, const ImageAim &aim,
                          const std::function<void(double)> &progress) {
  return ImageGather(radiosity, tones, seen, resolution, aim).run(progress);
}

} // namespace pmdsim
