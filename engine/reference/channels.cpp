#include "engine/reference/channels.h"

#include <limits>
#include <numbers>

namespace pmdsim::reference {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double full_turn_rad = 2.0 * std::numbers::pi;

// Rounding can lift a value just below the end of its range to the end itself, which is the same as zero.
template <class Real>
Real below(Real value, double end) {
  return static_cast<double>(value) >= end ? Real{0} : value;
}

double phase_of_rad(const std::complex<double> &z) {
  const double angle_rad = std::arg(z);
  return below(angle_rad < 0 ? angle_rad + full_turn_rad : angle_rad, full_turn_rad);
}

std::vector<float> rounded(const std::vector<double> &values) { return {values.begin(), values.end()}; }

std::vector<float> rounded_below(const std::vector<double> &values, double end) {
  std::vector<float> result = rounded(values);
  for (float &value : result)
    value = below(value, end);
  return result;
}

} // namespace

Frame dark_frame(const Sensor &sensor) {
  const std::size_t pixels = sensor.pixel_count();
  const std::size_t samples = pixels * sensor.samples * sensor.samples;
  Frame frame;
  frame.resolution = sensor.resolution;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i) {
    const std::vector<double> dark(pixels, 0.0), unknown(pixels, nan);
    frame.returns.push_back(
        {sensor.ambiguity_m(i), std::vector<std::complex<double>>(pixels), dark, unknown, unknown, {}});
  }
  for (auto *channel : {&frame.coverage})
    channel->assign(pixels, 0.0);
  for (auto *channel : {&frame.range_m, &frame.z_m})
    channel->assign(pixels, nan);
  for (auto *ids : {&frame.triangle_id, &frame.object_id})
    ids->assign(pixels, no_id);
  frame.sample_triangle_id.assign(samples, no_id);
  return frame;
}

void set_channels(Frame &frame, std::size_t pixel, const PixelSums &sums, std::uint32_t samples) {
  frame.coverage[pixel] = static_cast<double>(sums.hits) / samples;
  if (sums.hits > 0) {
    frame.range_m[pixel] = sums.range_m.value() / sums.hits;
    frame.z_m[pixel] = sums.z_m.value() / sums.hits;
  }
  const std::complex<double> z = sums.z.value() / static_cast<double>(samples);
  frame.returns[0].z[pixel] = z;
  frame.returns[0].amplitude[pixel] = std::abs(z);
  if (frame.returns[0].amplitude[pixel] > 0) {
    frame.returns[0].phase_rad[pixel] = phase_of_rad(z);
    frame.returns[0].distance_m[pixel] =
        below(frame.returns[0].ambiguity_m * (frame.returns[0].phase_rad[pixel] / full_turn_rad),
              frame.returns[0].ambiguity_m);
  }
}

Measurement to_measurement(const Frame &frame) {
  Measurement measurement;
  measurement.resolution = frame.resolution;
  measurement.returns.resize(1);
  measurement.returns[0].amplitude = rounded(frame.returns[0].amplitude);
  measurement.returns[0].phase_rad = rounded_below(frame.returns[0].phase_rad, full_turn_rad);
  measurement.returns[0].distance_m =
      rounded_below(frame.returns[0].distance_m, frame.returns[0].ambiguity_m);
  measurement.range_m = rounded(frame.range_m);
  measurement.z_m = rounded(frame.z_m);
  measurement.coverage = rounded(frame.coverage);
  measurement.triangle_id = frame.triangle_id;
  measurement.object_id = frame.object_id;
  measurement.frame_ms = frame.frame_ms;
  measurement.passes = {{"reference", frame.frame_ms}};
  return measurement;
}

} // namespace pmdsim::reference
