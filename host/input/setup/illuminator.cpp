#include "host/input/diagram/diode_file.h"
#include "host/input/diagram/radiation_law.h"
#include "host/input/schema/limits.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <numbers>
#include <vector>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

// `degrees` modulo 360, in [0, 360).
double full_turn(double degrees) {
  const double rest = std::fmod(degrees, 360.0);
  const double turned = rest < 0.0 ? rest + 360.0 : rest;
  return turned < 360.0 ? turned : 0.0; // a tiny negative angle is rounded to 360
}

// From the first angle on to the second, both inclusive; a whole turn or more is everything.
bool is_active(double angle_deg, const ordered_json &active_deg) {
  constexpr double rounding_deg = 1e-9;
  const double from_deg = active_deg.at(0).get<double>();
  const double to_deg = active_deg.at(1).get<double>();
  if (std::abs(to_deg - from_deg) >= 360.0)
    return true;
  const double beyond_deg = full_turn(angle_deg - from_deg);
  return beyond_deg <= full_turn(to_deg - from_deg) + rounding_deg || beyond_deg >= 360.0 - rounding_deg;
}

void append_ring(const ordered_json &ring, const Diode &diode, std::vector<Diode> &diodes) {
  const auto count = ring.at("count").get<std::uint32_t>();
  const auto radius_m = ring.at("radius_m").get<double>();
  for (std::uint32_t k = 0; k < count; ++k) {
    const double turns = (k + 0.5) / count;
    if (!is_active(360.0 * turns, ring.at("active_deg")))
      continue;
    const double angle_rad = 2.0 * std::numbers::pi * turns;
    diodes.push_back(diode);
    diodes.back().position_m = {radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0.0};
  }
}

// The work is bounded by what the rings of all illuminators list, also where active_deg switches most of it
// off.
void refuse_endless_rings(const ordered_json &illuminators, const Place &place) {
  constexpr std::uint64_t max_listed = 1'000'000;
  std::uint64_t listed = 0;
  for (std::size_t i = 0; i < illuminators.size(); ++i) {
    const ordered_json &diodes = illuminators[i].at("diodes");
    for (std::size_t k = 0; diodes.contains("rings") && k < diodes.at("rings").size(); ++k) {
      listed += diodes.at("rings")[k].at("count").get<std::uint32_t>();
      if (listed > max_listed)
        throw input_error(place / i / "diodes" / "rings" / k / "count",
                          fmt::format("expected at most {} diodes in all rings, on or off", max_listed));
    }
  }
}

// Each file once, whatever number of illuminators it is for.
struct LightFiles {
  DiagramFiles diagrams{};
  std::map<std::filesystem::path, std::vector<Diode>> tables{};
};

std::vector<Diode> ring_diodes(const ordered_json &rings, const Diode &diode, const Place &place) {
  std::vector<Diode> diodes;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    append_ring(rings[i], diode, diodes);
    if (diodes.size() > max_diodes)
      throw input_error(place / i, fmt::format("expected at most {} diodes in all rings", max_diodes));
  }
  if (diodes.empty())
    throw input_error(place, "expected at least one diode, active_deg switches all off");
  return diodes;
}

std::vector<Diode> file_diodes(const std::string &name, double intensity, const Place &place,
                               LightFiles &files) {
  const std::filesystem::path file = place.folder / name;
  auto table = files.tables.find(file);
  if (table == files.tables.end())
    table = files.tables.emplace(file, read_diode_file(file, place, files.diagrams)).first;
  std::vector<Diode> diodes = table->second;
  for (std::size_t i = 0; i < diodes.size(); ++i) {
    diodes[i].intensity_w_sr *= intensity;
    if (diodes[i].intensity_w_sr > max_intensity_w_sr)
      throw input_error(
          place, fmt::format("diode {}: its intensity times intensity_w_sr is {}, expected at most {} W/sr",
                             i, diodes[i].intensity_w_sr, max_intensity_w_sr));
  }
  return diodes;
}

// Ring by ring in the order of their angles, or in the diode file's order.
std::vector<Diode> diodes_of(const ordered_json &illuminator, const Place &place, LightFiles &files) {
  const ordered_json &diodes = illuminator.at("diodes");
  const auto intensity_w_sr = illuminator.at("intensity_w_sr").get<double>();
  if (diodes.contains("file"))
    return file_diodes(diodes.at("file"), intensity_w_sr, place / "diodes" / "file", files);
  const ordered_json &pattern = illuminator.at("pattern");
  Diode diode;
  diode.intensity_w_sr = intensity_w_sr;
  diode.pattern = law_in_setup(pattern, place / "pattern", files.diagrams);
  diode.across = diode_across(diode.axis, glm::radians(pattern.value("roll_deg", 0.0)));
  return diodes.contains("rings") ? ring_diodes(diodes.at("rings"), diode, place / "diodes" / "rings")
                                  : std::vector<Diode>{diode};
}

// Where the places of the diodes stand: the setup, or their file.
Place place_of_diodes(const ordered_json &illuminator, const Place &place) {
  const ordered_json &diodes = illuminator.at("diodes");
  return diodes.contains("file") ? Place{place.folder / diodes.at("file").get<std::string>()} : place;
}

} // namespace

std::vector<Illuminator> illuminators_of(const ordered_json &illuminators, const Place &place,
                                         const Surroundings &at, const std::vector<Sensor> &sensors,
                                         std::vector<Warning> &warnings) {
  refuse_endless_rings(illuminators, place);
  LightFiles files;
  std::vector<Illuminator> result;
  std::size_t diodes = 0;
  for (std::size_t i = 0; i < illuminators.size(); ++i) {
    const ordered_json &illuminator = illuminators[i];
    result.push_back({illuminator.at("name"),
                      world_from_frame(illuminator.at("pose"), place / i / "pose", at, sensors),
                      diodes_of(illuminator, place / i, files),
                      glm::radians(full_turn(illuminator.at("modulation_phase_deg").get<double>())),
                      illuminator.at("modulation_depth").get<double>()});
    diodes += result.back().diodes.size();
    std::ranges::copy(unit_doubts(result.back().diodes, place_of_diodes(illuminator, place / i / "diodes")),
                      std::back_inserter(warnings));
    if (diodes > max_diodes)
      throw input_error(place / i / "diodes",
                        fmt::format("expected at most {} diodes in all illuminators", max_diodes));
  }
  warnings.insert(warnings.end(), files.diagrams.warnings().begin(), files.diagrams.warnings().end());
  return result;
}

} // namespace pmdsim
