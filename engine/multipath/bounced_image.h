#pragma once
// The light that has bounced, as a frame's pixels see it. What arrives at surfaces is gathered at some places
// and interpolated between them where that is exact enough: on one plane or smooth surface, never over an
// edge.

#include "engine/multipath/gather.h"
#include "engine/multipath/seen_places.h"

#include <complex>
#include <functional>
#include <vector>

namespace pmdsim {

// One value for each pixel, of a tone.
struct BouncedTone {
  std::vector<std::complex<float>> z; // mean over the samples of rho / pi times what arrives, W/(m^2 sr)
  std::vector<float> deviation;       // of z, |z|: by lines, interpolation and elements
};

struct BouncedImage {
  std::vector<BouncedTone> tones;
  std::size_t lines = 0, gathered = 0; // places at which light was gathered
};

// What the error of z may be, as a part of a pixel's light, tone by tone; and each pixel's direct light,
// W/(m^2 sr), likewise.
struct ImageAim {
  std::vector<float> part;
  std::vector<std::vector<Phasor>> direct;
};

// How many times its part of a pixel's light elements are off by, of the tone where that is most, at 400
// places all over the frame; NaN where these see nothing.
std::vector<float> times_off(const Radiosity &radiosity, const std::vector<BounceTone> &tones,
                             const SeenPlaces &seen, const ImageAim &aim);

BouncedImage gather_image(const Radiosity &radiosity, const std::vector<BounceTone> &tones,
                          const SeenPlaces &seen, const glm::uvec2 &resolution, const ImageAim &aim,
                          const std::function<void(double)> &progress);

} // namespace pmdsim
