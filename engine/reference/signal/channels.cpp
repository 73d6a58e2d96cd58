#include "engine/reference/signal/channels.h"

#include <complex>
#include <limits>

namespace pmdsim::reference {

namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

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

Return rounded(const FrameReturn &exact) {
  Return result{rounded(exact.amplitude),
                rounded_below(exact.phase_rad, full_turn_rad),
                rounded_below(exact.distance_m, exact.ambiguity_m),
                {}};
  for (const std::vector<double> &tap : exact.taps)
    result.taps.push_back(rounded(tap));
  return result;
}

void set_return(FrameReturn &channels, std::size_t pixel, const ReturnSum &sum, std::uint32_t samples) {
  for (std::uint32_t k = 0; k < channels.taps.size(); ++k)
    channels.taps[k][pixel] = sum.tap(k) / samples;
  const std::complex<double> z = sum.z() / static_cast<double>(samples);
  channels.z[pixel] = z;
  channels.amplitude[pixel] = std::abs(z);
  channels.condition[pixel] = sum.weight() / samples / channels.amplitude[pixel];
  if (channels.amplitude[pixel] > 0) {
    channels.phase_rad[pixel] = phase_of_rad(z);
    channels.distance_m[pixel] =
        below(channels.ambiguity_m * (channels.phase_rad[pixel] / full_turn_rad), channels.ambiguity_m);
  }
}

} // namespace

PixelSums::PixelSums(const Sensor &sensor) {
  returns.reserve(sensor.modulation_hz.size());
  for (const double modulation_hz : sensor.modulation_hz)
    returns.emplace_back(sensor, modulation_hz);
}

Frame dark_frame(const Sensor &sensor) {
  const std::size_t pixels = sensor.pixel_count();
  const std::size_t samples = pixels * sensor.samples * sensor.samples;
  const std::vector<double> dark(pixels, 0.0), unknown(pixels, no_value);
  Frame frame;
  frame.resolution = sensor.resolution;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    frame.returns.push_back({sensor.ambiguity_m(i), std::vector<std::complex<double>>(pixels), dark, unknown,
                             unknown, std::vector(sensor.taps, dark), unknown});
  frame.coverage = dark;
  frame.range_m = frame.z_m = unknown;
  frame.triangle_id.assign(pixels, no_id);
  frame.object_id.assign(pixels, no_id);
  frame.sample_triangle_id.assign(samples, no_id);
  return frame;
}

void set_channels(Frame &frame, std::size_t pixel, const PixelSums &sums, std::uint32_t samples) {
  frame.coverage[pixel] = static_cast<double>(sums.hits) / samples;
  if (sums.hits > 0) {
    frame.range_m[pixel] = sums.range_m.value() / sums.hits;
    frame.z_m[pixel] = sums.z_m.value() / sums.hits;
  }
  for (std::size_t i = 0; i < sums.returns.size(); ++i)
    set_return(frame.returns[i], pixel, sums.returns[i], samples);
}

Measurement to_measurement(const Frame &frame) {
  Measurement measurement;
  measurement.resolution = frame.resolution;
  for (const FrameReturn &of_frequency : frame.returns)
    measurement.returns.push_back(rounded(of_frequency));
  measurement.range_m = rounded(frame.range_m);
  measurement.z_m = rounded(frame.z_m);
  measurement.coverage = rounded(frame.coverage);
  measurement.lit = rounded(frame.lit);
  measurement.triangle_id = frame.triangle_id;
  measurement.object_id = frame.object_id;
  measurement.frame_ms = frame.frame_ms;
  measurement.passes = {{"reference", frame.frame_ms}};
  return measurement;
}

} // namespace pmdsim::reference
