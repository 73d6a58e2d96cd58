#include "host/capture/rendered_frame.h"

#include "host/capture/frame_writer.h"

#include <algorithm>
#include <utility>

namespace pmdsim {

MeasuredPart rendered_frame(const std::shared_ptr<const TakenFrame> &taken, const SensorFrame &at,
                            const std::set<Format> &formats) {
  const auto &[sensor, measurement, mode] = *taken;
  auto frame =
      std::make_shared<const FrameToWrite>(FrameToWrite{sensor, at.frame, channels_of(measurement), taken});
  return {{sensor, at.frame, at.time_s, measurement.frame_ms, measurement.passes, mode, measurement.accuracy},
          [frame = std::move(frame), formats] { return files_of(frame, formats); }};
}

std::size_t bytes_of_rendered_frame(const Setup &setup) {
  std::size_t most = 0;
  for (const Sensor &sensor : setup.start.sensors)
    most = std::max(most, bytes_of_frame(sensor, true));
  return most;
}

} // namespace pmdsim
