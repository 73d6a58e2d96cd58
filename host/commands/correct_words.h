#pragma once
// What `correct` tells of an image, for people and as JSON.

#include "engine/correction/correction.h"
#include "host/command_line/correct_options.h"
#include "host/correction/error_table.h"
#include "host/correction/measured_file.h"
#include "host/input/setup/setup.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// What an image is corrected for.
struct Scenery {
  Instant instant;
  std::size_t sensor;

  const Sensor &camera() const { return instant.sensors[sensor]; }
};

// Of one command.
struct Outcome {
  const MeasuredFile &measured;
  const Scenery &scenery;
  const CorrectOptions &options;
  CorrectedImage corrected;
  std::string truth; // what it is compared with; empty: nothing
  std::vector<ErrorRow> errors{};
  std::size_t wrong_turns = 0; // pixels, as wrong_turns()
  std::vector<std::string> effects{}, outputs{};
  std::vector<Warning> warnings{}; // of the setup and the image

  std::size_t count(PixelStatus status) const { return corrected.counts[static_cast<std::size_t>(status)]; }
};

nlohmann::ordered_json json_of(const Outcome &of);
std::string text_of(const Outcome &of);

} // namespace pmdsim
