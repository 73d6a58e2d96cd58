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
  result.direct_amplitude = rounded(exact.direct_amplitude);
  result.direct_phase_rad = rounded_below(exact.direct_phase_rad, full_turn_rad);
  result.direct_distance_m = rounded_below(exact.direct_distance_m, exact.ambiguity_m);
  result.multipath_m = rounded(exact.multipath_m);
  result.multipath_error_m = rounded(exact.multipath_error_m);
  result.indirect_share = rounded(exact.indirect_share);
  result.unrounded_distance_m = exact.distance_m;
  result.unrounded_direct_distance_m = exact.direct_distance_m;
  return result;
}

// In channels where there was no light.
void set_light(const std::complex<double> &z, double ambiguity_m, double &amplitude, double &phase_rad,
               double &distance_m) {
  amplitude = std::abs(z);
  if (amplitude > 0) {
    phase_rad = phase_of_rad(z);
    distance_m = below(ambiguity_m * (phase_rad / full_turn_rad), ambiguity_m);
  }
}

// From the direct light to all of it, -1/2 (not included) to 1/2.
double multipath_turns(const std::complex<double> &z, const std::complex<double> &direct_z) {
  const double turns = std::arg(z * std::conj(direct_z)) / full_turn_rad;
  return turns <= -0.5 ? 0.5 : turns;
}

void set_multipath(FrameReturn &channels, std::size_t pixel, const std::complex<double> &direct_z,
                   const IndirectReturn &indirect) {
  channels.direct_z[pixel] = direct_z;
  set_light(direct_z, channels.ambiguity_m, channels.direct_amplitude[pixel],
            channels.direct_phase_rad[pixel], channels.direct_distance_m[pixel]);
  channels.z_error[pixel] = indirect.standard_error();
  const std::complex<double> z = channels.z[pixel];
  if (z == 0.0)
    return;
  channels.indirect_share[pixel] = direct_z == 0.0 ? 1.0 : std::abs(indirect.mean.z) / std::abs(z);
  if (direct_z == 0.0)
    return;
  channels.multipath_m[pixel] = channels.ambiguity_m * multipath_turns(z, direct_z);
  channels.multipath_error_m[pixel] =
      channels.ambiguity_m * (indirect.standard_error_across(z) / std::abs(z) / full_turn_rad);
}

void set_return(FrameReturn &channels, std::size_t pixel, const MeanReturn &all) {
  for (std::size_t k = 0; k < channels.taps.size(); ++k)
    channels.taps[k][pixel] = all.taps[k];
  channels.z[pixel] = all.z;
  set_light(all.z, channels.ambiguity_m, channels.amplitude[pixel], channels.phase_rad[pixel],
            channels.distance_m[pixel]);
  channels.condition[pixel] = all.weight / channels.amplitude[pixel];
}

MeanReturn together(MeanReturn direct, const MeanReturn &indirect) {
  direct.z += indirect.z;
  direct.weight += indirect.weight;
  direct.mean_radiance += indirect.mean_radiance;
  for (std::size_t k = 0; k < direct.taps.size(); ++k)
    direct.taps[k] += indirect.taps[k];
  return direct;
}

} // namespace

PixelSums::PixelSums(const Sensor &sensor) {
  returns.reserve(sensor.modulation_hz.size());
  for (const double modulation_hz : sensor.modulation_hz)
    returns.emplace_back(sensor, modulation_hz);
}

Frame dark_frame(const Sensor &sensor, const Bounces &bounces) {
  const std::size_t pixels = sensor.pixel_count();
  const std::size_t samples = pixels * sensor.samples * sensor.samples;
  const std::vector<double> dark(pixels, 0.0), unknown(pixels, no_value);
  Frame frame;
  frame.resolution = sensor.resolution;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    frame.returns.push_back({sensor.ambiguity_m(i), std::vector<std::complex<double>>(pixels), dark, unknown,
                             unknown, std::vector(sensor.taps, dark), unknown});
  if (bounces.any())
    for (FrameReturn &channels : frame.returns) {
      channels.direct_z.resize(pixels);
      channels.direct_amplitude = channels.z_error = dark;
      channels.direct_phase_rad = channels.direct_distance_m = unknown;
      channels.multipath_m = channels.multipath_error_m = channels.indirect_share = unknown;
    }
  frame.coverage = dark;
  if (sensor.electronics)
    frame.mean_radiance = dark;
  frame.range_m = frame.z_m = unknown;
  frame.triangle_id.assign(pixels, no_id);
  frame.object_id.assign(pixels, no_id);
  frame.sample_triangle_id.assign(samples, no_id);
  return frame;
}

void set_channels(Frame &frame, std::size_t pixel, const PixelSums &sums, std::uint32_t samples,
                  const std::vector<IndirectReturn> &indirect) {
  frame.coverage[pixel] = static_cast<double>(sums.hits) / samples;
  if (sums.hits > 0) {
    frame.range_m[pixel] = sums.range_m.value() / sums.hits;
    frame.z_m[pixel] = sums.z_m.value() / sums.hits;
  }
  for (std::size_t i = 0; i < sums.returns.size(); ++i) {
    const MeanReturn direct = sums.returns[i].mean(samples);
    const MeanReturn all = indirect.empty() ? direct : together(direct, indirect[i].mean);
    set_return(frame.returns[i], pixel, all);
    if (!frame.mean_radiance.empty())
      frame.mean_radiance[pixel] = all.mean_radiance; // the same of each frequency
    if (indirect.empty())
      continue;
    set_multipath(frame.returns[i], pixel, direct.z, indirect[i]);
  }
}

Measurement to_measurement(const Frame &frame) {
  Measurement measurement;
  measurement.resolution = frame.resolution;
  for (const FrameReturn &of_frequency : frame.returns)
    measurement.returns.push_back(rounded(of_frequency));
  measurement.range_m = rounded(frame.range_m);
  measurement.unrounded_range_m = frame.range_m;
  measurement.z_m = rounded(frame.z_m);
  measurement.coverage = rounded(frame.coverage);
  measurement.lit = rounded(frame.lit);
  measurement.mean_radiance = rounded(frame.mean_radiance);
  measurement.triangle_id = frame.triangle_id;
  measurement.object_id = frame.object_id;
  measurement.frame_ms = frame.frame_ms;
  measurement.passes = {{"reference", frame.frame_ms}};
  return measurement;
}

} // namespace pmdsim::reference
