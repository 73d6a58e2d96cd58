// The sensor's lens and chip as OpenCV describes a camera.

#include "host/output/files/manifest.h"

#include <array>
#include <cmath>

#include <cmath>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

std::string model_of(const Distortion &distortion) {
  if (std::holds_alternative<Fisheye>(distortion))
    return "fisheye";
  return std::holds_alternative<BrownConrady>(distortion) ? "brown" : "pinhole";
}

std::vector<double> distortion_of(const Distortion &distortion, const glm::dvec2 &tilt_rad) {
  if (const auto *fisheye = std::get_if<Fisheye>(&distortion))
    return {fisheye->k1, fisheye->k2, fisheye->k3, fisheye->k4};
  const auto *written = std::get_if<BrownConrady>(&distortion);
  const BrownConrady brown = written ? *written : BrownConrady{};
  std::vector<double> coefficients{brown.k1, brown.k2, brown.p1, brown.p2, brown.k3};
  if (tilt_rad != glm::dvec2(0.0)) {
    coefficients.resize(14, 0.0); // k4, k5, k6, s1, s2, s3, s4
    coefficients[12] = tilt_rad.x;
    coefficients[13] = tilt_rad.y;
  }
  return coefficients;
}

// Where OpenCV's (x''', y''') meets the chip before gamma turns it, as scale * (x''', y''') + offset_m. With
// R = (D1(alpha) D2(beta))^T, w = R * (x'', y'', 1) and tau = R * t the ray meets the plane of eq. 1 at tau_z
// * (w_x, w_y) / w_z - (tau_x, tau_y), while OpenCV has x''' = R33 w_x / w_z - R13, y''' = R33 w_y / w_z -
// R23.
struct TiltedPlane {
  double scale_m;
  glm::dvec2 offset_m;
};

TiltedPlane tilted_plane(const Sensor &sensor) {
  const glm::dvec3 cosine = glm::cos(sensor.chip.rotation_rad), sine = glm::sin(sensor.chip.rotation_rad);
  const glm::dvec3 third_column(-sine.y * cosine.x, sine.x, cosine.x * cosine.y); // R13, R23, R33
  const glm::dmat3 r_transposed(cosine.y, sine.x * sine.y, third_column.x,        // a row of R each
                                0.0, cosine.x, third_column.y,                    //
                                sine.y, -sine.x * cosine.y, third_column.z);
  const glm::dvec3 chip_m = glm::dvec3(0.0, 0.0, sensor.image_distance_m()) + sensor.chip.translation_m;
  const glm::dvec3 tau_m = chip_m * r_transposed;
  const double scale_m = tau_m.z / third_column.z;
  return {scale_m, scale_m * glm::dvec2(third_column) - glm::dvec2(tau_m)};
}

// Row by row; 0.0, not -0.0, where gamma is 0.
std::array<std::array<double, 3>, 3> camera_matrix_of(const Sensor &sensor) {
  const auto [scale_m, offset_m] = tilted_plane(sensor);
  const double gamma_rad = sensor.chip.rotation_rad.z;
  const double cosine = std::cos(gamma_rad), sine = std::sin(gamma_rad);
  const glm::dvec2 pitch_m = sensor.pixel_pitch_m;
  const glm::dvec2 chip_m(cosine * offset_m.x + sine * offset_m.y, cosine * offset_m.y - sine * offset_m.x);
  const glm::dvec2 centre = chip_m / pitch_m + 0.5 * (glm::dvec2(sensor.resolution) - 1.0);
  const glm::dvec2 focal = scale_m / pitch_m;
  return {{{focal.x * cosine, focal.x * sine, centre.x},
           {0.0 - focal.y * sine, focal.y * cosine, centre.y},
           {0.0, 0.0, 1.0}}};
}

ordered_json matrix_json(const Pose &a_from_b) {
  ordered_json rows = ordered_json::array();
  for (int row = 0; row < 3; ++row)
    rows.push_back({a_from_b.rotation[0][row], a_from_b.rotation[1][row], a_from_b.rotation[2][row],
                    a_from_b.translation_m[row]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

} // namespace

ordered_json camera_json(const Sensor &sensor) {
  const auto matrix = camera_matrix_of(sensor);
  const glm::dvec2 tilt_rad(sensor.chip.rotation_rad);
  const auto focal = [&](double pixels) {
    return sensor.chip.rotation_rad.z != 0.0 ? ordered_json(nullptr) : ordered_json(pixels);
  };
  ordered_json camera{{"model", model_of(sensor.distortion)},
                      {"fx", focal(matrix[0][0])},
                      {"fy", focal(matrix[1][1])},
                      {"cx", matrix[0][2]},
                      {"cy", matrix[1][2]},
                      {"camera_matrix", matrix},
                      {"distortion", distortion_of(sensor.distortion, tilt_rad)}};
  if (camera["model"] == "fisheye" && tilt_rad != glm::dvec2(0.0))
    camera["tilt_rad"] = {tilt_rad.x, tilt_rad.y};
  camera["world_from_camera"] = matrix_json(sensor.world_from_camera);
  return camera;
}

} // namespace pmdsim
