#pragma once
// The complex irradiance of a place by the surfaces around it: lines over the hemisphere, as many as the
// error that is asked for takes.

#include "engine/radiosity/radiosity.h"
#include "engine/surfaces/hemisphere_scan.h"

#include <array>
#include <vector>

namespace pmdsim {

// Of one tone, W/m^2.
struct Gathered {
  Phasor irradiance;
  // The change with a tilt of the surface, by coordinates of the world: times the direction towards which its
  // normal moves.
  std::array<Phasor, 3> by_tilt;
  // Of irradiance, |z|^2: as lines are as far apart as they are, and as elements are as large as they are.
  float of_lines = 0.0f, of_elements = 0.0f;
};

// Tone by tone: the irradiance by diodes, and the standard deviation aimed at as a part of all that arrives,
// diodes' light and bounced.
struct GatherAim {
  std::vector<Phasor> direct;
  std::vector<float> part;
};

class ElementErrors;

class Gather {
public:
  // Both have to outlive this.
  Gather(const Radiosity &radiosity, const std::vector<BounceTone> &tones);

  struct Lines {
    std::size_t looked = 0;   // along which was looked
    std::uint32_t needed = 0; // that would have been enough
  };

  // `turn` as HemisphereScan's; `guess` is how many lines may be needed, 0 where nobody knows. Sets one value
  // a tone. Any number of threads may call this at once.
  Lines at(const SurfacePlace &place, double turn, std::uint32_t guess, const GatherAim &aim,
           std::vector<Gathered> &gathered) const;

  // How many times its part of all that arrives, diodes' light and bounced, elements may be off by there: two
  // standard deviations of the half of it that turns the phase, of the tone where that is most.
  float times_off(const SurfacePlace &place, double turn, const std::vector<Phasor> &direct,
                  const std::vector<float> &part) const;

private:
  void look(const SurfacePlace &place, double turn, std::uint32_t lines, std::vector<Gathered> &sums) const;
  // By a line that stands for so many.
  void add_missed(const SeenLine &line, float lines, const Exitance::OfFaces &faces,
                  ElementErrors &missed) const;

  const Radiosity &radiosity_;
  std::vector<std::uint32_t> element_of_face_; // and no_element where nothing is seen
  std::vector<double> turns_per_m_;
};

} // namespace pmdsim
