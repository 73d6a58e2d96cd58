// Electrons and noise, on the real binary: what is written, the same bits again, and what is refused.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

json with_preset(const std::string &name) {
  const std::string folder = PMDSIM_SCENES "/electronics/";
  std::ifstream in(folder + name + ".json");
  json setup = json::parse(in, nullptr, true, true);
  setup["scene"] = folder + setup["scene"].get<std::string>();
  // Few pixels, as large as 16 x 16, get as many electrons as many.
  json &sensor = setup["sensors"][0];
  const double pitch_m = 16.0 * sensor["pixel_pitch_m"][0].get<double>();
  sensor["pixel_pitch_m"] = {pitch_m, pitch_m};
  sensor["resolution"] = {32, 24};
  sensor["electronics"]["integration_time_s"] =
      sensor["electronics"]["integration_time_s"].get<double>() / 256.0;
  return setup;
}

std::string content_of(const std::string &file) {
  std::ifstream in(file, std::ios::binary);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

Run render_to(const Workspace &work, const json &setup, const std::string &out,
              const std::vector<std::string> &more = {}) {
  std::vector<std::string> arguments{
      "render", work.write("setup.json", setup.dump()), "-o", work / out, "--format", "npy"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  Run done = run_pmdsim(arguments);
  INFO(done.errors);
  REQUIRE(done.exit_code == 0);
  return done;
}

void check_same_files(const Workspace &work, const std::string &a, const std::string &b,
                      const std::string &stem_a, const std::string &stem_b) {
  std::size_t compared = 0;
  for (const std::string &name : work.files(a)) {
    if (!name.ends_with(".npy") || name.find(stem_a) == std::string::npos)
      continue;
    const std::string file = std::filesystem::path(name).filename();
    INFO(file);
    CHECK(content_of(work / (a + "/" + file)) ==
          content_of(work / (b + "/" + stem_b + file.substr(stem_a.size()))));
    ++compared;
  }
  CHECK(compared > 20);
}

} // namespace

TEST_CASE("a frame with electronics has their channels, and the passes tell of them") {
  const Workspace work;
  const json report = json::parse(render_to(work, with_preset("kinect_v2_like"), "out", {"--json"}).output);
  CHECK(report["frames"][0]["passes_ms"].contains("electrons"));
  for (const std::string channel :
       {"f0.tap_a_e0", "f2.tap_b_e3", "f1.tap_a_dn2", "f0.tap_b_dn1", "f0.saturated", "f0.distance_noise_m",
        "f1.confidence", "f0.amplitude_noiseless", "f0.phase_rad_noiseless", "f2.distance_m_noiseless",
        "mean_radiance", "unwrapped_distance_m", "unwrap_ok"})
    CHECK(std::filesystem::exists(work / ("out/pmd_0000." + channel + ".npy")));
}

TEST_CASE("a frame with scatter and one with one tap are rendered") {
  const Workspace work;
  json setup = with_preset("opt8241_like");
  CHECK(json::parse(render_to(work, setup, "out", {"--json"}).output)["frames"][0]["passes_ms"].contains(
      "scatter"));
  setup["sensors"][0]["electronics"]["two_tap"] = false;
  render_to(work, setup, "one");
  CHECK_FALSE(std::filesystem::exists(work / "one/pmd_0000.tap_b_e0.npy"));
  CHECK(std::filesystem::exists(work / "one/pmd_0000.tap_a_e0.npy"));
}

TEST_CASE("a frame alone has the bits that it has in its sequence, and every run the same") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  setup["frames"] = {{"rate_hz", 30}, {"count", 8}};
  render_to(work, setup, "all");
  render_to(work, setup, "again");
  render_to(work, setup, "alone", {"--frames", "5:6"});
  check_same_files(work, "all", "again", "pmd_0003", "pmd_0003");
  check_same_files(work, "alone", "all", "pmd_0005", "pmd_0005");
  CHECK(content_of(work / "all/pmd_0004.f0.tap_a_e0.npy") !=
        content_of(work / "all/pmd_0005.f0.tap_a_e0.npy"));
}

TEST_CASE("another camera's beat is another in each frame, and costs nothing where electronics are absent") {
  const Workspace work;
  json setup = with_preset("opt8241_like");
  setup["frames"] = {{"rate_hz", 30}, {"count", 4}};
  setup["sensors"][0]["electronics"]["noiseless_channels"] = true;
  json lamp = setup["illuminators"][0];
  lamp["name"] = "lamp";
  lamp["modulation_hz"] = setup["sensors"][0]["modulation_hz"][0].get<double>() + 100.0;
  setup["illuminators"].push_back(lamp);
  const json report = json::parse(render_to(work, setup, "all", {"--json"}).output);
  CHECK(report["frames"][0]["passes_ms"].contains("other_cameras"));
  render_to(work, setup, "alone", {"--frames", "2:3"});
  check_same_files(work, "alone", "all", "pmd_0002", "pmd_0002");
  CHECK(content_of(work / "all/pmd_0001.amplitude_noiseless.npy") !=
        content_of(work / "all/pmd_0002.amplitude_noiseless.npy"));
  setup["sensors"][0].erase("electronics");
  const Run without = render_to(work, setup, "without");
  CHECK_THAT(without.errors, Catch::Matchers::Contains("illuminators with modulation_hz are left out"));
  setup["illuminators"].erase(1);
  render_to(work, setup, "never");
  CHECK(content_of(work / "without/pmd_0003.amplitude.npy") ==
        content_of(work / "never/pmd_0003.amplitude.npy"));
}

TEST_CASE("taps that are exposed one after the other count the electrons of each exposure") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  setup["sensors"][0].erase("unwrap_range_m");
  json moving = json::parse(std::ifstream(PMDSIM_SCENES "/motion.json"), nullptr, true, true);
  moving["scene"] = std::string(PMDSIM_SCENES "/") + moving["scene"].get<std::string>();
  moving["sensors"] = {moving["sensors"][0]};
  moving["sensors"][0]["resolution"] = {24, 18};
  moving["sensors"][0]["tap_interval_s"] = 1e-3;
  moving["sensors"][0]["electronics"] = setup["sensors"][0]["electronics"];
  moving["sensors"][0]["electronics"]["noiseless_channels"] = true;
  moving["frames"] = {{"rate_hz", 10}, {"count", 2}};
  const std::string stem = moving["sensors"][0]["name"].get<std::string>() + "_0001";
  render_to(work, moving, "out");
  render_to(work, moving, "alone", {"--frames", "1:2"});
  check_same_files(work, "alone", "out", stem, stem);
}

TEST_CASE("without electronics a frame has the bytes that it had, and none of their channels") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  setup["sensors"][0].erase("unwrap_range_m");
  json electronics = setup["sensors"][0]["electronics"];
  electronics["noiseless_channels"] = true;
  setup["sensors"][0].erase("electronics");
  render_to(work, setup, "without");
  setup["sensors"][0]["electronics"] = electronics;
  render_to(work, setup, "with");
  CHECK_FALSE(std::filesystem::exists(work / "without/pmd_0000.mean_radiance.npy"));
  CHECK_FALSE(std::filesystem::exists(work / "without/pmd_0000.f0.saturated.npy"));
  for (const std::string channel : {"f0.amplitude", "f0.distance_m", "f1.phase_rad"})
    CHECK(content_of(work / ("without/pmd_0000." + channel + ".npy")) ==
          content_of(work / ("with/pmd_0000." + channel + "_noiseless.npy")));
  CHECK(content_of(work / "without/pmd_0000.range_m.npy") == content_of(work / "with/pmd_0000.range_m.npy"));
}

TEST_CASE("check tells of electrons and warns of full taps before a frame is computed") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  const auto check = [&] {
    const Run done = run_pmdsim({"check", work.write("setup.json", setup.dump()), "--json"});
    REQUIRE(done.exit_code == 0);
    return json::parse(done.output);
  };
  const json dim = check()["sensors"][0]["electrons"];
  CHECK(dim["brightest_e"] > dim["darkest_e"]);
  CHECK(dim["share_saturated"] == 0.0);
  CHECK(dim["distance_noise_m"][0] < dim["distance_noise_m"][1]);
  setup["sensors"][0]["electronics"]["integration_time_s"] = 1.0;
  const json bright = check();
  CHECK(bright["sensors"][0]["electrons"]["share_saturated"] > 0.1);
  CHECK(bright["warnings"].dump().find("will be full") != std::string::npos);
  setup["sensors"][0].erase("electronics");
  CHECK(check()["sensors"][0]["electrons"].is_null());
}

TEST_CASE("full taps are told of whatever channels are written") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  setup["sensors"][0]["electronics"]["integration_time_s"] = 1.0;
  for (const char *channels : {"distance_m", "distance_m,range_m", "all"}) {
    const Run done = run_pmdsim({"render", work.write("setup.json", setup.dump()), "-o", work / "out",
                                 "--channels", channels, "--format", "npy"});
    INFO(channels << ": " << done.errors);
    CHECK(done.exit_code == 0);
    CHECK(done.errors.find("[saturated]") != std::string::npos);
    CHECK(json::parse(content_of(work / "out/manifest.json"))["warnings"].dump().find("saturated") !=
          std::string::npos);
  }
}

TEST_CASE("noise writes its tables and pictures, and needs electronics") {
  const Workspace work;
  json setup = with_preset("kinect_v2_like");
  const Run done =
      run_pmdsim({"noise", work.write("setup.json", setup.dump()), "-o", work / "out", "--json"});
  INFO(done.errors);
  REQUIRE(done.exit_code == 0);
  const json report = json::parse(done.output);
  REQUIRE(report["noise"].size() == 3);
  std::size_t predicted = 0;
  for (const json &point : report["noise"][0]["precision"])
    if (!point["distance_noise_m"].is_null() && point["distance_noise_m"] < 0.01 * 9.37) {
      CHECK(point["found_noise_m"].get<double>() ==
            Approx(point["distance_noise_m"].get<double>()).epsilon(0.06));
      ++predicted;
    }
  CHECK(predicted > 10);
  for (const std::string file : {"photon_transfer.csv", "precision.csv", "pmd.f0.precision.png",
                                 "pmd.f2.precision.png", "pmd.photon_transfer.png"})
    CHECK(std::filesystem::file_size(work / ("out/" + file)) > 1000);
  setup["sensors"][0].erase("electronics");
  check_refusal(run_pmdsim({"noise", work.write("bare.json", setup.dump()), "-o", work / "none"}), 3,
                {"bare.json", "/sensors", "electronics"});
  CHECK(work.files("none").empty());
}

TEST_CASE("sensors of other sizes and wishes do not get each other's channels") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  setup["sensors"][0].erase("unwrap_range_m");
  json large = setup["sensors"][0];
  setup["sensors"][0]["electronics"]["noiseless_channels"] = true;
  large["name"] = "large";
  large["resolution"] = {64, 48};
  setup["sensors"].push_back(large);
  setup["frames"] = {{"rate_hz", 30}, {"count", 4}};
  render_to(work, setup, "out");
  for (const std::string frame : {"0000", "0003"}) {
    CHECK(std::filesystem::exists(work / ("out/pmd_" + frame + ".f0.distance_m_noiseless.npy")));
    CHECK_FALSE(std::filesystem::exists(work / ("out/large_" + frame + ".f0.distance_m_noiseless.npy")));
    CHECK(std::filesystem::file_size(work / ("out/large_" + frame + ".f0.saturated.npy")) > 4 * 64 * 48);
  }
}

TEST_CASE("binning after the ADC leaves the photon transfer of one reading") {
  const Workspace work;
  json setup = with_preset("azure_kinect_like");
  setup["sensors"][0]["electronics"]["binning"] = {2, 2};
  setup["sensors"][0]["electronics"]["binning_after_adc"] = true;
  const Run done =
      run_pmdsim({"noise", work.write("setup.json", setup.dump()), "-o", work / "out", "--json"});
  REQUIRE(done.exit_code == 0);
  const json report = json::parse(done.output);
  for (const json &point : report["noise"][0]["photon_transfer"])
    if (point["full"] == false)
      CHECK(point["found_variance_dn2"].get<double>() ==
            Approx(point["variance_dn2"].get<double>()).epsilon(0.15));
}

TEST_CASE("a tradeoff does not take scatter for an error", "[long]") {
  const Workspace work;
  json setup = with_preset("opt8241_like");
  setup["sensors"][0]["resolution"] = {16, 12};
  const Run done =
      run_pmdsim({"tradeoff", work.write("setup.json", setup.dump()), "-o", work / "out", "--json"});
  INFO(done.errors);
  REQUIRE(done.exit_code == 0);
  CHECK(done.errors.find("are left out") != std::string::npos);
  CHECK(json::parse(done.output)["points"][0]["error_max_m"] < 1e-5);
}

TEST_CASE("commands that compare noiseless frames leave electronics out, and say so") {
  const Workspace work;
  const Run done = run_pmdsim({"deform", work.write("setup.json", with_preset("opt8241_like").dump()), "-o",
                               work / "out", "--format", "npy"});
  CHECK(done.exit_code == 0);
  CHECK(done.errors.find("electronics, scatter and unwrapping are left out") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(work / "out/pmd_0000.mean_radiance.npy"));
}

TEST_CASE("electronics that cannot be are refused in one line") {
  const Workspace work;
  const auto check = [&](const std::string &key, const json &value,
                         const std::vector<std::string> &fragments) {
    json setup = with_preset("kinect_v2_like");
    setup["sensors"][0]["electronics"][key] = value;
    check_refusal(run_pmdsim({"check", work.write("setup.json", setup.dump())}), 3, fragments);
  };
  check("quantum_efficiency", 1.2, {"setup.json", "/sensors/0/electronics/quantum_efficiency", "1.2"});
  check("adc_bits", 0, {"/sensors/0/electronics/adc_bits", "0"});
  check("full_well_e", 20, {"/sensors/0/electronics/full_well_e", "read noise"});
  check("preset", "kinect_v3", {"/sensors/0/electronics/preset", "kinect_v3"});
}
