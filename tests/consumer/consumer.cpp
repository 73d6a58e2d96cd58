// A program in C++ with libpmdsim: a wall that is moved from 2 m to 1.5 m away, measured by 8 x 8 pixels at
// either place. Ends with 1 where the middle does not see it there, to some millimetres.
#include <cmath>
#include <cstdint>
#include <iostream>
#include <pmdsim.hpp>
#include <vector>

namespace {

const char *const setup = R"({
  "sensors": [{"name": "pmd", "resolution": [8, 8], "pixel_pitch_m": [45e-6, 45e-6], "focal_length_m": 0.02,
               "modulation_hz": [20e6]}],
  "illuminators": [{"name": "lamp", "pose": {"sensor": "pmd"},
                    "diodes": {"rings": [{"radius_m": 0.02, "count": 8}]}}]})";

float middle_m(pmdsim::Simulator &simulator) {
  const pmdsim::Frame frame = simulator.render();
  const pmdsim::Channel distance = frame["distance_m"];
  return distance.floats()[4 * distance.columns + 4];
}

} // namespace

int main() {
  const std::vector<double> corners_m{-1, -1, -2, 1, -1, -2, 1, 1, -2, -1, 1, -2};
  const std::vector<std::uint32_t> triangles{0, 1, 2, 0, 2, 3};
  pmdsim::Mesh mesh;
  mesh.positions_m = corners_m.data();
  mesh.vertex_count = corners_m.size() / 3;
  mesh.triangles = triangles.data();
  mesh.triangle_count = triangles.size() / 3;
  try {
    pmdsim::Simulator simulator;
    simulator.load_mesh(setup, mesh);
    const float far_m = middle_m(simulator);
    // The camera goes half a metre ahead, which is -z.
    simulator.set(
        R"({"sensors/pmd/pose": {"position_m": [0, 0, -0.5], "look_at_m": [0, 0, -2], "up": [0, 1, 0]}})");
    const float near_m = middle_m(simulator);
    std::cout << "C++, pmdsim " << pmdsim_version() << ": " << far_m << " m, " << near_m << " m\n";
    return std::abs(far_m - 2) < 5e-3F && std::abs(near_m - 1.5F) < 5e-3F ? 0 : 1;
  } catch (const pmdsim::Error &error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
