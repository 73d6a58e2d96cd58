#include "host/input/calibration/calibration_terms.h"

#include "host/input/schema/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace pmdsim {
namespace {

constexpr const char *opencv_order[] = {"k1", "k2", "p1", "p2", "k3", "k4",   "k5",
                                        "k6", "s1", "s2", "s3", "s4", "tauX", "tauY"};
constexpr std::size_t first_rational = 5, first_prism = 8, tau_x = 12, tau_y = 13;

void set_brown(const CalibrationKey &key, std::vector<double> d, Calibration &calibration) {
  constexpr std::array<std::size_t, 5> sizes{4, 5, 8, 12, 14};
  if (std::ranges::find(sizes, d.size()) == sizes.end())
    throw input_error(key, fmt::format("expected 4, 5, 8, 12 or 14 numbers, found {}", d.size()));
  d.resize(std::size(opencv_order));
  for (std::size_t term = first_rational; term < tau_x; ++term)
    if (d[term] != 0.0)
      throw input_error(key,
                        fmt::format("{}: expected 0: pmdsim has no {} terms, found {}", opencv_order[term],
                                    term < first_prism ? "rational" : "thin prism", d[term]));
  for (const std::size_t tilt : {tau_x, tau_y})
    if (std::abs(glm::degrees(d[tilt])) > max_chip_tilt_deg)
      throw input_error(key, fmt::format("{}: expected a tilt within {} degrees, found {} rad",
                                         opencv_order[tilt], max_chip_tilt_deg, d[tilt]));
  if (std::any_of(d.begin(), d.begin() + first_rational, [](double c) { return c != 0.0; }))
    calibration.distortion = BrownConrady{d[0], d[1], d[2], d[3], d[4]};
  calibration.tau_x_rad = d[tau_x];
  calibration.tau_y_rad = d[tau_y];
}

} // namespace

void set_camera_matrix(const CalibrationKey &key, const std::vector<double> &fx_fy_cx_cy,
                       Calibration &calibration) {
  const double fx = fx_fy_cx_cy.at(0), fy = fx_fy_cx_cy.at(1);
  if (!(fx > 0.0) || !(fy > 0.0))
    throw input_error(key, fmt::format("expected fx and fy above 0, found {} and {}", fx, fy));
  calibration.fx = fx, calibration.cx = fx_fy_cx_cy.at(2);
  calibration.fy = fy, calibration.cy = fx_fy_cx_cy.at(3);
  calibration.camera_matrix_at = key;
}

void read_camera_matrix(const CalibrationEntry &entry, Calibration &calibration, MatrixOrder order) {
  const CalibrationKey &key = entry.key;
  std::vector<double> m = numbers_of(entry, 9);
  if (m.size() != 9)
    throw input_error(key, fmt::format("expected 3 x 3 numbers, found {}", m.size()));
  if (order == MatrixOrder::columns)
    for (const auto &[a, b] : {std::pair(1, 3), std::pair(2, 6), std::pair(5, 7)})
      std::swap(m[static_cast<std::size_t>(a)], m[static_cast<std::size_t>(b)]);
  if (m[1] != 0.0)
    throw input_error(key, fmt::format("expected 0 in row 1, column 2: pmdsim has no skew, found {}", m[1]));
  if (m[3] != 0.0 || m[6] != 0.0 || m[7] != 0.0 || m[8] != 1.0)
    throw input_error(key, "expected [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  set_camera_matrix(key, {m[0], m[4], m[2], m[5]}, calibration);
}

void set_distortion(const CalibrationKey &key, const std::vector<double> &d, DistortionModel model,
                    Calibration &calibration) {
  calibration.distortion_at = key;
  for (const double coefficient : d)
    if (std::abs(coefficient) > max_distortion)
      throw input_error(key, fmt::format("expected coefficients from {} to {}, found {}", -max_distortion,
                                         max_distortion, coefficient));
  if (model == DistortionModel::nameless && !std::ranges::all_of(d, [](double c) { return c == 0.0; }))
    throw input_error(key, "expected no coefficients but 0 beside an empty distortion_model");
  if (model == DistortionModel::nameless || (model == DistortionModel::brown && d.empty()))
    return;
  if (model == DistortionModel::brown)
    return set_brown(key, d, calibration);
  if (d.size() != 4) // an empty list, too: a fisheye without coefficients is no pinhole
    throw input_error(key, fmt::format("expected the fisheye's k1 to k4, found {} numbers", d.size()));
  calibration.distortion = Fisheye{d[0], d[1], d[2], d[3]};
}

void read_distortion(const CalibrationEntry &entry, DistortionModel model, Calibration &calibration) {
  set_distortion(entry.key, numbers_of(entry, std::size(opencv_order)), model, calibration);
}

std::uint32_t pixels_of(const CalibrationKey &key, double number) {
  if (!(number >= 1.0 && number <= max_resolution) || number != std::floor(number))
    throw input_error(key, fmt::format("expected an integer from 1 to {}, found {}", max_resolution, number));
  return static_cast<std::uint32_t>(number);
}

glm::uvec2 size_of(const CalibrationEntry &entry) {
  const std::vector<double> size = numbers_of(entry, 2);
  if (size.size() != 2)
    throw input_error(entry.key, fmt::format("expected width and height, found {} numbers", size.size()));
  return {pixels_of(entry.key, size[0]), pixels_of(entry.key, size[1])};
}

} // namespace pmdsim
