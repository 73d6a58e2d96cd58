// A diode whose light falls as cos^3 is the same diode whether it is given as an order, as a CSV table or as
// IES, both at 1 degree.

#include "host/input/setup/setup.h"
#include "tests/comparison/engines.h"
#include "tests/support/temporary_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

const std::filesystem::path scenes = PMDSIM_SCENES;

// The ring of scenes/light.json with its diagram exchanged, 80 x 80 pixels.
Measurement frame_with(Engine engine, const json &pattern) {
  std::ifstream stream(scenes / "light.json");
  json setup = json::parse(stream, nullptr, true, true);
  setup["scene"] = (scenes / "room.glb").string();
  setup["illuminators"].erase(1);
  setup["illuminators"][0]["pattern"] = pattern;
  setup["sensors"][0]["resolution"] = {80, 80};
  setup["sensors"][0]["pixel_pitch_m"] = {180e-6, 180e-6};
  const TemporaryFolder folder;
  const Setup loaded = load_setup(folder.write("light.json", setup.dump()));
  return measure(engine, loaded.start.scene, loaded.start.sensors[0], loaded.start.illuminators,
                 loaded.backscatter);
}

} // namespace

TEST_CASE("cos^3 as an order, as CSV and as IES gives the same frame") {
  const Engine engine = both_engines();
  const Return order = frame_with(engine, {{"order", 3}}).returns[0];
  for (const char *name : {"led_cos3.csv", "led_cos3.ies"}) {
    const Return table = frame_with(engine, {{"file", (scenes / name).string()}}).returns[0];
    double amplitude_error = 0.0, distance_error_m = 0.0;
    for (std::size_t pixel = 0; pixel < order.amplitude.size(); ++pixel) {
      amplitude_error =
          std::max(amplitude_error,
                   std::abs(static_cast<double>(table.amplitude[pixel]) / order.amplitude[pixel] - 1));
      distance_error_m = std::max(
          distance_error_m, std::abs(static_cast<double>(table.distance_m[pixel]) - order.distance_m[pixel]));
    }
    check_within(engine, std::string(name) + ", amplitude, relative", 0.0, amplitude_error, 1e-3);
    check_within(engine, std::string(name) + ", distance", 0.0, distance_error_m, 1e-6);
  }
}
