// Mistakes in a setup that is JSON: its keys, its values, and the names that it refers to.

#include "tests/program/program.h"
#include "tests/whole/mistakes/mistakes.h"

namespace pmdsim::test {
namespace {

constexpr int warned = 0;

// `check` of the good setup with `from` replaced by `to`.
Mistake changed(const std::string &written, const std::string &from, const std::string &to,
                const std::vector<std::string> &told, const std::string &remedy, int exit_code = 3) {
  return {written, {"check", "setup.json"}, {{"setup.json", with(good_setup(), from, to)}}, exit_code, told,
          remedy};
}

// A key in place of another.
Mistake misspelt(const std::string &from, const std::string &to, const std::vector<std::string> &told,
                 const std::string &remedy) {
  return changed("`\"" + to + "\"`", "\"" + from + "\":", "\"" + to + "\":", told, remedy);
}

} // namespace

std::string good_setup() {
  return R"({
  "scene": "wall.gltf",
  "sensors": [{
    "name": "pmd",
    "resolution": [8, 8],
    "pixel_pitch_m": [45e-6, 45e-6],
    "focal_length_m": 0.0018,
    "modulation_hz": [20e6]
  }],
  "illuminators": [{
    "name": "ring",
    "pose": {"sensor": "pmd"},
    "diodes": {"rings": [{"radius_m": 0.146, "count": 16}]},
    "pattern": {"order": 3}
  }]
}
)";
}

Mistakes key_mistakes() {
  return {
      "Keys of a setup",
      {misspelt("resolution", "resolutions", {"setup.json:5:5: /sensors/0:", "did you mean \"resolution\"?"},
                "`resolution`, columns and rows in one list"),
       misspelt("modulation_hz", "modulation_Hz",
                {"setup.json:8:5: /sensors/0:", "\"modulation_hz\", in hertz"},
                "Small letters: keys and their units have no others"),
       misspelt("focal_length_m", "focal_length_mm", {"setup.json:7:5:", "\"focal_length_m\", in metres"},
                "Metres: 1.8 mm are `0.0018`, or `1.8e-3`"),
       misspelt("pixel_pitch_m", "pixel_pitch", {"setup.json:6:5:", "\"pixel_pitch_m\", in metres"},
                "Metres, along columns and rows: `[45e-6, 45e-6]`"),
       misspelt("modulation_hz", "frequency", {"setup.json:8:5:", "\"modulation_hz\", in hertz"},
                "`\"modulation_hz\": [20e6]`"),
       misspelt("focal_length_m", "fov_deg", {"setup.json:7:5:", "\"focal_length_m\", in metres"},
                "Columns times pitch over 2 tan(field of view / 2); `pmdsim check` tells the field of view"),
       misspelt("resolution", "width", {"setup.json:5:5:", "\"resolution\""}, "`\"resolution\": [640, 480]`"),
       misspelt("illuminators", "iluminators", {"setup.json:10:3:", "\"illuminators\""}, "`illuminators`"),
       misspelt("scene", "Scene", {"setup.json:2:3:", "\"scene\""}, "Small letters"),
       changed("`\"samples\"` beside `\"scene\"`", "\"sensors\"", "\"samples\": 4, \"sensors\"",
               {"setup.json:3:3:", "it belongs to /sensors/0"}, "Each sensor has its own samples"),
       changed("`\"fps\": 25` in `frames`", "\"sensors\"",
               "\"frames\": {\"count\": 3, \"fps\": 25}, \"sensors\"",
               {"setup.json:3:26: /frames:", "\"rate_hz\", in hertz"}, "`\"rate_hz\": 25`"),
       changed("`\"up\"` beside `\"node\"`", "\"focal_length_m\"",
               "\"pose\": {\"node\": \"Wall\", \"up\": [0, 1, 0]}, \"focal_length_m\"",
               {"setup.json:7:30: /sensors/0/pose:", "unknown key \"up\"", "expected \"node\""},
               "A node has its own directions"),
       changed("no `\"modulation_hz\"`", ",\n    \"modulation_hz\": [20e6]", "",
               {"setup.json:3:15: /sensors/0:", "missing key \"modulation_hz\""},
               "`\"modulation_hz\": [20e6]`")}};
}

Mistakes value_mistakes() {
  return {
      "Values of a setup",
      {changed("`\"resolution\": \"640x480\"`", "[8, 8]", "\"640x480\"",
               {"setup.json:5:19: /sensors/0/resolution:", "write [640, 480]"}, "A list of two numbers"),
       changed("`\"resolution\": [640, 480, 1]`", "[8, 8]", "[640, 480, 1]",
               {"setup.json:5:19: /sensors/0/resolution:", "an array of 2", "found an array of 3"},
               "Columns and rows alone"),
       changed("`\"resolution\": [640.5, 480]`", "[8, 8]", "[640.5, 480]",
               {"setup.json:5:20: /sensors/0/resolution/0:", "an integer", "found 640.5"}, "Whole pixels"),
       changed("`\"pixel_pitch_m\": 45e-6`", "[45e-6, 45e-6]", "45e-6",
               {"setup.json:6:22: /sensors/0/pixel_pitch_m:", "write [4.5e-05, 4.5e-05]"},
               "One along the columns and one along the rows"),
       changed("`\"modulation_hz\": 20e6`", "[20e6]", "20e6",
               {"setup.json:8:22: /sensors/0/modulation_hz:", "write [20000000]"},
               "A list, as there may be several frequencies"),
       changed("`\"modulation_hz\": [\"20 MHz\"]`", "[20e6]", "[\"20 MHz\"]",
               {"setup.json:8:23: /sensors/0/modulation_hz/0:", "write 20000000"},
               "A number of hertz: `20e6`"),
       changed("`\"modulation_hz\": [-20e6]`", "[20e6]", "[-20e6]",
               {"setup.json:8:23: /sensors/0/modulation_hz/0:", "a number from 1"}, "A frequency above 0"),
       changed("`\"modulation_hz\": [20]`", "[20e6]", "[20]",
               {"setup.json: /sensors/0/modulation_hz/0: 20 Hz", "20e6"}, "Hertz: 20 MHz are `20e6`", warned),
       changed("`\"samples\": 0`", "\"focal_length_m\"", "\"samples\": 0, \"focal_length_m\"",
               {"setup.json:7:16: /sensors/0/samples:", "an integer from 1 to 16", "found 0"},
               "1, or more for smooth edges"),
       changed("`\"taps\": 2`", "\"focal_length_m\"", "\"taps\": 2, \"focal_length_m\"",
               {"setup.json:7:13: /sensors/0/taps:", "3 to 16", "found 2"}, "4, as most cameras have"),
       changed("`\"focal_length_m\": 12`", "0.0018", "12",
               {"setup.json: /sensors/0/focal_length_m: 12 m", "12e-3"}, "Metres: 12 mm are `12e-3`", warned),
       changed("`\"pixel_pitch_m\": [-45e-6, 45e-6]`", "[45e-6, 45e-6]", "[-45e-6, 45e-6]",
               {"setup.json:6:23: /sensors/0/pixel_pitch_m/0:", "1e-09"}, "A pitch above 0"),
       changed("`\"fill_factor\": [90, 90]`", "\"focal_length_m\"",
               "\"fill_factor\": [90, 90], \"focal_length_m\"",
               {"setup.json:7:21: /sensors/0/fill_factor/0:", "at most 1", "found 90"},
               "A share: 90 % are `0.9`"),
       changed("`\"backscatter\": \"lambertian\"`", "\"sensors\"",
               "\"backscatter\": \"lambertian\", \"sensors\"",
               {"setup.json:3:18: /backscatter:", "did you mean \"lambert\"?"}, "`lambert`"),
       changed("`\"waveform\": \"sinus\"`", "\"focal_length_m\"",
               "\"waveform\": \"sinus\", \"focal_length_m\"",
               {"setup.json:7:17: /sensors/0/waveform:", "did you mean \"sine\"?"}, "`sine`"),
       changed("`\"vignetting\": \"cos^4\"`", "\"focal_length_m\"",
               "\"vignetting\": \"cos^4\", \"focal_length_m\"",
               {"setup.json:7:19: /sensors/0/vignetting:", "did you mean \"cos4\"?"}, "`cos4`"),
       changed("`\"shadows\": true`", "\"sensors\"", "\"shadows\": true, \"sensors\"",
               {"setup.json:3:14: /shadows:", "\"auto\" or \"off\"", "found true"},
               "`auto`, as it is without the key"),
       changed("`\"sensors\": {...}`", "\"sensors\": [{", "\"sensors\": {\"name\": \"a\"}, \"x\": [{",
               {"setup.json:3:14: /sensors:", "found an object", "write [{...}]"},
               "A list, as there may be several"),
       changed("`\"intensity_w_sr\": -1`", "\"pattern\"", "\"intensity_w_sr\": -1, \"pattern\"",
               {"setup.json:14:23: /illuminators/0/intensity_w_sr:", "found -1"}, "0 or more"),
       changed("`\"frames\": {\"count\": 10}`", "\"sensors\"", "\"frames\": {\"count\": 10}, \"sensors\"",
               {"setup.json:3:13: /frames:", "missing key \"rate_hz\""}, "`\"rate_hz\"`, frames a second")}};
}

Mistakes reference_mistakes() {
  const std::string look_at = "\"pose\": {\"position_m\": [0, 0, 0], \"look_at_m\": ";
  const auto posed = [&](const std::string &written, const std::string &pose,
                         const std::vector<std::string> &told, const std::string &remedy) {
    return changed(written, "\"focal_length_m\"", pose + ", \"focal_length_m\"", told, remedy);
  };
  return {
      "Names and directions in a setup",
      {posed("a node that is not there", "\"pose\": {\"node\": \"Wal\"}",
             {"setup.json:7:22: /sensors/0/pose/node:", "wall.gltf", "did you mean \"Wall\"?"},
             "The name as the scene has it"),
       posed("a node that is nothing like those there", "\"pose\": {\"node\": \"Camera\"}",
             {"setup.json:7:22: /sensors/0/pose/node:", "no node \"Camera\"", "has no camera",
              "Blender: Include, Cameras", "position_m and look_at_m", "its nodes are \"Wall\""},
             "Export cameras, too, or give a position"),
       posed("the name of a mesh in place of its node's", "\"pose\": {\"node\": \"Plane.001\"}",
             {"setup.json:7:22: /sensors/0/pose/node:", "the mesh of the node \"Wall\""}, "The node's name"),
       {"a node that is no camera, where the scene has one",
        {"check", "setup.json"},
        {{"setup.json",
          with(good_setup(), "\"focal_length_m\"", "\"pose\": {\"node\": \"Wall\"}, \"focal_length_m\"")},
         {"wall.gltf",
          with(with(wall_gltf(), "\"nodes\": [0]", "\"nodes\": [0, 1]"), "{\"name\": \"wall\", \"mesh\": 0}",
               "{\"name\": \"Wall\", \"mesh\": 0}, {\"name\": \"Camera\", \"camera\": 0}")}},
        warned,
        {"setup.json: /sensors/0/pose/node:", "\"Wall\" is no camera", "\"Camera\""},
        "The camera's node"},
       changed(
           "an illuminator at a sensor that is not there", "{\"sensor\": \"pmd\"}", "{\"sensor\": \"pdm\"}",
           {"setup.json:12:24: /illuminators/0/pose/sensor:", "did you mean \"pmd\"?"}, "The sensor's name"),
       changed("two sensors of one name", "\"sensors\": [{",
               "\"sensors\": [{\"name\": \"pmd\", \"resolution\": [8, 8], \"pixel_pitch_m\": [1e-5, 1e-5],\n"
               "    \"focal_length_m\": 0.0018, \"modulation_hz\": [20e6]}, {",
               {"setup.json:5:13: /sensors/1/name:", "found \"pmd\""}, "A name for each"),
       posed("`look_at_m` at the sensor itself", look_at + "[0, 0, 0]}",
             {"setup.json:7:52: /sensors/0/pose/look_at_m:", "other than position_m"},
             "A point in front of it"),
       posed("`up` along the view", look_at + "[0, 1, 0], \"up\": [0, 1, 0]}",
             {"setup.json:7:69: /sensors/0/pose/up:", "a direction across the view"},
             "Another `up`, as `[0, 0, 1]`"),
       posed("`up` of zero", look_at + "[0, 0, 1], \"up\": [0, 0, 0]}",
             {"setup.json:7:69: /sensors/0/pose/up:", "expected a direction, found zero"}, "`[0, 1, 0]`"),
       changed("`\"pattern\"` beside a file of diodes", "{\"rings\": [{\"radius_m\": 0.146, \"count\": 16}]}",
               "{\"file\": \"diodes.csv\"}", {"setup.json:14:16: /illuminators/0/pattern:", "a diode file"},
               "The file has a column `pattern`"),
       changed("`\"radius_m\": 146`", "0.146", "146",
               {"setup.json: /illuminators/0/diodes:", "146 m from the illuminator's origin", "0.146",
                "[unusual-value]"},
               "Metres: 146 mm are `0.146`", warned),
       changed("a ring without `count`", ", \"count\": 16", "",
               {"setup.json:13:26: /illuminators/0/diodes/rings/0:", "missing key \"count\""},
               "How many diodes the ring has"),
       {"`--poses pdm=poses.csv`",
        {"check", "setup.json", "--poses", "pdm=poses.csv"},
        {},
        3,
        {"setup.json: /nodes/pdm (by --poses):", "no node \"pdm\"", "expected \"Wall\""},
        "The name of a sensor, an illuminator or a node"}}};
}

} // namespace pmdsim::test
