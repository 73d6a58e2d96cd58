#include "host/input/file/input_file.h"
#include "host/input/file/json_file.h"
#include "host/input/file/memory_request.h"
#include "host/input/image/image_pixels.h"
#include "host/input/setup/parts.h"

#include <cmath>
#include <fmt/format.h>
#include <span>

namespace pmdsim {

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

// docs/setup.md, "Presets", says which of the figures are published, where, and which are only typical.
constexpr const char *presets_text = R"json({
  "kinect_v2_like": {
    "quantum_efficiency": 0.20, "wavelength_m": 8.6e-7, "demodulation_contrast": 0.67, "full_well_e": 100000,
    "read_noise_e": 60, "dark_current_e_per_s": 6000, "dsnu_e": 100, "prnu": 0.01, "gain_dn_per_e": 0.0098,
    "adc_bits": 10, "offset_dn": 32, "sbi": 0, "two_tap": true
  },
  "azure_kinect_like": {
    "quantum_efficiency": 0.44, "wavelength_m": 8.6e-7, "demodulation_contrast": 0.87, "full_well_e": 20000,
    "read_noise_e": 15, "dark_current_e_per_s": 100, "dsnu_e": 20, "prnu": 0.01, "gain_dn_per_e": 0.049,
    "adc_bits": 10, "offset_dn": 32, "sbi": 0, "two_tap": true
  },
  "opt8241_like": {
    "quantum_efficiency": 0.51, "wavelength_m": 8.5e-7, "demodulation_contrast": 0.45, "full_well_e": 150000,
    "read_noise_e": 75, "dark_current_e_per_s": 14000, "dsnu_e": 120, "prnu": 0.01, "gain_dn_per_e": 0.0265,
    "adc_bits": 12, "offset_dn": 64, "sbi": 0, "two_tap": true
  }
})json";

std::vector<double> contrasts_of(const ordered_json &contrast, const Place &place, const Sensor &sensor) {
  if (contrast.is_number())
    return {contrast.get<double>()};
  const auto each = contrast.get<std::vector<double>>();
  if (each.size() != sensor.modulation_hz.size())
    throw input_error(place, fmt::format("expected a number, or one for each of {} frequencies, found {}",
                                         sensor.modulation_hz.size(), each.size()));
  return each;
}

constexpr std::size_t max_picture_bytes = std::size_t{1} << 28, max_picture_pixels = std::size_t{1} << 26;

// The picture's channel as stored, 0 to 1.
std::vector<float> background_image_of(const ordered_json &background, const Place &place,
                                       const Sensor &sensor) {
  const std::filesystem::path file = place.folder / background.at("texture").get<std::string>();
  const std::string bytes = read_regular_file(file, max_picture_bytes, place);
  const Place in_file{file};
  const ImagePixels pixels = decoded_image(
      {reinterpret_cast<const unsigned char *>(bytes.data()), bytes.size()}, max_picture_pixels, in_file);
  if (pixels.size != sensor.resolution)
    throw input_error(in_file,
                      fmt::format("expected the sensor's {} x {} pixels, found {} x {}", sensor.resolution.x,
                                  sensor.resolution.y, pixels.size.x, pixels.size.y));
  const std::string channel = background.at("channel");
  const std::size_t first = channel == "red" ? 0 : channel == "green" ? 1 : 2;
  require_memory(sensor.pixel_count() * sizeof(float), in_file, "its light");
  std::vector<float> values;
  values.reserve(sensor.pixel_count());
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel)
    values.push_back(static_cast<float>(stored_share(pixels, 4 * pixel + first)));
  return values;
}

void check_together(const Electronics &electronics, const Place &place) {
  if (electronics.full_well_e <= electronics.read_noise_e)
    throw input_error(place / "full_well_e",
                      fmt::format("expected more than the read noise of {} e, found {}",
                                  electronics.read_noise_e, electronics.full_well_e));
  if (electronics.offset_dn >= electronics.largest_dn())
    throw input_error(place / "offset_dn",
                      fmt::format("expected less than {}, the ADC's largest number, found {}",
                                  electronics.largest_dn(), electronics.offset_dn));
  if (electronics.sbi_e > 0.0 && !electronics.two_tap)
    throw input_error(place / "sbi", "expected 0 with one tap: it takes the same from both");
}

// Electrons that are added are those of a larger pixel with a larger well, whose pattern evens out.
Electronics binned(Electronics electronics, std::uint32_t pixels, bool after_adc, const Place &place) {
  constexpr std::uint32_t most_readings = 1u << 16; // that random numbers tell apart
  if (after_adc) {
    electronics.parts_averaged = pixels;
    if (electronics.readings() > most_readings)
      throw input_error(place / "frames_averaged",
                        fmt::format("expected at most {} with so many pixels each, found {}",
                                    most_readings / pixels, electronics.frames_averaged));
    return electronics;
  }
  const double root = std::sqrt(static_cast<double>(pixels));
  electronics.full_well_e *= pixels;
  electronics.dark_current_e_per_s *= pixels;
  electronics.sbi_e *= pixels;
  electronics.dsnu_e *= root;
  electronics.prnu /= root;
  return electronics;
}

} // namespace

void fill_presets(json &setup) {
  static const json presets = json::parse(presets_text);
  if (!setup.is_object() || !setup.contains("sensors") || !setup["sensors"].is_array())
    return;
  for (json &sensor : setup["sensors"]) {
    if (!sensor.is_object() || !sensor.contains("electronics") || !sensor["electronics"].is_object())
      continue;
    json &electronics = sensor["electronics"];
    const auto name = electronics.find("preset");
    if (name == electronics.end() || !name->is_string() || !presets.contains(name->get<std::string>()))
      continue; // the schema says what is wrong
    json filled = presets[name->get<std::string>()];
    filled.update(electronics);
    electronics = std::move(filled);
  }
}

Electronics electronics_of(const ordered_json &electronics, const Place &place, const Sensor &sensor) {
  Electronics result;
  const auto get = [&](const char *key, auto &to) { electronics.at(key).get_to(to); };
  get("integration_time_s", result.integration_time_s);
  get("quantum_efficiency", result.quantum_efficiency);
  get("wavelength_m", result.wavelength_m);
  get("lens_f_number", result.lens_f_number);
  get("lens_transmission", result.lens_transmission);
  get("full_well_e", result.full_well_e);
  get("read_noise_e", result.read_noise_e);
  get("dark_current_e_per_s", result.dark_current_e_per_s);
  get("dsnu_e", result.dsnu_e);
  get("prnu", result.prnu);
  get("gain_dn_per_e", result.gain_dn_per_e);
  get("adc_bits", result.adc_bits);
  get("offset_dn", result.offset_dn);
  get("sbi", result.sbi_e);
  get("two_tap", result.two_tap);
  get("frames_averaged", result.frames_averaged);
  get("seed", result.seed);
  get("noiseless_channels", result.noiseless_channels);
  result.demodulation_contrast =
      contrasts_of(electronics.at("demodulation_contrast"), place / "demodulation_contrast", sensor);
  const ordered_json &background = electronics.at("background_radiance_w_m2_sr");
  if (background.is_object()) {
    background.at("white_w_m2_sr").get_to(result.background_radiance_w_m2_sr);
    result.background_image = background_image_of(background, place / "background_radiance_w_m2_sr", sensor);
  } else {
    background.get_to(result.background_radiance_w_m2_sr);
  }
  check_together(result, place);
  const auto binning = electronics.at("binning").get<glm::uvec2>();
  return binned(result, binning.x * binning.y, electronics.at("binning_after_adc").get<bool>(), place);
}

} // namespace pmdsim
