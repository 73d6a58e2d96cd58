#include "engine/reduction/reduced_set.h"

#include "engine/light/radiation_laws.h"
#include "engine/reduction/dominant_moments.h"
#include "engine/reduction/nonnegative_quadrature.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>

namespace pmdsim {
namespace {

constexpr double largest_amplitude_error = 1e-3;
constexpr std::size_t most_candidates = 512;
// Limits for all clusters together, lest it take long where diodes stand all over the scene: looks at whether
// the series converges, and attempts.
constexpr std::size_t most_looks = 4096, most_attempts = 64;
constexpr std::size_t fewest_diodes = 6; // of a cluster: fewer are not worth a look

// The diodes of a cluster that may stand in for all: evenly spread, the first of each part, with the part's
// share.
struct Candidates {
  std::vector<std::size_t> diodes;
  Eigen::VectorXd shares;
};

Candidates candidates_of(const DiodeCluster &cluster) {
  const std::size_t all = cluster.offsets_m.size(), count = std::min(all, most_candidates);
  Candidates candidates{{}, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(count))};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * all / count, end = (i + 1) * all / count;
    candidates.diodes.push_back(first);
    candidates.shares[static_cast<Eigen::Index>(i)] =
        cluster.shares.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(end - first))
            .sum();
  }
  return candidates;
}

// Few diodes that stand in for a cluster.
struct Reduction {
  std::vector<std::size_t> diodes; // of the cluster
  std::vector<double> shares;      // of its intensity, > 0; their sum is 1
  SumError error;
};

Reduction reduction_of(const Candidates &candidates, const Eigen::VectorXd &shares, const SumError &error) {
  Reduction reduction{{}, {}, error};
  for (std::size_t i = 0; i < candidates.diodes.size(); ++i)
    if (const double share = shares[static_cast<Eigen::Index>(i)]; share > 0.0) {
      reduction.diodes.push_back(candidates.diodes[i]);
      reduction.shares.push_back(share);
    }
  return reduction;
}

// The fewest diodes that are good enough; nothing where not even all combinations of moments are.
std::optional<Reduction> fewest(const DiodeCluster &cluster, const MomentBounds &bounds,
                                const ErrorScale &scale) {
  const Candidates candidates = candidates_of(cluster);
  std::vector<glm::dvec3> offsets_m;
  for (const std::size_t diode : candidates.diodes)
    offsets_m.push_back(cluster.offsets_m[diode]);
  const Eigen::MatrixXd values = moment_values(bounds.moments, cluster, offsets_m);
  const Eigen::VectorXd moments = moments_of(cluster, bounds.moments);
  const Eigen::VectorXd importance = bounds.importance(scale);
  const Quadrature quadrature(importance.asDiagonal() * values, importance.cwiseProduct(moments),
                              candidates.shares);
  const auto attempt = [&](Eigen::Index combinations) -> std::optional<Reduction> {
    Eigen::VectorXd shares = quadrature.keeping(combinations);
    shares /= shares.sum();
    const SumError error = bounds.error(values * shares - moments, scale);
    const bool good = error.distance_m <= scale.max_error_m && error.amplitude <= scale.max_amplitude_error;
    return good ? std::optional(reduction_of(candidates, shares, error)) : std::nullopt;
  };
  Eigen::Index too_few = 0, enough = quadrature.rank();
  std::optional<Reduction> best = enough > 0 ? attempt(enough) : std::nullopt;
  while (best && enough - too_few > 1) {
    const Eigen::Index middle = (too_few + enough) / 2;
    if (std::optional<Reduction> fewer = attempt(middle)) {
      best = std::move(fewer);
      enough = middle;
    } else
      too_few = middle;
  }
  return best;
}

// Brings half of the diodes to the front so that a plane across the longest side of their box parts them from
// the rest.
void part_in_two(const std::vector<Diode> &diodes, std::span<std::size_t> members) {
  VisibleBox box;
  for (const std::size_t member : members)
    box.add(diodes[member].position_m);
  const int axis = box.longest_side();
  const auto middle = members.begin() + static_cast<std::ptrdiff_t>(members.size() / 2);
  std::ranges::nth_element(members, middle, [&](std::size_t a, std::size_t b) {
    return std::tuple(diodes[a].position_m[axis], a) < std::tuple(diodes[b].position_m[axis], b);
  });
}

// Orders diodes so that those that stand near each other follow each other.
void order(const std::vector<Diode> &diodes, std::span<std::size_t> members) {
  if (members.size() <= 1)
    return;
  part_in_two(diodes, members);
  order(diodes, members.first(members.size() / 2));
  order(diodes, members.subspan(members.size() / 2));
}

class Reducer {
public:
  Reducer(std::vector<VisibleBox> pieces, const ErrorScale &scale, ReducedLight &result)
      : pieces_(std::move(pieces)), scale_(scale), result_(result) {}

  void reduce(CameraIlluminator &illuminator) {
    std::vector<Diode> &diodes = illuminator.diodes;
    std::map<std::tuple<std::optional<double>, double, double, double>, std::vector<std::size_t>> classes;
    for (std::size_t i = 0; i < diodes.size(); ++i) {
      const std::optional<LawSeries> series = law_series(diodes[i].pattern);
      if (!series || !(diodes[i].intensity_w_sr > 0.0))
        continue;
      const glm::dvec3 axis = series->order ? diodes[i].axis : glm::dvec3(0.0);
      classes[{series->order, axis.x, axis.y, axis.z}].push_back(i);
    }
    drop_.assign(diodes.size(), false);
    for (auto &[kind, members] : classes) {
      order(diodes, members);
      reduce(diodes, members);
    }
    std::size_t i = 0;
    std::erase_if(diodes, [&](const Diode &) { return drop_[i++]; });
  }

private:
  // Halves clusters for which the series does not converge, the largest first.
  void reduce(std::vector<Diode> &diodes, std::span<const std::size_t> all) {
    std::deque<std::span<const std::size_t>> left{all};
    for (; !left.empty() && looks_left_ > 0 && attempts_left_ > 0; left.pop_front(), --looks_left_) {
      const std::span<const std::size_t> members = left.front();
      if (members.size() < fewest_diodes)
        continue;
      const DiodeCluster cluster = cluster_of(diodes, members);
      const std::vector<DirectionalBounds> directions =
          directional_bounds(pieces_, cluster.centre_m, cluster.axes, cluster.beam);
      if (const std::optional<Reduction> reduction = attempt(cluster, directions)) {
        if (reduction->diodes.size() < members.size())
          replace(diodes, members, cluster, *reduction);
      } else {
        left.push_back(members.first(members.size() / 2));
        left.push_back(members.subspan(members.size() / 2));
      }
    }
  }

  std::optional<Reduction> attempt(const DiodeCluster &cluster,
                                   const std::vector<DirectionalBounds> &directions) {
    if (!converges(cluster, directions, scale_))
      return std::nullopt;
    --attempts_left_;
    const std::optional<MomentBounds> bounds = dominant_moments(cluster, directions, scale_);
    return bounds ? fewest(cluster, *bounds, scale_) : std::nullopt;
  }

  void replace(std::vector<Diode> &diodes, std::span<const std::size_t> members, const DiodeCluster &cluster,
               const Reduction &reduction) {
    double intensity_w_sr = 0.0;
    for (const std::size_t member : members)
      intensity_w_sr += diodes[member].intensity_w_sr;
    for (const std::size_t member : members)
      drop_[member] = true;
    for (std::size_t i = 0; i < reduction.diodes.size(); ++i) {
      const std::size_t member = members[reduction.diodes[i]];
      drop_[member] = false;
      diodes[member].intensity_w_sr = reduction.shares[i] * intensity_w_sr;
    }
    for (const double x : {-1.0, 1.0})
      for (const double y : {-1.0, 1.0})
        for (const double z : {-1.0, 1.0})
          result_.lights.add(cluster.centre_m + cluster.axes * (glm::dvec3(x, y, z) * cluster.clearance_m));
    result_.error_per_condition_m = std::max(result_.error_per_condition_m, reduction.error.distance_m);
    result_.amplitude_error_per_condition =
        std::max(result_.amplitude_error_per_condition, reduction.error.amplitude);
  }

  std::vector<VisibleBox> pieces_;
  const ErrorScale &scale_;
  ReducedLight &result_;
  std::size_t looks_left_ = most_looks, attempts_left_ = most_attempts;
  std::vector<bool> drop_; // of the illuminator's diodes
};

// How far apart the lengths of paths from any diode over any visible point to the lens can be.
double path_spread_m(const std::vector<VisibleBox> &pieces, const VisibleBox &lights) {
  const VisibleBox lens{glm::dvec3(0.0), glm::dvec3(0.0)};
  double least_m = std::numeric_limits<double>::infinity(), largest_m = 0.0;
  for (const VisibleBox &piece : pieces) {
    least_m = std::min(least_m, least_distance_m(piece, lights) + least_distance_m(piece, lens));
    largest_m = std::max(largest_m, largest_distance_m(piece, lights) + largest_distance_m(piece, lens));
  }
  return largest_m - least_m;
}

// Bound of sin(phase) / (2 k) where the total's phase differs from that of a path.
double distance_per_re_m(const std::vector<CameraIlluminator> &illuminators, double spread_m,
                         double smallest_wavenumber_rad_m) {
  double least_rad = std::numeric_limits<double>::infinity(), largest_rad = -least_rad;
  for (const CameraIlluminator &illuminator : illuminators) {
    least_rad = std::min(least_rad, illuminator.modulation_phase_rad);
    largest_rad = std::max(largest_rad, illuminator.modulation_phase_rad);
  }
  const double phase_rad = smallest_wavenumber_rad_m * spread_m + (largest_rad - least_rad);
  return std::sin(std::min(phase_rad, 0.5 * std::numbers::pi)) / (2.0 * smallest_wavenumber_rad_m);
}

} // namespace

ReducedLight whole_light(const std::vector<CameraIlluminator> &illuminators) {
  ReducedLight light{illuminators, {}};
  for (const CameraIlluminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes)
      light.lights.add(diode.position_m);
  return light;
}

ReducedLight reduce_diodes(const std::vector<CameraIlluminator> &illuminators,
                           const std::vector<VisibleBox> &visible, Backscatter backscatter,
                           std::vector<double> wavenumbers_rad_m, double max_error_m,
                           double max_amplitude_error) {
  ReducedLight result = whole_light(illuminators);
  if (visible.empty() || !(max_error_m > 0.0) || !(max_amplitude_error > 0.0))
    return result;
  std::vector<VisibleBox> pieces = pieces_of(visible, result.lights);
  std::ranges::sort(wavenumbers_rad_m);
  const double smallest = wavenumbers_rad_m.front(), largest = wavenumbers_rad_m.back();
  ErrorScale scale{std::move(wavenumbers_rad_m),
                   distance_per_re_m(illuminators, path_spread_m(pieces, result.lights), smallest),
                   0.5 / largest,
                   (1.0 - largest_amplitude_error) * max_error_m,
                   std::min(max_amplitude_error, largest_amplitude_error),
                   backscatter == Backscatter::lambert};
  Reducer reducer(std::move(pieces), scale, result);
  for (CameraIlluminator &illuminator : result.illuminators)
    reducer.reduce(illuminator);
  return result;
}

} // namespace pmdsim
