// What there is: devices, keys of setups, channels.

#include "engine/model/channels.h"
#include "engine/simulator.h"
#include "host/environment.h"
#include "host/input/schema/schema_check.h"
#include "host/library/calls.h"
#include "host/output/files/manifest.h"

using namespace pmdsim;
using namespace pmdsim::library;

pmdsim_status pmdsim_devices(const char **json) {
  return guarded([&] {
    required(json, "json");
    settle_environment();
    *json = keep_for_thread(json_text(array_of(list_devices(), device_json)));
  });
}

pmdsim_status pmdsim_schema(const char **json) {
  return guarded([&] { required(json, "json") = keep_for_thread(std::string(setup_schema_text)); });
}

pmdsim_status pmdsim_channels(const char **json) {
  return guarded([&] {
    required(json, "json") = keep_for_thread(json_text(array_of(channel_rows, [](const ChannelRow &row) {
      return nlohmann::ordered_json{
          {"name", row.name}, {"unit", row.unit}, {"about", row.about}, {"of_taps", is_of_taps(row)}};
    })));
  });
}
