#include "host/output/pictures/plots.h"
#include "host/output/tables/profile.h"
#include "tests/host/output/directory_content.h"
#include "tests/host/output/nan_value.h"
#include "tests/host/output/pixel_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <sstream>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

std::vector<std::string> profile_lines(const ChannelSet &channels, const Sensor &sensor) {
  const pmdsim::test::TemporaryFolder temporary;
  OutputFile file(temporary.path() / "profile.csv");
  write_profile_csv(file, channels, sensor);
  file.close();
  file.publish();
  std::istringstream text(content_of(file.path()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    lines.push_back(line);
  return lines;
}

// Pixels of the drawing in the line's colour.
int line_pixels(Canvas &canvas) {
  return pmdsim::test::count_pixels(
      canvas, [](std::uint32_t colour) { return (colour & 0xffu) > ((colour >> 16) & 0xffu) + 50u; });
}

} // namespace

TEST_CASE("the profile's table holds the middle row") {
  Sensor sensor;
  sensor.resolution = {2, 3};
  sensor.pixel_pitch_m = {2.0, 1.0};
  sensor.focal_length_m = 1.0;
  const std::vector<float> depth{1.f, 2.f, 3.f, std::numeric_limits<float>::quiet_NaN(), 5.f, 6.f};
  const std::vector<std::uint32_t> object{0, 0, 7, 8, 0, 0};
  const ChannelSet channels{{2, 3},
                            {{"z_m", "m", std::span<const float>(depth)},
                             {"object_id", "", std::span<const std::uint32_t>(object)}}};
  CHECK(profile_lines(channels, sensor) ==
        std::vector<std::string>{"column,chip_x_m,angle_deg,z_m,object_id", "0,-1,-45,3,7", "1,1,45,nan,8"});
}

TEST_CASE("the profile's angles are those of the lens's rays, and its channels carry their frequency") {
  Sensor sensor;
  sensor.resolution = {2, 1};
  sensor.pixel_pitch_m = {2.0, 1.0};
  sensor.focal_length_m = 1.0;
  sensor.distortion = Fisheye{}; // the angle itself is the place: 1 m from the axis is 1 rad
  const std::vector<float> distance{1.f, 2.f};
  const ChannelSet channels{{2, 1}, {{"distance_m", "m", std::span(distance), 1}}};
  const std::vector<std::string> lines = profile_lines(channels, sensor);
  CHECK(lines.at(0) == "column,chip_x_m,angle_deg,f1.distance_m");
  CHECK(std::stod(lines.at(2).substr(4)) == Approx(180.0 / 3.14159265358979));
}

TEST_CASE("a profile is a line with gaps") {
  std::vector<float> values(100);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(i);
  Canvas whole = draw_profile(values, {100, 1}, "deformation", "mm", "title");
  for (std::size_t i = 30; i < 80; ++i)
    values[i] = nan_value;
  Canvas half_profile = draw_profile(values, {100, 1}, "deformation", "mm", "title");
  Canvas none = draw_profile(std::vector<float>(100, nan_value), {100, 1}, "deformation", "mm", "title");
  CHECK(line_pixels(whole) > 800);
  CHECK(line_pixels(half_profile) < 0.6 * line_pixels(whole));
  CHECK(line_pixels(half_profile) > 0.4 * line_pixels(whole));
  CHECK(line_pixels(none) == 0);
}

TEST_CASE("a single value between gaps is still seen, and a constant row too") {
  Canvas dot = draw_profile(std::vector{nan_value, 1.0f, nan_value}, {3, 1}, "deformation", "mm", "title");
  CHECK(line_pixels(dot) > 0);
  Canvas constant = draw_profile(std::vector(50, 2.0f), {50, 1}, "deformation", "mm", "title");
  CHECK(line_pixels(constant) > 800);
}
