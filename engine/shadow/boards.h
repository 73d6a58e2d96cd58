#pragma once
// The boards that carry the diodes: where each lies, and which windows of diodes are on it.

#include "engine/light/source_windows.h"

#include <algorithm>
#include <array>
#include <vector>

namespace pmdsim {

// A plane of diodes. Board frame: z = 0 is the plane, its origin the foot of the lens; the scene lies at z <
// 0. Windows whose diodes lie in no plane have a frame of the lens, and `is_flat` is false.
struct Board {
  glm::dmat3 rotation{1.0}; // board_from_camera: p -> rotation * p + translation_m
  glm::dvec3 translation_m{0.0};
  bool is_flat = false;
  double lens_z_m = 0.0;                  // the lens is at (0, 0, lens_z_m)
  double radius_m = 1e-3;                 // of the diodes about the origin, in x and y; a millimetre at least
  double lowest_m = 0.0, highest_m = 0.0; // z of the diodes
  // The supports of diodes, lens and origin along (1, 0), (-1, 0), (0, 1), (0, -1), and along the diagonals
  // (1, 1), (-1, -1), (1, -1), (-1, 1) of unit length, m.
  std::array<double, 8> supports_m{};
  std::vector<std::size_t> windows;

  // z below which samples are in front of all of the board, so that ways from there have slopes.
  double nearest_in_front_m() const { return std::min(lowest_m, lens_z_m) - 0.01 * radius_m - 1e-4; }
  glm::dvec3 in_frame(const glm::dvec3 &camera_m) const { return rotation * camera_m + translation_m; }
};

// Runs of a window that are swept at once: as many as fit shader::bundles_per_window, those that share a
// plane together and apart from others. `first_bundle`: among the window's.
struct WindowPart {
  SourceWindow runs;
  std::uint32_t first_bundle;
};
std::vector<WindowPart> parts_of(const SourceWindow &window, const SourceGroups &groups);

// Every window is on one board.
std::vector<Board> find_boards(const SourceGroups &groups, const std::vector<SourceWindow> &windows);

// The places of a window's diodes in the order of its bits, 32 to a bundle; where there are fewer in a
// bundle, the last one again. Camera frame, m.
std::vector<glm::dvec3> places_of(const SourceWindow &window, const SourceGroups &groups);

} // namespace pmdsim
