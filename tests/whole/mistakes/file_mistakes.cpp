// Mistakes about files: setups, scenes, tables of diodes, diagrams, poses, variants and calibrations.

#include "tests/program/program.h"
#include "tests/whole/mistakes/mistakes.h"

namespace pmdsim::test {
namespace {

constexpr const char *gltf_expected = "expected glTF 2.0 (.gltf or .glb)";
const std::string rings =
    "{\"rings\": [{\"radius_m\": 0.146, \"count\": 16}]},\n    \"pattern\": {\"order\": 3}";
const std::string columns = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";
const std::string diode_row = "0,0,0,0,0,1,1,3\n";

Mistake no_setup(const std::string &written, const std::string &file, const std::vector<std::string> &told,
                 const std::string &remedy,
                 const std::vector<std::pair<std::string, std::string>> &files = {}) {
  return {written, {"check", file}, files, 3, told, remedy};
}

// The setup names another scene.
Mistake scene(const std::string &written, const std::string &file, const std::string &text,
              const std::vector<std::string> &told, const std::string &remedy) {
  std::vector<std::pair<std::string, std::string>> files{
      {"setup.json", with(good_setup(), "wall.gltf", file)}};
  if (!text.empty())
    files.emplace_back(file, text);
  return {written, {"check", "setup.json"}, files, 3, told, remedy};
}

Mistake diodes(const std::string &written, const std::string &text, const std::vector<std::string> &told,
               const std::string &remedy, int exit_code = 3) {
  return {written,
          {"check", "setup.json"},
          {{"setup.json", with(good_setup(), rings, "{\"file\": \"diodes.csv\"}")}, {"diodes.csv", text}},
          exit_code,
          told,
          remedy};
}

Mistake diagram(const std::string &written, const std::string &file, const std::string &text,
                const std::vector<std::string> &told, const std::string &remedy) {
  return {
      written,
      {"check", "setup.json"},
      {{"setup.json", with(good_setup(), "{\"order\": 3}", "{\"file\": \"" + file + "\"}")}, {file, text}},
      3,
      told,
      remedy};
}

Mistake poses(const std::string &written, const std::string &text, const std::vector<std::string> &told,
              const std::string &remedy) {
  return {written, {"check", "setup.json", "--poses", "poses.csv"}, {{"poses.csv", text}}, 3, told, remedy};
}

Mistake variants(const std::string &written, const std::string &text, const std::vector<std::string> &told,
                 const std::string &remedy) {
  return {
      written, {"render", "setup.json", "--variants", "variants.jsonl"}, {{"variants.jsonl", text}}, 3, told,
      remedy};
}

Mistake calibration(const std::string &written, const std::string &file, const std::string &text,
                    const std::vector<std::string> &told, const std::string &remedy) {
  return {written, {"import-calibration", file}, {{file, text}}, 3, told, remedy};
}

std::string lines(std::size_t count, const std::string &line) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += line + "\n";
  return text;
}

} // namespace

Mistakes file_mistakes() {
  return {
      "Setups and scenes as files",
      {no_setup("`pmdsim check setpu.json`", "setpu.json",
                {"setpu.json: no such file", "did you mean \"setup.json\"?"}, "The file's name"),
       no_setup("`pmdsim check setup`", "setup", {"setup: no such file", "did you mean \"setup.json\"?"},
                "With its ending"),
       no_setup("`pmdsim check Setup.json`", "Setup.json", {"Setup.json: no such file", "\"setup.json\""},
                "Capitals count"),
       no_setup("`pmdsim check setups/setup.json`", "setups/setup.json",
                {"no such file", "there is no folder \"setups\""}, "The folder's name"),
       no_setup("`pmdsim check .`", ".", {".: is a directory, expected a file"}, "The file in it"),
       no_setup("`pmdsim check wall.gltf`", "wall.gltf", {"wall.gltf: is a glTF scene, expected a setup"},
                "A setup names the scene"),
       no_setup("`pmdsim check room.glb`", "room.glb",
                {"room.glb: is a binary glTF scene (.glb), expected a setup"}, "A setup names the scene",
                {{"room.glb", std::string("glTF\2\0\0\0\x0c\0\0\0", 12)}}),
       no_setup("`pmdsim check diodes.csv`", "diodes.csv",
                {"diodes.csv: is a table of diodes, expected a setup",
                 "\"illuminators\"[0].\"diodes\" = {\"file\": \"diodes.csv\"}"},
                "A setup names the table"),
       no_setup(
           "`pmdsim check image.npy`", "image.npy",
           {"image.npy: is an array of NumPy (.npy), expected a setup", "pmdsim correct setup.json IMAGE"},
           "The setup first", {{"image.npy", "\x93NUMPY"}}),
       scene("a scene that is not there", "wal.gltf", "",
             {"setup.json:2:12: /scene:", "no such file", "did you mean \"wall.gltf\"?"}, "The file's name"),
       scene("another case", "Wall.GLTF", "", {"setup.json:2:12: /scene:", "did you mean \"wall.gltf\"?"},
             "Capitals count"),
       scene("another ending", "wall.glb", "", {"setup.json:2:12: /scene:", "did you mean \"wall.gltf\"?"},
             "The file's ending"),
       scene("backslashes between folders", R"(.\\wall.gltf)", "",
             {"setup.json:2:12: /scene:", "expected / between folders"}, "`./wall.gltf`"),
       scene("an address", "https://example.org/wall.gltf", "",
             {"setup.json:2:12: /scene:", "expected a file of this machine"}, "Download it"),
       scene("a folder", ".", "", {"setup.json:2:12: /scene:", "is a directory, expected a file"},
             "The file in it"),
       scene("a Wavefront OBJ mesh", "wall.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
             {"wall.obj: is a Wavefront OBJ mesh", gltf_expected},
             "Export as glTF, from Blender for example"),
       scene("an STL mesh", "wall.stl", "solid wall\nendsolid wall\n",
             {"wall.stl: is an STL mesh", gltf_expected}, "Export as glTF"),
       scene("an FBX scene", "wall.fbx", "Kaydara FBX Binary  ", {"wall.fbx: is an FBX scene", gltf_expected},
             "Export as glTF"),
       scene("a Blender file", "wall.blend", "BLENDER-v300", {"wall.blend: is a Blender file", gltf_expected},
             "Export as glTF"),
       scene("a scene that gzip has packed", "wall.glb", "\x1f\x8b\x08",
             {"wall.glb: is a file that gzip has packed", gltf_expected},
             "`gunzip`; meshopt packs scenes within glTF"),
       scene("an empty scene file", "empty.gltf", " ", {"empty.gltf:1:2:", "expected JSON"}, "Export again"),
       scene("half a scene", "half.gltf", wall_gltf().substr(0, 200), {"half.gltf:", "the end of the file"},
             "Download or export it again"),
       scene("glTF 1.0", "old.gltf", with(wall_gltf(), "\"2.0\"", "\"1.0\""),
             {"old.gltf:2:24: /asset/version:", "expected \"2.0\""}, "Export as glTF 2.0"),
       scene("a scene whose buffer is not there", "wall2.gltf",
             with(wall_gltf(),
                  wall_gltf().substr(wall_gltf().find("data:"),
                                     wall_gltf().rfind('"') - wall_gltf().find("data:")),
                  "wall.bin"),
             {"wall2.gltf: /buffers/0/uri: \"wall.bin\": no such file"}, "Copy the .bin with the .gltf"),
       scene("a scene packed with Draco", "packed.gltf",
             with(wall_gltf(), "\"scene\": 0,",
                  "\"scene\": 0, \"extensionsRequired\": [\"KHR_draco_mesh_compression\"],"),
             {"packed.gltf:", "/extensionsRequired/0:", "Blender: Data, Compression off", "meshopt"},
             "Export again without compression"),
       scene("a scene with Basis textures", "basis.gltf",
             with(wall_gltf(), "\"scene\": 0,",
                  "\"scene\": 0, \"extensionsRequired\": [\"KHR_texture_basisu\"],"),
             {"basis.gltf:", "/extensionsRequired/0:", "PNG or JPEG textures"},
             "Export again with PNG or JPEG"),
       scene("a mesh that names an accessor that is not there", "bad.gltf",
             with(wall_gltf(), "\"indices\": 1", "\"indices\": 9"),
             {"bad.gltf:6:", "/meshes/0/primitives/0/indices", "9"}, "Export again")}};
}

Mistakes table_mistakes() {
  return {"Tables, diagrams, poses, variants and calibrations",
          {diodes("semicolons in a table of diodes", "x_m;y_m;z_m\n0;0;0\n",
                  {"diodes.csv:1:", "expected commas between the columns, found semicolons"}, "Commas"),
           diodes("tabs in it", "x_m\ty_m\tz_m\n0\t0\t0\n", {"diodes.csv:1:", "found tabs"}, "Commas"),
           diodes("decimal commas in it", columns + "0,1,0,0,0,0,1,1,3\n",
                  {"diodes.csv:2:", "expected 8 columns, found 9", "decimals have a point"}, "Points"),
           diodes("no header line", diode_row, {"diodes.csv:1:", "expected a header line"},
                  "`" + columns.substr(0, columns.size() - 1) + "`"),
           diodes("`x_mm`", with(columns, "x_m", "x_mm") + diode_row,
                  {"diodes.csv:1:", "\"x_mm\"", "\"x_m\", in metres"}, "Metres"),
           diodes("`x`", with(columns, "x_m", "x") + diode_row,
                  {"diodes.csv:1:", "\"x\"", "\"x_m\", in metres"}, "`x_m`"),
           diodes("`No`, `nx` and `dir_y`",
                  with(with(columns, "x_m", "No,x_m"), "axis_x,axis_y", "nx,dir_y") + "1," + diode_row,
                  {"diodes.csv:1: unknown columns \"No\"; \"nx\", did you mean \"axis_x\"?", "\"axis_y\"",
                   "the columns are x_m,y_m,z_m,"},
                  "These names, and no other columns"),
           diodes("`lambert` as a pattern", columns + "0,0,0,0,0,1,1,lambert\n",
                  {"diodes.csv:2: pattern: expected an order such as 1", "found \"lambert\"",
                   "Lambert's law is the order 1"},
                  "`1`"),
           diodes("millimetres under `x_m`", columns + "25,0,0,0,0,1,1,3\n",
                  {"diodes.csv: ", "25 m from the illuminator's origin", "0.025", "[unusual-value]"},
                  "Metres", 0),
           diodes("a text for a number", columns + diode_row + "0,near,0,0,0,1,1,3\n",
                  {"diodes.csv:3:3:", "y_m", "found \"near\""}, "A number"),
           diodes("a value too few", columns + "0,0,0,0,0,1,1\n",
                  {"diodes.csv:2:", "expected 8 columns, found 7"}, "A value for each column"),
           diodes("an axis of zero", columns + "0,0,0,0,0,0,1,3\n", {"diodes.csv:2:7:", "expected an axis"},
                  "`0,0,1`"),
           diodes("no diodes", columns, {"diodes.csv:2:", "at least one diode"}, "A line for each diode"),
           diodes("a spreadsheet", "PK\x03\x04", {"diodes.csv", "is a zip archive", "expected text"},
                  "Save it as CSV"),
           diodes("line ends of Windows", columns.substr(0, columns.size() - 1) + "\r\n0,0,0,0,0,1,1,3\r\n",
                  {}, "Nothing, they are read", 0),
           diagram("an IES file without TILT", "led.ies", "IESNA:LM-63-2002\n1 2 3\n",
                   {"led.ies:2:", "TILT="}, "An IES file of LM-63"),
           diagram("EULUMDAT", "led.ldt", "Company\n1\n", {"led.ldt: is an EULUMDAT diagram", "expected IES"},
                   "IES, or a table of angles"),
           poses("poses without their names", "t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n",
                 {"poses.csv:1:", "missing column time_s"}, "`time_s,x_m,y_m,z_m,qx,qy,qz,qw`"),
           poses("poses without rotations", "0 0 0 0\n", {"poses.csv:1:", "expected 8 values, found 4"},
                 "Time, place and quaternion"),
           poses("poses with Euler angles", "0 0 0 0 90 0 0 0\n",
                 {"poses.csv:1:", "a quaternion of length 1"}, "Quaternions qx, qy, qz, qw"),
           variants("bad JSON in line 7", lines(6, "{\"sensors/0/taps\": 4}") + "{\"sensors/0/taps\": 4,}\n",
                    {"variants.jsonl:7:21:", "no comma before }"}, "One object a line"),
           variants("a list of variants", "[{\"sensors/0/taps\": 4}]\n",
                    {"variants.jsonl:1", "an object of paths and values"},
                    "One object a line, without a list around them"),
           variants(
               "a path that a setup has not", "{\"sensors/pdm/taps\": 4}\n",
               {"setup.json:3:14: /sensors:", "variants.jsonl:1", "did you mean \"pmd\"?", "in variant 0000"},
               "The sensor's name, or its number from 0"),
           variants("a value that cannot be", "{\"sensors/0/taps\": 4}\n{\"sensors/0/taps\": 2}\n",
                    {"setup.json: /sensors/0/taps (by variants.jsonl:2):", "found 2", "in variant 0001"},
                    "3 to 16"),
           calibration("a setup for a calibration", "setup.json", good_setup(),
                       {"setup.json", "missing key", "image_size"}, "What OpenCV or ROS writes"),
           calibration("a calibration in XML that is cut off", "camera.xml",
                       "<?xml version=\"1.0\"?>\n<opencv_storage>\n", {"camera.xml:2:17", "not valid XML"},
                       "Write it again"),
           calibration("a text that is no calibration", "notes.txt", "fx is 800\n",
                       {"notes.txt", "expected a calibration"}, "What OpenCV or ROS writes")}};
}

} // namespace pmdsim::test
