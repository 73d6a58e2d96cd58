#include "engine/simulator.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

std::string report_text(const std::vector<DeviceInfo> &devices) {
  std::string text;
  if (devices.empty())
    text += "Vulkan offers no device; only the reference can measure.\n";
  for (const DeviceInfo &device : devices)
    text += fmt::format("{:<10} {} ({}, {}){}\n", device.index, device.name, device.kind, device.driver,
                        device.usable ? "" : ": not usable, lacks " + device.lacks);
  return text + "reference  the CPU in double precision, slow: what accuracy is judged by\n";
}

} // namespace

void run_devices(const Options &options) {
  const std::vector<DeviceInfo> devices = list_devices();
  print(options.json ? json_text({{"devices", array_of(devices, device_json)}, {"reference", true}})
                     : report_text(devices));
}

} // namespace pmdsim
