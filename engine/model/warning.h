#pragma once
// What is odd about a setup, a scene or a frame without being wrong, and every kind of it that there is.
// docs/warnings.md explains each kind; a test compares the two.

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace pmdsim {

// Told once a run: in the terminal, in manifests and reports, in JSON and in Python. With --strict it is an
// error.
struct Warning {
  std::string code;  // of warning_kinds, e.g. "nothing-in-view"; stays the same from version to version
  std::string place; // what it is about: "setup.json: /sensors/0", "scene.gltf", "sensor pmd"
  std::string text;  // what is seen and what helps, in one line

  bool operator==(const Warning &) const = default;
};

struct WarningKind {
  std::string_view code;
  std::string_view means; // a sentence
};

// In the order of their codes.
inline constexpr std::array warning_kinds{
    WarningKind{"beyond-ambiguity", "Part of what a sensor sees lies beyond its ambiguity range."},
    WarningKind{"bounces-left-out", "The command leaves out light that bounces."},
    WarningKind{"dark-diagram-axis", "A radiation diagram is dark on the diode's axis."},
    WarningKind{"electronics-left-out", "The command leaves out electronics, scatter and unwrapping."},
    WarningKind{"empty-scene", "The scene has neither triangles nor points."},
    WarningKind{"error-above-asked", "Some returns may be off by more than was asked for."},
    WarningKind{"frames-overlap", "A frame's taps take longer than the time to the next frame."},
    WarningKind{"full-taps", "Taps will be full, as too many electrons are counted."},
    WarningKind{"lambert-for-bounces", "Light that bounces takes shiny materials for matt ones."},
    WarningKind{"mode-left-out", "A mode that cannot reach the accuracy asked for is left out."},
    WarningKind{"no-camera-node", "A sensor is at a node without a camera, in a scene that has cameras."},
    WarningKind{"no-locks", "The output's file system has no locks."},
    WarningKind{"nothing-in-view", "No ray of a sensor meets the scene."},
    WarningKind{"other-light-unused", "Light of other cameras meets a sensor without electronics."},
    WarningKind{"points-without-bounces", "Light that bounces does not heed points."},
    WarningKind{"tap-by-tap-exact", "Taps that are taken one after the other are measured in mode exact."},
    WarningKind{"unseen-harmonics", "None of a waveform's harmonics shows in the taps."},
    WarningKind{"unusual-value", "A value is so unusual that it may be in another unit than was meant."},
};

// The code itself; one that is not in the table does not compile.
consteval const char *warning_code(const char *code) {
  if (std::ranges::find(warning_kinds, std::string_view(code), &WarningKind::code) == warning_kinds.end())
    throw "not in warning_kinds";
  return code;
}

} // namespace pmdsim
