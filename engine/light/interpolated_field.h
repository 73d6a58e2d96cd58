#pragma once
// The light's field, interpolated in cells of the view (host/incident_field.h), and what pixels are off by that
// are summed so.

#include "engine/light/field_grid.h"
#include "engine/model/accuracy.h"

namespace pmdsim {

struct InterpolatedField {
  FieldGrid grid;
  ErrorBound bound;
};

} // namespace pmdsim
