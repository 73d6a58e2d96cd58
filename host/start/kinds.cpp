#include "host/start/kinds.h"

#include "engine/model/error.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace pmdsim {
namespace {

const StartView paper_view{.resolution = {640, 640},
                           .pixel_pitch_m = 45e-6,
                           .focal_length_m = 0.144,
                           .samples = 1,
                           .rings = {{0.126, 48}, {0.136, 48}, {0.146, 48}, {0.156, 48}, {0.166, 48}},
                           .isotropic = true,
                           .constant_backscatter = true};

const StartView corner_view{
    .resolution = {160, 120}, .pixel_pitch_m = 30e-6, .samples = 1, .rings = {{0.05, 48}}, .bounces = true};

const StartView room_view{.light_m = {-0.2, 0.0, 0.0}, .has_table = true};

const std::array<StartKind, 8> kinds{
    {{"room",
      "a room with bodies that cast shadows, and a ring of diodes beside the lens",
      "A room: a table with a ball on it, a crate, a column and a dark cabinet before two walls.\n"
      "The light stands 0.2 m to the left of the lens, so bodies cast shadows with soft edges (lit).\n"
      "Amplitude falls with the distance, and where no diode shines a distance has no value.",
      "amplitude, distance_m and lit",
      true,
      {},
      room_view,
      room_scene},
     {"ring",
      "the paper's five rings of 240 diodes, and the wall of its figure 11",
      "The paper's figure 11: five rings of 48 diodes around the lens, and a wall that fills the view.\n"
      "Every diode is farther from the wall than the lens is, so all distances come out too long by\n"
      "nearly the same length, 2.6 mm at 2 m: `pmdsim deform` shows it.",
      "distance_m",
      true,
      {.distance_m = 2.0, .size_m = 0.2},
      paper_view,
      ring_scene},
     {"wall",
      "a wall square to the optical axis that fills the view",
      "A wall square to the optical axis: z_m is the same everywhere, range_m grows towards the\n"
      "corners, and distance_m differs from range_m by what the light's place beside the lens adds.",
      "amplitude and distance_m",
      true,
      {.distance_m = 2.0, .size_m = 1.6},
      {},
      wall_scene},
     {"step",
      "two halves of a wall, the right one farther by a depth",
      "A step: the right half of the wall stands farther than the left by the step's depth. Pixels on\n"
      "the edge see both halves and measure something between them.",
      "distance_m and lit",
      true,
      {.distance_m = 2.0, .size_m = 1.6, .depth_m = 0.1},
      {},
      step_scene},
     {"star",
      "a Siemens star: dark and light spokes that narrow towards the middle",
      "A Siemens star: all of it lies in one plane. Where spokes become narrower than a pixel the\n"
      "amplitude turns grey, which tells the resolution; distances must not follow the spokes.",
      "amplitude and distance_m",
      false,
      {.distance_m = 2.0, .size_m = 0.8, .spokes = 36},
      {},
      star_scene},
     {"checkerboard",
      "a checkerboard, as lenses are calibrated with",
      "A checkerboard, as lenses are calibrated with: all of it lies in one plane, and the amplitude\n"
      "shows the squares. There is one row fewer than columns, so that a detector knows which way is up.",
      "amplitude and distance_m",
      false,
      {.distance_m = 2.0, .size_m = 0.9, .squares = 9},
      {},
      checkerboard_scene},
     {"ball",
      "a ball before a wall, whose radius distances must give back",
      "A ball of known radius before a wall: the points that follow from range_m lie on a sphere, and\n"
      "its shadow falls on the wall behind it.",
      "amplitude, distance_m and lit",
      true,
      {.distance_m = 2.0, .size_m = 0.4},
      {},
      ball_scene},
     {"corner",
      "two walls that meet at a right angle, with light that bounces between them",
      "Two walls that meet at a right angle. Light that comes from one wall by way of the other takes a\n"
      "longer way, so that the corner looks rounded: multipath_m is how much too far it is measured.",
      "distance_m and multipath_m",
      false,
      {.distance_m = 2.0, .size_m = 1.0},
      corner_view,
      corner_scene}}};

[[noreturn]] void refuse(const char *option, std::string_view expected, std::string_view found) {
  throw Error(ExitCode::usage, fmt::format("{}: expected {}, found {}", option, expected, found));
}

// The wish, or the default; `least` and `most` are its bounds.
template <class Number>
Number chosen(const StartKind &kind, const char *option, const std::optional<Number> &wish, Number standard,
              Number least, Number most) {
  if (!wish)
    return standard;
  if (standard == Number{})
    refuse(option, fmt::format("none, as {} has no such size", kind.name), fmt::format("{}", *wish));
  if (!(*wish >= least && *wish <= most))
    refuse(option, fmt::format("a number from {} to {}", least, most), fmt::format("{}", *wish));
  return *wish;
}

} // namespace

std::span<const StartKind> start_kinds() { return kinds; }

const StartKind *find_start_kind(std::string_view name) {
  const auto found = std::ranges::find(kinds, name, &StartKind::name);
  return found == kinds.end() ? nullptr : &*found;
}

StartSizes sizes_of(const StartKind &kind, const StartWishes &wishes) {
  StartSizes sizes = kind.defaults;
  sizes.distance_m = chosen(kind, "--distance-m", wishes.distance_m, sizes.distance_m, 0.1, 100.0);
  sizes.size_m = chosen(kind, "--size-m", wishes.size_m, sizes.size_m * sizes.distance_m, 0.01, 1000.0);
  sizes.depth_m = chosen(kind, "--depth-m", wishes.depth_m, sizes.depth_m, 0.0001, 100.0);
  sizes.spokes = chosen(kind, "--spokes", wishes.spokes, sizes.spokes, 2u, 1000u);
  sizes.squares = chosen(kind, "--squares", wishes.squares, sizes.squares, 3u, 200u);
  if (kind.name == "ball" && sizes.size_m > 1.5 * sizes.distance_m)
    refuse("--size-m",
           fmt::format("at most {:g}, or the lens would be inside the ball", 1.5 * sizes.distance_m),
           fmt::format("{}", sizes.size_m));
  return sizes;
}

} // namespace pmdsim
