// A sensor's electronics, scatter and unwrapping as setups give them.

#include "tests/host/input/image/image_bytes.h"
#include "tests/host/input/setup/setup_fixture.h"

#include <cmath>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

json plain_electronics_json() {
  return {{"integration_time_s", 1e-3},
          {"quantum_efficiency", 0.5},
          {"wavelength_m", 850e-9},
          {"lens_f_number", 1.4},
          {"full_well_e", 50000},
          {"gain_dn_per_e", 0.08},
          {"adc_bits", 12}};
}

void give_electronics(SetupFixture &fixture, const json &changes = json::object()) {
  fixture.sensor()["electronics"] = plain_electronics_json();
  fixture.sensor()["electronics"].update(changes);
}

void check_refused(const json &changes, const std::string &pointer, const std::string &expectation) {
  INFO(changes.dump());
  SetupFixture fixture;
  give_electronics(fixture, changes);
  CHECK_THAT(fixture.error(), Contains("/sensors/0/electronics" + pointer + ": ") && Contains(expectation));
}

} // namespace

TEST_CASE("Electronics are absent unless they are written, and have their defaults") {
  CHECK_FALSE(SetupFixture().load().start.sensors[0].electronics);
  SetupFixture fixture;
  give_electronics(fixture);
  const Setup setup = fixture.load();
  const Electronics &of = *setup.start.sensors[0].electronics;
  CHECK(of.integration_time_s == 1e-3);
  CHECK(of.demodulation_contrast == std::vector{1.0});
  CHECK(of.read_noise_e == 0.0);
  CHECK(of.adc_bits == 12);
  CHECK(of.largest_dn() == 4095.0);
  CHECK(of.two_tap);
  CHECK(of.frames_averaged == 1);
  CHECK(of.seed == 0);
  CHECK_FALSE(of.noiseless_channels);
}

TEST_CASE("Electronics are what the setup says") {
  SetupFixture fixture;
  give_electronics(fixture, {{"demodulation_contrast", {0.7, 0.5}},
                             {"read_noise_e", 12.5},
                             {"sbi", 1e5},
                             {"seed", 9007199254740992},
                             {"two_tap", true},
                             {"background_radiance_w_m2_sr", 0.25},
                             {"noiseless_channels", true}});
  fixture.sensor()["modulation_hz"] = {20e6, 60e6};
  fixture.illuminator()["modulation_depth"] = 0.7;
  const Setup setup = fixture.load();
  const Electronics &of = *setup.start.sensors[0].electronics;
  CHECK(of.contrast(0) == 0.7);
  CHECK(of.contrast(1) == 0.5);
  CHECK(of.read_noise_e == 12.5);
  CHECK(of.sbi_e == 1e5);
  CHECK(of.seed == std::uint64_t{1} << 53);
  CHECK(of.background_radiance_w_m2_sr == 0.25);
  CHECK(of.noiseless_channels);
  CHECK(setup.start.illuminators[0].modulation_depth == 0.7);
}

TEST_CASE("A preset gives what is not written beside it") {
  for (const std::string preset : {"kinect_v2_like", "azure_kinect_like", "opt8241_like"}) {
    SetupFixture fixture;
    fixture.sensor()["electronics"] = {
        {"preset", preset}, {"integration_time_s", 2e-3}, {"lens_f_number", 2}, {"read_noise_e", 7}};
    const Setup setup = fixture.load();
    const Electronics &of = *setup.start.sensors[0].electronics;
    CHECK(of.read_noise_e == 7.0);
    CHECK(of.full_well_e >= 20e3);
    CHECK(of.quantum_efficiency > 0.0);
    CHECK(of.demodulation_contrast.front() < 1.0);
    // The full well nearly fills the ADC's range.
    const double full_dn = of.gain_dn_per_e * of.full_well_e + of.offset_dn;
    CHECK(full_dn <= of.largest_dn());
    CHECK(full_dn > 0.95 * of.largest_dn());
    CHECK(setup.as_used["sensors"][0]["electronics"]["adc_bits"] == of.adc_bits);
  }
  SetupFixture fixture;
  fixture.sensor()["electronics"] = {{"preset", "kinect_v2_like"}};
  CHECK_THAT(fixture.error(), Contains("/sensors/0/electronics") && Contains("integration_time_s"));
}

TEST_CASE("Electronics that cannot be are refused in one line") {
  check_refused({{"quantum_efficiency", 1.2}}, "/quantum_efficiency", "1.2");
  check_refused({{"adc_bits", 0}}, "/adc_bits", "0");
  check_refused({{"full_well_e", 50}, {"read_noise_e", 60}}, "/full_well_e",
                "more than the read noise of 60");
  check_refused({{"preset", "pmd_like"}}, "/preset", "pmd_like");
  check_refused({{"offset_dn", 5000}}, "/offset_dn", "less than 4095");
  check_refused({{"offset_dn", 4095}}, "/offset_dn", "less than 4095");
  check_refused({{"sbi", 10}, {"two_tap", false}}, "/sbi", "one tap");
  check_refused({{"demodulation_contrast", {0.5, 0.4}}}, "/demodulation_contrast", "1 frequencies, found 2");
  check_refused({{"demodulation_contrast", 0}}, "/demodulation_contrast", "above 0");
  check_refused({{"integration_time_s", 0}}, "/integration_time_s", "0");
  check_refused({{"frames_averaged", 0}}, "/frames_averaged", "0");
  check_refused({{"seed", -1}}, "/seed", "-1");
  check_refused({{"gain", 1}}, "", "gain");
  check_refused({{"background_radiance_w_m2_sr", {{"texture", "none.png"}, {"white_w_m2_sr", 1}}}},
                "/background_radiance_w_m2_sr", "none.png");
  for (const json &odd : {json("on"), json(3), json::array(), json(nullptr)}) {
    SetupFixture fixture;
    fixture.sensor()["electronics"] = odd;
    CHECK_THAT(fixture.error(), Contains("/sensors/0/electronics: "));
  }
}

TEST_CASE("A background is a channel of a picture, of either depth, or refused") {
  SetupFixture fixture;
  fixture.sensor()["resolution"] = {2, 2};
  for (const std::string channel : {"red", "green", "blue"}) {
    INFO(channel);
    give_electronics(fixture, {{"background_radiance_w_m2_sr",
                                {{"texture", "sky.png"}, {"channel", channel}, {"white_w_m2_sr", 0.25}}}});
    const std::size_t shift = channel == "red" ? 0 : channel == "green" ? 1 : 2;
    PngImage image{.width = 2, .height = 2};
    for (int component = 0; component < 12; ++component)
      image.rows.push_back(static_cast<std::uint8_t>(20 * component));
    fixture.folder.write("sky.png", png_bytes(image));
    const Electronics of = *fixture.load().start.sensors[0].electronics;
    CHECK(of.background_radiance_w_m2_sr == 0.25);
    REQUIRE(of.background_image.size() == 4);
    for (std::size_t pixel = 0; pixel < 4; ++pixel)
      CHECK(of.background_image[pixel] ==
            Approx(20.0 * static_cast<double>(3 * pixel + shift) / 255.0).epsilon(1e-6));

    PngImage deep{.width = 2, .height = 2, .bits = 16};
    for (int component = 0; component < 12; ++component) {
      deep.rows.push_back(static_cast<std::uint8_t>(component));
      deep.rows.push_back(static_cast<std::uint8_t>(2 * component));
    }
    fixture.folder.write("sky.png", png_bytes(deep));
    const Electronics of_deep = *fixture.load().start.sensors[0].electronics;
    for (std::size_t pixel = 0; pixel < 4; ++pixel)
      CHECK(of_deep.background_image[pixel] ==
            Approx(258.0 * static_cast<double>(3 * pixel + shift) / 65535.0).epsilon(1e-6));
  }
  fixture.sensor()["resolution"] = {3, 2};
  CHECK_THAT(fixture.error(),
             Contains("sky.png") && Contains("expected the sensor's 3 x 2 pixels, found 2 x 2"));
}

TEST_CASE("Binning makes one pixel of several, before the ADC or after") {
  SetupFixture fixture;
  give_electronics(fixture, {{"binning", {2, 3}}, {"dsnu_e", 10}, {"dark_current_e_per_s", 100}});
  const Electronics before = *fixture.load().start.sensors[0].electronics;
  CHECK(before.full_well_e == 300'000.0);
  CHECK(before.dark_current_e_per_s == 600.0);
  CHECK(before.dsnu_e == Approx(10.0 * std::sqrt(6.0)));
  CHECK(before.readings() == 1);
  fixture.sensor()["electronics"]["binning_after_adc"] = true;
  const Electronics after = *fixture.load().start.sensors[0].electronics;
  CHECK(after.full_well_e == 50'000.0);
  CHECK(after.parts_averaged == 6);
  fixture.sensor()["electronics"]["frames_averaged"] = 10'000;
  fixture.sensor()["electronics"]["binning"] = {4, 4};
  CHECK_THAT(fixture.error(), Contains("/frames_averaged: expected at most 4096"));
}

TEST_CASE("Scatter and unwrapping are what the setup says, or are refused") {
  SetupFixture fixture;
  fixture.sensor()["scatter"] = {{{"share", 0.1}, {"sigma_m", 1e-3}}, {{"share", 0.05}, {"sigma_m", 2e-4}}};
  fixture.sensor()["modulation_hz"] = {20e6, 60e6};
  fixture.sensor()["unwrap_range_m"] = 7;
  const Setup setup = fixture.load();
  REQUIRE(setup.start.sensors[0].scatter.size() == 2);
  CHECK(setup.start.sensors[0].scatter[1].sigma_m == 2e-4);
  CHECK(setup.start.sensors[0].unwrap_range_m == 7.0);
  fixture.sensor()["scatter"][0]["share"] = 0.97;
  CHECK_THAT(fixture.error(), Contains("/sensors/0/scatter: expected shares that come to at most 1"));
  fixture.sensor()["scatter"] = json::array();
  fixture.sensor()["unwrap_range_m"] = 1e5;
  CHECK_THAT(fixture.error(), Contains("/sensors/0/unwrap_range_m: expected at most 24982.7 m"));
  fixture.sensor()["unwrap_range_m"] = 5;
  fixture.sensor()["modulation_hz"] = {20e6};
  CHECK_THAT(fixture.error(), Contains("/sensors/0/unwrap_range_m: expected two frequencies"));
}
