#pragma once
// The frame as the host sees it before anything is planned or uploaded.

#include "engine/light/camera_light.h"
#include "engine/light/source_windows.h"
#include "engine/light/sum_model.h"
#include "engine/light/tones.h"
#include "engine/model/accuracy.h"
#include "engine/model/simulator_options.h"
#include "engine/shadow/occluders.h"
#include "engine/view/projection.h"
#include "engine/view/surface_appearance.h"

#include <vector>

namespace pmdsim {

// The scene, sensor and light to measure, and how exactly. The scene outlives the preparation only.
struct FrameRequest {
  const Scene &scene;
  Sensor sensor;
  std::vector<Illuminator> illuminators;
  Backscatter backscatter;
  Shadows shadows;
  Accuracy accuracy;
};

struct FrameFacts {
  CameraScene camera;
  std::vector<CameraIlluminator> lights;
  Occluders occluders; // empty with Shadows::off
  Modulation modulation;
  SumModel model;
  Projection projection;
  PaintUse paint;
  std::uint32_t largest_strip; // samples
  bool has_doubles;            // the work done once a sample is done in them
  bool host_is_device;         // the device is the processor that the program runs on
  bool counts_electrons;       // strip by strip
  std::uint32_t window_bundles = shader::bundles_per_window; // of visibility bits that are there together
};

FrameFacts look(const vulkan::Device &device, const SimulatorOptions &options, const FrameRequest &request);

} // namespace pmdsim
