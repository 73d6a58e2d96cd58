#include "tests/fuzz/small_files.h"

#include "tests/fuzz/target.h"

#include <string>
#include <string_view>

namespace pmdsim::fuzz {
namespace {

// A wall of 0.4 x 0.4 m at 2 m.
constexpr const char *wall_gltf = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "wall", "mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.2, -0.2, -2], "max": [0.2, 0.2, -2]},
{"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 6}],
"buffers": [{"byteLength": 54, "uri": "data:application/octet-stream;base64,zcxMvs3MTL4AAADAzcxMPs3MTL4AAADAzcxMPs3MTD4AAADAzcxMvs3MTD4AAADAAAECAAID"}]})";

// A closed box of 2 x 2 x 2 m about the origin.
constexpr const char *box_gltf = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"name": "box", "mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]},
{"bufferView": 1, "componentType": 5121, "count": 36, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 36}],
"buffers": [{"byteLength": 132, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAIC/AACAvwAAgL8AAIA/AACAvwAAgD8AAIC/AACAvwAAgD8AAIA/AACAPwAAgL8AAIC/AACAPwAAgL8AAIA/AACAPwAAgD8AAIC/AACAPwAAgD8AAIA/AAEDAAMCBAYHBAcFAAQFAAUBAgMHAgcGAAIGAAYEAQUHAQcD"}]})";

// The same wall, 2,000 times as large, beside a camera and nodes that no sensor may be at.
std::string stage_gltf() {
  std::string text = wall_gltf;
  const auto replace = [&](std::string_view from, std::string_view to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace(R"("scenes": [{"nodes": [0]}])", R"("scenes": [{"nodes": [0, 1, 2, 3, 4, 5, 6]}])");
  replace(
      R"("nodes": [{"name": "wall", "mesh": 0}])",
      R"("nodes": [{"name": "wall", "mesh": 0, "scale": [2000, 2000, 2000]}, {"name": "camera", "camera": 0},
{"name": "twice"}, {"name": "twice"}, {"name": "mirrored", "scale": [-1, 1, 1]},
{"name": "far", "translation": [1e12, 0, 0]}, {"name": "flat", "scale": [1, 1, 0]}],
"cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}])");
  return text;
}

constexpr const char *empty_gltf = R"({"asset": {"version": "2.0"}})";

// 4 x 4 pixels of one colour.
constexpr std::string_view colour_png(
    "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x04\0\0\0\x04\x08\x02\0\0\0\x26\x93\x09\x29\0\0\0\x10IDAT"
    "\x78\x9c\x63\x68\x50\x70\x80\x23\x06\xe2\x38\0\x70\x43\x0e\x01\x98\x26\x69\x19\0\0\0\0IEND\xae\x42\x60"
    "\x82",
    73);

constexpr const char *diodes_csv = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n"
                                   "0.1,0,0,0,0,1,1,1\n-0.1,0,0,0,0,1,1,led.csv\n";
constexpr const char *led_csv = "angle_deg,relative\n0,1\n45,0.5\n90,0\n";
constexpr const char *led_ies =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 1\n0 45 90\n0\n2 1 0\n";
constexpr const char *poses_txt = "0 0 0 0 0 0 0 1\n1 0.1 0 0 0 0.1 0 1\n";

} // namespace

const char *const small_setup = R"({"scene": "wall.gltf", "sensors": [{"name": "pmd", "resolution": [4, 4],
"pixel_pitch_m": [45e-6, 45e-6], "focal_length_m": 0.0018, "modulation_hz": [20e6]}],
"illuminators": [{"name": "ring", "pose": {"sensor": "pmd"}, "diodes": {"rings": [{"radius_m": 0.1, "count": 3}]}}]})";

const char *const small_setup_without_scene = R"({"sensors": [{"name": "pmd", "resolution": [4, 4],
"pixel_pitch_m": [45e-6, 45e-6], "focal_length_m": 0.0018, "modulation_hz": [20e6]}],
"illuminators": [{"name": "ring", "pose": {"sensor": "pmd"}, "diodes": {"rings": [{"radius_m": 0.1, "count": 3}]}}]})";

std::filesystem::path write_small_files() {
  write_file("wall.gltf", wall_gltf);
  write_file("box.gltf", box_gltf);
  write_file("stage.gltf", stage_gltf());
  write_file("empty.gltf", empty_gltf);
  write_file("colour.png", colour_png);
  write_file("diodes.csv", diodes_csv);
  write_file("led.csv", led_csv);
  write_file("led.ies", led_ies);
  write_file("poses.txt", poses_txt);
  write_file("setup.json", small_setup);
  return folder();
}

} // namespace pmdsim::fuzz
