#pragma once

#include <string>

namespace pmdsim {

// What one pass of a frame took on the device.
struct PassTime {
  std::string name;
  double ms = 0.0;
};

} // namespace pmdsim
