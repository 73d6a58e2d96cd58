#include "host/output/pictures/colour_map.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

double luminance(const Colour &colour) {
  return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
}

void check_colour(const Colour &colour, const Colour &expected) {
  for (std::size_t i = 0; i < colour.size(); ++i)
    CHECK(colour[i] == Approx(expected[i]).margin(1.0 / 255.0));
}

} // namespace

TEST_CASE("viridis runs from dark violet through teal to yellow") {
  check_colour(viridis.at(0.0), {0x44 / 255.0, 0x01 / 255.0, 0x54 / 255.0});
  check_colour(viridis.at(0.5), {0x21 / 255.0, 0x90 / 255.0, 0x8c / 255.0});
  check_colour(viridis.at(1.0), {0xfd / 255.0, 0xe7 / 255.0, 0x25 / 255.0});
}

TEST_CASE("viridis grows lighter throughout") {
  for (int i = 1; i <= 200; ++i)
    CHECK(luminance(viridis.at(i / 200.0)) > luminance(viridis.at((i - 1) / 200.0)));
}

TEST_CASE("twilight ends where it starts") {
  check_colour(twilight.at(1.0), twilight.at(0.0));
  CHECK(luminance(twilight.at(0.5)) < 0.2 * luminance(twilight.at(0.0)));
}

TEST_CASE("the diverging map is lightest and colourless at its centre, blue below, red above") {
  const Colour centre = blue_white_red.at(0.5);
  CHECK(centre[0] == centre[1]);
  CHECK(centre[1] == centre[2]);
  for (int i = 1; i <= 100; ++i)
    for (const double side : {-1.0, 1.0})
      CHECK(luminance(blue_white_red.at(0.5 + side * i / 200.0)) <
            luminance(blue_white_red.at(0.5 + side * (i - 1) / 200.0)));
  CHECK(blue_white_red.at(0.0)[2] > blue_white_red.at(0.0)[0]);
  CHECK(blue_white_red.at(1.0)[0] > blue_white_red.at(1.0)[2]);
}

TEST_CASE("positions beyond a map take its ends") {
  CHECK(viridis.at(-1.0) == viridis.at(0.0));
  CHECK(viridis.at(2.0) == viridis.at(1.0));
}
