#include "host/input/setup_support.h"

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

void check_sensor(const ordered_json &sensor, const Place &place) {
  if (sensor.at("samples").is_string())
    throw input_error(place / "samples", "not supported yet (expected an integer from 1 to 16)");
}

} // namespace

void refuse_unsupported(const ordered_json &setup, const Place &root) {
  const ordered_json &sensors = setup.at("sensors");
  for (std::size_t i = 0; i < sensors.size(); ++i)
    check_sensor(sensors[i], root / "sensors" / i);
}

} // namespace pmdsim
