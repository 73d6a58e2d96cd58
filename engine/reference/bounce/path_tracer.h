#pragma once
// Ways that light takes from a diode over other surfaces to a point that the lens sees, traced at random and
// backwards: from the point from surface to surface, each of them with light from a diode (next-event
// estimation). The sum of their weights exp(+j kappa length) is z of what bounces, on average, for every
// kappa.

#include "engine/model/bounces.h"
#include "engine/reference/bounce/bounce_caster.h"
#include "engine/reference/bounce/path_numbers.h"
#include "engine/reference/light/light_paths.h"

#include <cstdint>
#include <vector>

namespace pmdsim::reference {

class PathTracer {
public:
  // Keeps references to all but `shadows` and `bounces`. With Shadows::off, diodes light surfaces whatever
  // lies between; from surface to surface light always takes a free way.
  PathTracer(const Scene &scene, const std::vector<CameraTriangle> &triangles,
             const std::vector<Light> &lights, Shadows shadows, const Bounces &bounces);

  // Adds the ways that end at `seen`, each of one more flight between surfaces. Any number of threads may
  // call this at once.
  void trace(const SurfacePoint &seen, PathNumbers &numbers, std::vector<LightPath> &paths) const;

private:
  // What of a path is known: where it is, and what comes from there to the lens.
  struct Way {
    SurfacePoint at;
    double length_m;
    double throughput; // of a radiance at `at`
  };
  // A diode that shines, and its share of all diodes' intensity, up to itself too.
  struct ShiningDiode {
    const Diode *diode;
    double phase_turns, modulation_depth, share, share_up_to;
  };

  // To the next surface; false where there is none that reflects.
  bool fly(Way &way, PathNumbers &numbers) const;
  void add_light(const Way &way, PathNumbers &numbers, std::vector<LightPath> &paths) const;
  const ShiningDiode &choose_diode(double number) const;

  const Scene &scene_;
  BounceCaster caster_;
  bool shadows_;
  std::uint32_t most_flights_;
  std::vector<ShiningDiode> diodes_;
};

} // namespace pmdsim::reference
