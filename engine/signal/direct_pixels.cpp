#include "engine/signal/direct_pixels.h"

#include "engine/sampling/pixel_lists.h"
#include "engine/signal/channel_layout.h"
#include "engine/signal/demodulation_pass.h"
#include "shaders/shared/constants.h"

#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

namespace pmdsim {

bool holds_pixels(const Modulation &modulation) {
  return modulation.keeps_terms && (modulation.reports_kept || modulation.keeps_bounds);
}

std::shared_ptr<const SumOutput> direct_pixels(const PassSetup &on, const SourceGroups &groups,
                                               const SumScope &scope) {
  const shader::DirectPixels record{on.buffers.channels.words(),
                                    on.scene.paint.shapes.words(),
                                    on.scene.paint.surfaces.words(),
                                    on.buffers.lit.words(),
                                    on.buffers.sum.words(), // which is not there otherwise
                                    on.scene.backscatter.value_or(0.0f),
                                    0};
  const auto frequencies =
      frequency_records(on.modulation, groups.largest_intensity_w_sr, scope.bound, groups.diode_count);
  std::vector<std::byte> bytes(sizeof(record) + frequencies.size() * sizeof(shader::Frequency));
  std::memcpy(bytes.data(), &record, sizeof(record));
  std::memcpy(bytes.data() + sizeof(record), frequencies.data(), bytes.size() - sizeof(record));
  vulkan::Specialization constants = demodulation_constants(on, scope, false);
  constants.set(shader::constant_holds_pixels, holds_pixels(on.modulation))
      .set(shader::constant_lit_is_kept, on.modulation.lit)
      .set(shader::constant_surface_vectors, 0)
      .set(shader::constant_vignetting, on.sensor.vignetting == Vignetting::cos4)
      .set(shader::constant_painted, on.scene.paint.painted)
      .set(shader::constant_one_backscatter, on.scene.backscatter.has_value());
  return std::make_shared<const SumOutput>("direct_pixels", std::move(constants),
                                           vulkan::upload(on.device, bytes));
}

} // namespace pmdsim
