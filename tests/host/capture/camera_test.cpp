#include "engine/model/error.h"
#include "host/capture/camera.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <stdexcept>

using namespace pmdsim;

TEST_CASE("the reference is known by its name in any case") {
  const std::string name = GENERATE("reference", "Reference", "REFERENCE");
  const Camera camera(name);
  CHECK(camera.is_reference());
  CHECK(camera.device() == "reference");
}

TEST_CASE("part of the reference's name is a device's name") {
  CHECK_THROWS_AS(Camera("refer"), Error);
  CHECK_THROWS_AS(Camera("references"), Error);
}

TEST_CASE("PMDSIM_VALIDATE=1 and =gpu ask for the validation layer, and nothing else does") {
  const test::Workspace no_layers;
  ::setenv("VK_LAYER_PATH", no_layers.path().c_str(), 1);
  for (const char *asking : {"1", "gpu"}) {
    ::setenv("PMDSIM_VALIDATE", asking, 1);
    CHECK_THROWS_WITH(Camera(""), Catch::Contains("VK_LAYER_KHRONOS_validation is not installed"));
  }
  for (const char *other : {"0", "", "on", "GPU"}) {
    ::setenv("PMDSIM_VALIDATE", other, 1);
    CHECK_NOTHROW(Camera(""));
  }
  ::unsetenv("PMDSIM_VALIDATE");
  CHECK_NOTHROW(Camera(""));
  ::unsetenv("VK_LAYER_PATH");
}

TEST_CASE("a camera counts electrons at once where it may, and then gives no light that could be added to") {
  const Setup setup = load_setup(PMDSIM_SCENES "/electronics/kinect_v2_like.json");
  Sensor sensor = setup.start.sensors[0];
  sensor.resolution = {32, 24};
  sensor.electronics->noiseless_channels = false;
  Camera at_once("", {.electrons_at_once = true}), later("");
  for (Camera *camera : {&at_once, &later})
    camera->prepare(setup, sensor);
  CHECK(at_once.measure().has_electrons);
  CHECK_THROWS_AS(at_once.measure_light(), std::logic_error);
  const auto add_nothing = [](Measurement &) {};
  CHECK_THROWS_AS(at_once.measure({}, {}, add_nothing), std::logic_error);
  CHECK_FALSE(later.measure_light().has_electrons);
  CHECK(later.measure().has_electrons);
}
