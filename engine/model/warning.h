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
    WarningKind{"all-dark", "A sensor sees the scene, but no light reaches what it sees."},
    WarningKind{"beyond-ambiguity", "Part of what a sensor sees lies beyond its ambiguity range."},
    WarningKind{"bounces-left-out", "The command leaves out light that bounces."},
    WarningKind{"claim-above-budget", "A frame's claimed error is far above what was asked for."},
    WarningKind{"dark-diagram-axis", "A radiation diagram is dark on the diode's axis."},
    WarningKind{"diode-inside-body", "Diodes lie inside a closed body, which their light cannot leave."},
    WarningKind{"diodes-turned-away", "Diodes shine on nothing that a sensor sees."},
    WarningKind{"earlier-frames-left", "Frames of another run stay in the output directory."},
    WarningKind{"electronics-left-out", "The command leaves out electronics, scatter and unwrapping."},
    WarningKind{"empty-scene", "The scene has neither triangles nor points."},
    WarningKind{"error-above-asked", "Some returns may be off by more than was asked for."},
    WarningKind{"field-of-view",
                "A sensor's field of view is so small or so wide that a length has the wrong unit."},
    WarningKind{"frames-overlap", "A frame's taps take longer than the time to the next frame."},
    WarningKind{"full-taps", "Taps will be full, as too many electrons are counted."},
    WarningKind{"gltf-animation-pointer",
                "Animations of the scene change other properties than nodes' places, which is ignored."},
    WarningKind{"gltf-anisotropy", "Materials of the scene have anisotropic reflections, which are ignored."},
    WarningKind{"gltf-camera", "No pose names the node of a camera of the scene."},
    WarningKind{"gltf-clearcoat", "Materials of the scene have clear coats, which are ignored."},
    WarningKind{"gltf-dispersion", "Materials of the scene disperse light, which is ignored."},
    WarningKind{"gltf-emission", "Materials of the scene emit light, which is ignored."},
    WarningKind{"gltf-extension", "The scene uses a glTF extension that is not supported."},
    WarningKind{"gltf-extras", "The scene has extras of pmdsim that mean nothing where they are."},
    WarningKind{"gltf-glossy", "Materials of the scene are glossy and taken for matt."},
    WarningKind{"gltf-instancing",
                "Nodes of the scene are drawn many times by an extension and are there once."},
    WarningKind{"gltf-ior", "Materials of the scene have refractive indices, which are ignored."},
    WarningKind{"gltf-iridescence", "Materials of the scene are iridescent, which is ignored."},
    WarningKind{"gltf-lights", "The scene has lights, which are ignored."},
    WarningKind{"gltf-metallic", "Materials of the scene are metallic and taken for matt."},
    WarningKind{"gltf-normal-map", "Materials of the scene have normal maps, which are ignored."},
    WarningKind{"gltf-occlusion-map", "Materials of the scene have occlusion maps, which are ignored."},
    WarningKind{"gltf-scenes", "The glTF file has several scenes, of which one is taken."},
    WarningKind{"gltf-sheen", "Materials of the scene have a sheen, which is ignored."},
    WarningKind{"gltf-specular",
                "Materials of the scene have specular reflections of their own, which are ignored."},
    WarningKind{"gltf-specular-glossiness", "Materials of the scene have colours that are not read."},
    WarningKind{"gltf-transmission", "Materials of the scene let light through and are taken for opaque."},
    WarningKind{"gltf-unlit", "Materials of the scene are unlit and taken for matt."},
    WarningKind{"gltf-variants", "The scene has variants of materials, which are ignored."},
    WarningKind{"gltf-vertex-colours",
                "Meshes of the scene have more vertex colours than the first, which are ignored."},
    WarningKind{"gltf-visibility",
                "Nodes of the scene are hidden by an extension and are there all the same."},
    WarningKind{"gltf-volume", "Materials of the scene have a volume and are taken for opaque."},
    WarningKind{"image-is-phase",
                "An image to correct fills 0 to 2 pi as phases do, and is taken for distances."},
    WarningKind{"image-unit",
                "An image to correct has so large distances that they seem to be in another unit."},
    WarningKind{"light-left-behind", "A sensor moves away from light beside it that stays."},
    WarningKind{"mode-left-out", "A mode that cannot reach the accuracy asked for is left out."},
    WarningKind{"no-camera-node", "A sensor is at a node without a camera, in a scene that has cameras."},
    WarningKind{"no-locks", "The output's file system has no locks."},
    WarningKind{"nothing-in-view", "No ray of a sensor meets the scene."},
    WarningKind{"other-light-unused", "Light of other cameras meets a sensor without electronics."},
    WarningKind{"points-without-bounces", "Light that bounces does not heed points."},
    WarningKind{"saturated", "Many pixels of a frame have a full tap."},
    WarningKind{"scene-in-millimetres", "The scene is so large that its lengths seem to be millimetres."},
    WarningKind{"sensor-inside-body", "A sensor's lens lies inside a closed body."},
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
