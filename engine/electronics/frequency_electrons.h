#pragma once
// One frequency of a frame, as the loops that count its electrons take it.

#include "engine/electronics/electron_work.h"
#include "engine/electronics/electrons.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim {

class FrequencyElectrons {
public:
  // Makes room for what is counted. Refers to the sensor and to the frame.
  FrequencyElectrons(const Sensor &sensor, bool keep_taps, std::size_t frequency, Measurement &frame);
  FrequencyElectrons(const FrequencyElectrons &) = delete;
  FrequencyElectrons &operator=(const FrequencyElectrons &) = delete;
  ~FrequencyElectrons() = default;

  // The light of the frame as it stands there, or of a strip of it.
  void set_light(const ElectronsRequest &request);
  void set_light(const StripLight &light);

  const ElectronWork &work() const { return work_; }

private:
  using Phasors = std::array<std::array<float, 2>, most_images>;

  static Phasors phasors(std::uint32_t images, double multiple);
  void set_images();
  void set_electronics();
  void set_camera();
  void set_counter();
  void set_output();
  void set_taps_out();
  float *const *room_of_taps(bool keep, std::vector<std::vector<float>> &channel);

  const Sensor &sensor_;
  const Electronics &electronics_;
  bool keep_taps_;
  std::size_t frequency_;
  Measurement &frame_;
  Return &to_;
  Phasors reference_{}, twice_reference_{};
  std::array<const float *, most_images> mean_{}, taps_in_{};
  std::vector<std::vector<float *>> taps_out_; // pointers to arrays of taps, channel by channel
  ElectronWork work_{};
};

} // namespace pmdsim
