#pragma once
// The complex irradiance of a place by the surfaces around it: rays over the hemisphere, each of which stands
// for the same share of what arrives, as many as the error that is asked for takes.

#include "engine/radiosity/radiosity.h"

#include <vector>

namespace pmdsim {

// Of one tone, W/m^2.
struct Gathered {
  Phasor irradiance;
  Phasor missed;         // what surfaces' light is off by, with its phase (FaceLight::missed)
  float variance = 0.0f; // of irradiance, |z|^2, as rays are as far apart as they are
};

// Tone by tone: the irradiance by diodes, and the standard deviation aimed at as a part of all that arrives,
// diodes' light and bounced.
struct GatherAim {
  std::vector<Phasor> direct;
  std::vector<float> part;
};

class Gather {
public:
  // Both have to outlive this.
  Gather(const Radiosity &radiosity, const std::vector<BounceTone> &tones);

  // Directions are turned about the normal by `turn` of a whole turn, which should be another for each place:
  // then what rays leave out at one place has nothing to do with what they leave out at the next. Sets one
  // value a tone; returns the number of rays. Any number of threads may call this at once.
  std::size_t at(const SurfacePlace &place, double turn, const GatherAim &aim,
                 std::vector<Gathered> &gathered) const;

private:
  const Radiosity &radiosity_;
  std::vector<double> turns_per_m_;
};

} // namespace pmdsim
