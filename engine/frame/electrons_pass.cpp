#include "engine/frame/electrons_pass.h"

#include "engine/electronics/electrons.h"
#include "engine/signal/channel_layout.h"

#include <cstdint>

namespace pmdsim {
namespace {

StripLight light_of(const shader::Strip &strip, const Modulation &modulation, const StripBuffers &buffers) {
  const ChannelLayout layout(modulation);
  const auto pairs = [&](std::uint32_t channel) {
    return reinterpret_cast<const float *>(pair_for_host(buffers, strip, channel).data());
  };
  StripLight light{strip.column,
                   strip.row,
                   strip.columns,
                   strip.rows,
                   modulation.complex_returns,
                   {},
                   pairs(layout.mean_channel())};
  for (std::uint32_t f = 0; f < layout.frequencies; ++f)
    light.returns.push_back(pairs(layout.first_channel(f)));
  return light;
}

} // namespace

Pass electrons_pass(const Sensor &sensor, const Modulation &modulation, const SimulatorOptions &options,
                    const StripBuffers &buffers) {
  const ElectronsRequest request{.keep_taps = options.keep_taps,
                                 .host_vector_bits = options.host_vector_bits};
  return {.name = "electrons",
          .reads = channels,
          .writes = no_resource,
          .record = {},
          .store = [=, &buffers](const Recording &at, Measurement &to) {
            count_electrons(sensor, request, light_of(at.of_strip(), modulation, buffers), to);
          }};
}

} // namespace pmdsim
