#include "host/input/setup_support.h"

#include <fmt/format.h>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

// Refuses the first value, however deep, that differs from the only one supported.
void expect_only(const ordered_json &value, const ordered_json &supported, const Place &place) {
  if (value.is_object() && supported.is_object()) {
    for (const auto &[key, member] : supported.items())
      expect_only(value.at(key), member, place / key);
  } else if (value != supported) {
    throw input_error(place, fmt::format("not supported yet (expected {})", supported.dump()));
  }
}

void check_sensor(const ordered_json &sensor, const Place &place) {
  if (sensor.at("samples").is_string())
    throw input_error(place / "samples", "not supported yet (expected an integer from 1 to 16)");
}

void check_illuminator(const ordered_json &illuminator, const Place &place) {
  expect_only(illuminator, {{"modulation_phase_deg", 0}}, place);
  if (illuminator.contains("pattern") && illuminator.at("pattern").contains("file"))
    throw input_error(place / "pattern" / "file",
                      "not supported yet (expected {\"order\"} or {\"isotropic\": true})");
}

} // namespace

void refuse_unsupported(const ordered_json &setup, const Place &root) {
  if (setup.at("shadows") != "off")
    throw input_error(root / "shadows", "shadows are not supported yet; write \"shadows\": \"off\"");
  const ordered_json &sensors = setup.at("sensors");
  for (std::size_t i = 0; i < sensors.size(); ++i)
    check_sensor(sensors[i], root / "sensors" / i);
  if (setup.at("illuminators").size() > 1)
    throw input_error(root / "illuminators" / 1, "several illuminators are not supported yet (expected one)");
  check_illuminator(setup.at("illuminators").at(0), root / "illuminators" / 0);
}

} // namespace pmdsim
