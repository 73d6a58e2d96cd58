#pragma once
// The chip as the points passes read it.

#include "engine/model/sensor.h"
#include "engine/vulkan/buffer.h"
#include "shaders/shared/interface.h"

namespace pmdsim {

// True where the samples lie evenly over an upright chip in its nominal place: then their rays are multiples
// of one slope.
bool is_plain(const Sensor &sensor);

shader::ChipPlace chip_place(const Sensor &sensor);

// Of a nominal chip, as PointsConstants carries it: half a sample's width over the image distance.
shader::vec4 half_sample_slope(const Sensor &sensor);

vulkan::Buffer upload_chip(const vulkan::Device &device, const Sensor &sensor);

} // namespace pmdsim
