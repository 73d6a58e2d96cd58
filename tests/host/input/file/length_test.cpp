#include "host/input/file/length.h"

#include "engine/model/accuracy.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

TEST_CASE("lengths have a unit") {
  CHECK(length_m("0.1mm") == 1e-4);
  CHECK(length_m("5um") == 5e-6);
  CHECK(length_m("10um") == default_max_error_m);
  CHECK(length_m("2m") == 2.0);
  CHECK(length_m("1e-3mm") == 1e-6);
  CHECK(length_m("1e-9m") == 1e-9);
  CHECK(length_m("1e6m") == 1e6);
  for (const char *text : {"", "5", "um", "5 um", "5cm", "5umm", "5MM", "-5um", "0um", "0.0009um", "1.1e6m",
                           "1e999m", "nanm", "infmm", "0x5um", "5um "}) {
    INFO(text);
    CHECK_FALSE(length_m(text));
  }
}
