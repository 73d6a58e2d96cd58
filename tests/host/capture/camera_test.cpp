#include "engine/model/error.h"
#include "host/capture/camera.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <cstdlib>

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

TEST_CASE("PMDSIM_VALIDATE=1 asks for the validation layer, and nothing else does") {
  const test::Workspace no_layers;
  ::setenv("VK_LAYER_PATH", no_layers.path().c_str(), 1);
  ::setenv("PMDSIM_VALIDATE", "1", 1);
  CHECK_THROWS_WITH(Camera(""), Catch::Contains("VK_LAYER_KHRONOS_validation is not installed"));
  ::setenv("PMDSIM_VALIDATE", "0", 1);
  CHECK_NOTHROW(Camera(""));
  ::unsetenv("PMDSIM_VALIDATE");
  CHECK_NOTHROW(Camera(""));
  ::unsetenv("VK_LAYER_PATH");
}
