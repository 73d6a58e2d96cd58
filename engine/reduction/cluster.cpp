#include "engine/reduction/cluster.h"

#include "engine/light/radiation_laws.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// Surfaces are asked to have a box in front of them that is larger than the cluster's by the first factor,
// and as thick as the second times its radius. Lambert's factor then varies less.
constexpr double clearance_over_extent = 2.0, clearance_over_radius = 0.05;
constexpr double flat_over_wide = 0.1; // of a cluster's spreads: flatter, it has axes of its own

// The cluster's own axes where it is flat or thin, else the camera's; within a plane as much along the
// camera's as can be, because the view is.
glm::dmat3 axes_of(const Eigen::Matrix3d &covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d spreads = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt(); // ascending
  const auto axis = [&](int i) {
    const Eigen::Vector3d v = solver.eigenvectors().col(i);
    return glm::dvec3(v[0], v[1], v[2]);
  };
  if (spreads[1] < flat_over_wide * spreads[2])
    return {axis(2), axis(1), axis(0)};
  if (spreads[0] >= flat_over_wide * spreads[1])
    return glm::dmat3(1.0);
  const glm::dvec3 normal = axis(0), size = glm::abs(normal);
  const glm::dvec3 camera_axis = size.x <= size.y ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 across = glm::normalize(camera_axis - glm::dot(camera_axis, normal) * normal);
  return {across, glm::cross(normal, across), normal};
}

// The powers that moments are made of.
std::array<std::vector<double>, std::tuple_size_v<Powers>>
power_tables(const DiodeCluster &cluster, const glm::dvec3 &offset_m, int largest) {
  const auto over = [](double part, double whole) { return whole > 0.0 ? part / whole : 0.0; };
  const auto coordinate = [&](int i) { return powers_of(over(offset_m[i], cluster.extents_m[i]), largest); };
  const double size = over(glm::length(offset_m), cluster.radius_m);
  return {powers_of(size * size, largest), coordinate(0), coordinate(1), coordinate(2),
          powers_of(over(glm::dot(cluster.axes * offset_m, cluster.beam), cluster.beam_extent_m), largest)};
}

} // namespace

DiodeCluster cluster_of(const std::vector<Diode> &diodes, std::span<const std::size_t> members) {
  DiodeCluster cluster;
  cluster.shares.resize(static_cast<Eigen::Index>(members.size()));
  double largest = 0.0;
  for (const std::size_t member : members)
    largest = std::max(largest, diodes[member].intensity_w_sr);
  for (std::size_t i = 0; i < members.size(); ++i)
    cluster.shares[static_cast<Eigen::Index>(i)] = diodes[members[i]].intensity_w_sr / largest;
  cluster.shares /= cluster.shares.sum();
  for (std::size_t i = 0; i < members.size(); ++i)
    cluster.centre_m += cluster.shares[static_cast<Eigen::Index>(i)] * diodes[members[i]].position_m;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::size_t member : members) {
    const glm::dvec3 p = diodes[member].position_m - cluster.centre_m;
    const Eigen::Vector3d v(p.x, p.y, p.z);
    covariance += v * v.transpose();
  }
  cluster.axes = axes_of(covariance);
  const Diode &first = diodes[members.front()];
  cluster.beam = first.axis;
  cluster.order = law_series(first.pattern).value().order;
  for (const std::size_t member : members) {
    const glm::dvec3 p = diodes[member].position_m - cluster.centre_m;
    const glm::dvec3 offset_m = glm::transpose(cluster.axes) * p;
    cluster.offsets_m.push_back(offset_m);
    cluster.extents_m = glm::max(cluster.extents_m, glm::abs(offset_m));
    cluster.radius_m = std::max(cluster.radius_m, glm::length(offset_m));
    cluster.beam_extent_m = std::max(cluster.beam_extent_m, std::abs(glm::dot(cluster.beam, p)));
  }
  cluster.clearance_m = glm::max(clearance_over_extent * cluster.extents_m,
                                 glm::dvec3(clearance_over_radius * cluster.radius_m));
  return cluster;
}

std::vector<double> powers_of(double base, int degree) {
  std::vector<double> powers{1.0};
  for (int k = 0; k < degree; ++k)
    powers.push_back(powers.back() * base);
  return powers;
}

Eigen::MatrixXd moment_values(const std::vector<Powers> &moments, const DiodeCluster &cluster,
                              std::span<const glm::dvec3> offsets_m) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(moments.size()),
                         static_cast<Eigen::Index>(offsets_m.size()));
  int largest = 0;
  for (const Powers &powers : moments)
    largest = std::max<int>(largest, std::ranges::max(powers));
  for (Eigen::Index diode = 0; diode < values.cols(); ++diode) {
    const auto tables = power_tables(cluster, offsets_m[static_cast<std::size_t>(diode)], largest);
    for (Eigen::Index moment = 0; moment < values.rows(); ++moment) {
      const Powers &powers = moments[static_cast<std::size_t>(moment)];
      double value = 1.0;
      for (std::size_t part = 0; part < powers.size(); ++part)
        value *= tables[part][powers[part]];
      values(moment, diode) = value;
    }
  }
  return values;
}

Eigen::VectorXd moments_of(const DiodeCluster &cluster, const std::vector<Powers> &moments) {
  constexpr std::size_t at_a_time = 512;
  const std::span<const glm::dvec3> offsets_m = cluster.offsets_m;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(moments.size()));
  for (std::size_t first = 0; first < offsets_m.size(); first += at_a_time) {
    const std::size_t count = std::min(at_a_time, offsets_m.size() - first);
    sums += moment_values(moments, cluster, offsets_m.subspan(first, count)) *
            cluster.shares.segment(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(count));
  }
  return sums;
}

} // namespace pmdsim
