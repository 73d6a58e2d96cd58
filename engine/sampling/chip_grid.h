#pragma once
// The chip where a strip's samples are an even grid over it (shaders/shared/interface.h: SampleGrid).

#include "engine/model/sensor.h"
#include "engine/vulkan/buffer.h"
#include "shaders/shared/interface.h"

#include <memory>

namespace pmdsim {

class ChipGrid {
public:
  // Of a sensor without distortion whose pixels are filled or have one sample.
  ChipGrid(const vulkan::Device &device, const Sensor &sensor);

  bool is_nominal() const { return nominal_; }
  shader::SampleGrid of(const shader::Strip &strip) const;
  shader::uvec2 chip() const; // address of its ChipPlace

private:
  bool nominal_;
  shader::vec4 slope_;
  std::shared_ptr<const vulkan::Buffer> chip_; // shared by the passes of a frame
};

} // namespace pmdsim
