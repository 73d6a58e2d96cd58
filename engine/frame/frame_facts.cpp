#include "engine/frame/frame_facts.h"

#include "engine/electronics/electrons.h"
#include "engine/sampling/strip_memory.h"
#include "engine/signal/channel_layout.h"
#include "engine/view/id_raster_pass.h"

#include <algorithm>

namespace pmdsim {
namespace {

// A strip is a row of a block's pixels at least, so a block is no wider than the largest strip.
Projection project_blocks(const vulkan::Device &device, const CameraScene &camera, const Sensor &sensor,
                          std::uint32_t largest_strip) {
  const std::uint32_t fragments = std::min(raster_block_fragments(device), largest_strip / sensor.samples);
  return project(camera, sensor.has_distortion() ? distorted_blocks(sensor, fragments)
                                                 : chip_blocks(sensor, fragments));
}

// With shadows, a quarter of the usual on GPUs: 7e7 pairs of sample and diode at a time, which takes none 100
// ms.
std::uint32_t largest_strip(const vulkan::Device &device, const Modulation &modulation,
                            const Sensor &sensor) {
  const std::uint32_t usual = modulation.lit && !device.is_cpu() ? 1u << 18 : 1u << 20;
  return samples_of_a_strip(usual, modulation.sum_planes() + 2, ChannelLayout(modulation).channels(),
                            sensor.samples * sensor.samples);
}

} // namespace

FrameFacts look(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request) {
  FrameFacts facts;
  const bool shaded = request.shadows == Shadows::automatic;
  facts.camera = to_camera(request.scene, request.sensor);
  facts.lights = to_camera(request.illuminators, request.sensor);
  const bool facing = all_face_the_light(facts.camera, facts.lights);
  if (shaded)
    facts.occluders = find_occluders(facts.camera, request.scene, facts.lights);
  facts.modulation = modulation_of(request.sensor, options);
  facts.modulation.keeps_rests = options.keep_unrounded;
  // A spot check compares frames of the light alone.
  facts.counts_electrons =
      options.count_electrons && counts_by_strips(request.sensor) && request.accuracy.mode == Mode::exact;
  if (facts.counts_electrons)
    facts.modulation.keep_taps = false; // the electrons make them
  facts.modulation.lit = shaded && (!facts.occluders.empty() || !facing);
  facts.modulation.keeps_terms = request.accuracy.mode != Mode::exact || request.sensor.adaptive_samples;
  facts.model = sum_model(facts.lights, request.backscatter, facing);
  facts.paint = paint_use(facts.camera, request.scene);
  facts.has_doubles = vulkan::uses_fp64(device, options.precision);
  facts.host_is_device = device.is_cpu();
  if (facts.host_is_device && options.allowed.host_sweep && facts.occluders.with_holes.empty())
    facts.window_bundles = bundles_per_host_window;
  facts.largest_strip = largest_strip(device, facts.modulation, request.sensor);
  facts.projection = project_blocks(device, facts.camera, request.sensor, facts.largest_strip);
  return facts;
}

} // namespace pmdsim
