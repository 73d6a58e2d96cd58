#include "host/start/setup_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numbers>
#include <sstream>
#include <utility>

namespace pmdsim {
namespace {

constexpr double speed_of_light_m_s = 299792458.0, usual_modulation_hz = 20e6;

// Lines of JSON and their comments, which stand below each other where there is room.
class CommentedLines {
public:
  void add(const std::string &json, const std::string &comment = "") {
    constexpr std::size_t column = 52;
    text_ += comment.empty() ? json : fmt::format("{:<{}}// {}", json + " ", column, comment);
    text_ += '\n';
  }
  std::string text() && { return std::move(text_); }

private:
  std::string text_;
};

// As people write it: 0.004, but 15e-6 and 20e6.
std::string number_text(double number) {
  if (number == 0.0 || (std::abs(number) >= 1e-3 && std::abs(number) < 1e5))
    return fmt::format("{}", number);
  const int thousands = static_cast<int>(std::floor(std::log10(std::abs(number)) / 3.0));
  return fmt::format("{:.6g}e{}", number / std::pow(10.0, 3 * thousands), 3 * thousands);
}

double farthest_m(const StartScene &scene) {
  double farthest = 0.0;
  for (const glm::dvec3 &position : scene.scene.positions_m)
    farthest = std::max(farthest, glm::distance(position, scene.camera_m));
  return farthest;
}

// The usual one, or of two digits and so low that nothing in the scene wraps.
double modulation_hz(const StartScene &scene) {
  const double highest_hz = speed_of_light_m_s / (2.0 * 1.1 * farthest_m(scene));
  if (highest_hz >= usual_modulation_hz)
    return usual_modulation_hz;
  const double digit_hz = std::pow(10.0, std::floor(std::log10(highest_hz)) - 1.0);
  return digit_hz * std::floor(highest_hz / digit_hz);
}

std::string rings_json(const std::vector<StartRing> &rings, const std::string &indent) {
  std::vector<std::string> each;
  for (const auto &[radius_m, count] : rings)
    each.push_back(fmt::format(R"({{"radius_m": {}, "count": {}}})", radius_m, count));
  if (each.size() == 1)
    return fmt::format("[{}]", each.front());
  return fmt::format("[\n{0}  {1}\n{0}]", indent, fmt::join(each, ",\n" + indent + "  "));
}

// The command that makes the same again.
std::string command_text(const StartKind &kind, const StartSizes &sizes) {
  std::string text = fmt::format("pmdsim new {}", kind.name);
  const auto add = [&](const char *option, auto value) {
    if (value != decltype(value){})
      text += fmt::format(" {} {:.6g}", option, static_cast<double>(value));
  };
  add("--distance-m", sizes.distance_m);
  add("--size-m", sizes.size_m);
  add("--depth-m", sizes.depth_m);
  add("--spokes", sizes.spokes);
  add("--squares", sizes.squares);
  return text;
}

std::string heading(const StartKind &kind, const StartSizes &sizes) {
  std::string text;
  std::istringstream in{std::string(kind.shows)};
  for (std::string line; std::getline(in, line);)
    text += "// " + line + "\n";
  text += fmt::format("//\n// `{}` writes it again.\n", command_text(kind, sizes));
  return text +
         "// Lengths are in metres, frequencies in hertz. A key that is left out has its default. `pmdsim\n"
         "// explain focal_length_m` tells all about a key, as does an editor that knows JSON Schema.\n";
}

void add_sensor(const StartKind &kind, const StartScene &scene, CommentedLines &lines) {
  const StartView &view = kind.view;
  const glm::dvec2 view_deg = glm::degrees(view_rad(view));
  const double frequency_hz = modulation_hz(scene);
  lines.add(R"(  "sensors": [{)");
  lines.add(R"(    "name": "camera",)", "the names of output files begin with it");
  lines.add(fmt::format(R"(    "resolution": [{}, {}],)", view.resolution.x, view.resolution.y),
            "columns, rows");
  lines.add(fmt::format(R"(    "pixel_pitch_m": [{0}, {0}],)", number_text(view.pixel_pitch_m)),
            "from pixel to pixel, along columns and rows");
  lines.add(fmt::format(R"(    "focal_length_m": {},)", view.focal_length_m),
            fmt::format("so {:.1f} x {:.1f} degrees are seen", view_deg.x, view_deg.y));
  lines.add(fmt::format(R"(    "pose": {{"node": "{}"}},)", camera_node),
            R"(the lens is at this node of the scene; or {"position_m", "look_at_m"})");
  lines.add(fmt::format(R"(    "modulation_hz": [{}],)", number_text(frequency_hz)),
            fmt::format("distances wrap at {:.4g} m; several frequencies: [80e6, 60e6]",
                        speed_of_light_m_s / (2.0 * frequency_hz)));
  lines.add(R"(    "taps": 4,)", "correlation samples of each frequency");
  lines.add(
      fmt::format(R"(    "samples": {})", view.samples),
      fmt::format("{0} x {0} rays a pixel; more make edges smoother, \"auto\" only those", view.samples));
  lines.add("  }],");
}

void add_illuminator(const StartKind &kind, CommentedLines &lines) {
  const StartView &view = kind.view;
  lines.add(R"(  "illuminators": [{)");
  lines.add(R"(    "name": "ring",)");
  lines.add(fmt::format(R"(    "pose": {{"node": "{}"}},)", light_node),
            view.light_m == glm::dvec3(0.0)
                ? R"(in the lens; or {"sensor": "camera"}, or a position)"
                : R"(beside the lens; or {"sensor": "camera"}, around it, or a position)");
  const std::string diodes = fmt::format(R"(    "diodes": {{"rings": {}}},)", rings_json(view.rings, "    "));
  lines.add(diodes,
            view.has_table ? R"(or {"file": "diodes.csv"}, a line for each diode, without "pattern")" : "");
  lines.add(view.isotropic ? R"(    "pattern": {"isotropic": true},)" : R"(    "pattern": {"order": 1},)",
            view.isotropic ? "diodes shine alike in every direction"
                           : "diodes shine with the cosine to the power 1 of the angle to their axis");
  lines.add(R"(    "intensity_w_sr": 1)", "of each diode on its axis, the modulated part");
  lines.add("  }]");
}

} // namespace

glm::dvec2 view_rad(const StartView &view) {
  return 2.0 * glm::atan(0.5 * view.pixel_pitch_m * glm::dvec2(view.resolution) / view.focal_length_m);
}

std::string diodes_text(const StartView &view) {
  std::string text = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";
  for (const auto &[radius_m, count] : view.rings)
    for (std::uint32_t k = 0; k < count; ++k) {
      const double angle_rad = 2.0 * std::numbers::pi * (k + 0.5) / count;
      text += fmt::format("{:.9f},{:.9f},0,0,0,1,1,{}\n", radius_m * std::cos(angle_rad),
                          radius_m * std::sin(angle_rad), view.isotropic ? "isotropic" : "1");
    }
  return text;
}

std::string setup_text(const StartKind &kind, const StartSizes &sizes, const StartScene &scene) {
  const StartView &view = kind.view;
  CommentedLines lines;
  lines.add("{");
  lines.add(fmt::format(R"(  "$schema": "{}",)", start_schema_file),
            "for editors, which complete and check keys by it");
  lines.add(fmt::format(R"(  "scene": "{}.gltf",)", start_scene),
            "what is seen: a glTF 2.0 file, .gltf or .glb");
  lines.add(view.constant_backscatter ? R"(  "backscatter": "constant",)" : R"(  "backscatter": "lambert",)",
            view.constant_backscatter ? "as in the paper; or \"lambert\": surfaces are matt"
                                      : "surfaces are matt; or \"constant\", as in the paper");
  lines.add(R"(  "shadows": "auto",)", "bodies stand in the light's way; \"off\": light passes through");
  if (view.bounces) {
    lines.add(R"(  "bounces": "all",)", "light also comes by way of other surfaces; 0: it does not");
    lines.add(R"(  "bounce_error": "2mm",)", "how far multipath_m may be off in 95 % of the pixels");
  } else {
    lines.add(R"(  "bounces": 0,)", "\"all\": light also comes by way of other surfaces (multipath)");
  }
  add_sensor(kind, scene, lines);
  add_illuminator(kind, lines);
  lines.add("}");
  return heading(kind, sizes) + std::move(lines).text();
}

} // namespace pmdsim
