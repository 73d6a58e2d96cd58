#pragma once
// The parts of a setup that the sum over the sources has to model.

#include "engine/light/camera_light.h"
#include "engine/light/source_groups.h"
#include "engine/light/tones.h"
#include "engine/model/accuracy.h"
#include "engine/model/scene.h"
#include "engine/model/simulator_options.h"
#include "engine/view/field_grid.h"
#include "shaders/shared/interface.h"

#include <vector>

namespace pmdsim {

// The model that the sum has to follow; parts that a setup does not need are compiled out.
struct SumModel {
  std::uint32_t backscatter; // shader::backscatter_*
  std::uint32_t pattern;     // shader::pattern_*
  double order;              // of shader::pattern_power
  bool all_facing = false;   // every surface faces every diode

  // The vectors of normals and heights a sample: none, one, or, in double precision, two.
  std::uint32_t surface_vectors(Precision precision) const {
    return backscatter == shader::backscatter_flat ? 0 : precision == Precision::fp64 ? 2 : 1;
  }
};

// Sums over the sources that are interpolated in cells of the view (host/incident_field.h), and the bound of
// pixels that are summed so.
struct InterpolatedField {
  FieldGrid grid;
  std::vector<FieldBeam> beams; // of each run
  ErrorBound bound;
};

// The powers of 1 / r in a diode's weight, beside factors of its own.
double inverse_powers(const SumModel &model);

// Has the moments of `groups` summed by powers where the model allows and it is worth it
// (moment_polynomials.h). `host_sums`: else the host may have them so, place by place.
void choose_polynomials(SourceGroups &groups, const SumModel &model, double wavenumber_rad_m,
                        const PathForms &allowed = {}, bool host_sums = false);

SumModel sum_model(const std::vector<CameraIlluminator> &illuminators, Backscatter backscatter,
                   bool all_face_the_light);

} // namespace pmdsim
