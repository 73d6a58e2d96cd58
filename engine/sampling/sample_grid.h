#pragma once
// The chip as the points passes read it, and where a strip's samples are an even grid over it
// (shaders/shared/interface.h: SampleGrid).

#include "engine/model/sensor.h"
#include "engine/vulkan/buffer.h"
#include "shaders/shared/interface.h"

#include <memory>

namespace pmdsim {

// True where the samples lie evenly over an upright chip in its nominal place: then their rays are multiples
// of one slope.
bool is_nominal(const Sensor &sensor);

shader::ChipPlace chip_place(const Sensor &sensor);

// Half a sample's width over the image distance, for a nominal chip, as PointsConstants carries it.
shader::vec4 half_sample_slope(const Sensor &sensor);

vulkan::Buffer upload_chip(const vulkan::Device &device, const Sensor &sensor);

class ChipGrid {
public:
  // For a sensor without distortion whose pixels are filled or have one sample.
  ChipGrid(const vulkan::Device &device, const Sensor &sensor);

  bool is_nominal() const { return nominal_; }
  shader::SampleGrid of(const shader::Strip &strip) const;
  const shader::vec4 &slope() const { return slope_; } // as in SampleGrid
  const shader::ChipPlace &place() const { return place_; }
  shader::uvec2 chip() const; // address of its ChipPlace

private:
  bool nominal_;
  shader::vec4 slope_;
  shader::ChipPlace place_;
  std::shared_ptr<const vulkan::Buffer> chip_; // shared by the passes of a frame
};

} // namespace pmdsim
