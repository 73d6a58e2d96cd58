#pragma once
// What a new setup may show: a room, the paper's ring and wall, and targets as cameras are measured with.

#include "engine/model/scene.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// What may be chosen of a kind; 0: the kind has no such thing.
struct StartSizes {
  double distance_m = 0.0;   // from the lens to the target, a ball's centre
  double size_m = 0.0;       // the target's width and height
  double depth_m = 0.0;      // of a step
  std::uint32_t spokes = 0;  // dark ones of a star
  std::uint32_t squares = 0; // of a checkerboard, in a row
};

// What is chosen in place of the defaults.
struct StartWishes {
  std::optional<double> distance_m, size_m, depth_m;
  std::optional<std::uint32_t> spokes, squares;
};

// What is seen, world frame, with the place of the lens; the camera looks along -Z of its frame, +Y up.
struct StartScene {
  Scene scene;
  glm::dvec3 camera_m{0.0};
  glm::dquat world_from_camera{1.0, 0.0, 0.0, 0.0};
};

struct StartRing {
  double radius_m;
  std::uint32_t count;
};

// The camera and the light of a new setup, as its file says them.
struct StartView {
  glm::uvec2 resolution{320, 240};
  double pixel_pitch_m = 15e-6, focal_length_m = 4e-3;
  std::uint32_t samples = 2;
  std::vector<StartRing> rings{{0.05, 24}}; // about the light's node
  glm::dvec3 light_m{0.0};                  // that node in the camera node's frame: x right, y up, z backward
  bool isotropic = false;                   // the diodes' pattern; else of order 1
  bool constant_backscatter = false;
  bool bounces = false;
  bool has_table = false; // the diodes are there as a table, too
};

struct StartKind {
  std::string_view name;  // "star"
  std::string_view about; // "a Siemens star: spokes that ..."
  // A comment of a few lines for the setup: what is to be seen in its pictures.
  std::string_view shows;
  std::string_view look_at; // the channels whose pictures show it
  bool deforms;             // `deform` is worth trying
  StartSizes defaults;      // size_m: for a distance of 1 m, as it grows with that
  StartView view;
  StartScene (*make)(const StartSizes &);
};

std::span<const StartKind> start_kinds();
// Null where there is none of that name.
const StartKind *find_start_kind(std::string_view name);

// Throws Error (usage), naming the option, for a wish that the kind does not have or that is out of bounds.
StartSizes sizes_of(const StartKind &kind, const StartWishes &wishes);

StartScene room_scene(const StartSizes &);
StartScene ring_scene(const StartSizes &sizes);
StartScene wall_scene(const StartSizes &sizes);
StartScene step_scene(const StartSizes &sizes);
StartScene star_scene(const StartSizes &sizes);
StartScene checkerboard_scene(const StartSizes &sizes);
StartScene ball_scene(const StartSizes &sizes);
StartScene corner_scene(const StartSizes &sizes);

} // namespace pmdsim
