#include "engine/correction/diode_rows.h"

#include <cmath>

namespace pmdsim {
namespace {

// Beyond it powers are not multiplied out.
constexpr double largest_whole_order = 4096.0;

DiodeLaw law_of(const Pattern &pattern) {
  if (pattern.kind == Pattern::Kind::isotropic)
    return DiodeLaw::isotropic;
  if (pattern.kind == Pattern::Kind::diagram)
    return DiodeLaw::diagram;
  const bool whole = pattern.order == std::floor(pattern.order) && pattern.order <= largest_whole_order;
  return whole ? DiodeLaw::whole_order : DiodeLaw::order;
}

bool belongs_to(const DiodeRow &row, const Pattern &pattern) {
  const DiodeLaw law = law_of(pattern);
  if (row.law != law)
    return false;
  return law == DiodeLaw::diagram ? row.diagram == pattern.diagram
                                  : law == DiodeLaw::isotropic || row.order == pattern.order;
}

void add(DiodeRow &row, const Pose &camera_from_illuminator, const Diode &diode, double phase_turns) {
  const glm::dvec3 position = camera_from_illuminator.point(diode.position_m),
                   axis = camera_from_illuminator.direction(diode.axis),
                   across = camera_from_illuminator.direction(diode.across);
  row.x.push_back(position.x), row.y.push_back(position.y), row.z.push_back(position.z);
  row.axis_x.push_back(axis.x), row.axis_y.push_back(axis.y), row.axis_z.push_back(axis.z);
  row.across_x.push_back(across.x), row.across_y.push_back(across.y), row.across_z.push_back(across.z);
  row.intensity_w_sr.push_back(diode.intensity_w_sr);
  row.phase_turns.push_back(phase_turns);
}

// By dark copies of the last.
void fill_up(DiodeRow &row) {
  while (row.size() % row_step != 0) {
    for (std::vector<double> *values : {&row.x, &row.y, &row.z, &row.axis_x, &row.axis_y, &row.axis_z,
                                        &row.across_x, &row.across_y, &row.across_z, &row.phase_turns})
      values->push_back(values->back());
    row.intensity_w_sr.push_back(0.0);
  }
}

} // namespace

std::vector<DiodeRow> diode_rows(const Sensor &sensor, const std::vector<Illuminator> &illuminators) {
  const Pose camera_from_world = inverse(sensor.world_from_camera);
  std::vector<DiodeRow> rows;
  for (const Illuminator &illuminator : illuminators) {
    const Pose camera_from_illuminator = compose(camera_from_world, illuminator.world_from_illuminator);
    const double phase_turns = illuminator.modulation_phase_rad / radians_per_turn;
    for (const Diode &diode : illuminator.diodes) {
      if (diode.intensity_w_sr <= 0.0)
        continue;
      std::size_t at = 0;
      while (at < rows.size() && !belongs_to(rows[at], diode.pattern))
        ++at;
      if (at == rows.size())
        rows.push_back(
            {.law = law_of(diode.pattern), .order = diode.pattern.order, .diagram = diode.pattern.diagram});
      add(rows[at], camera_from_illuminator, diode, phase_turns - std::floor(phase_turns));
    }
  }
  for (DiodeRow &row : rows)
    fill_up(row);
  return rows;
}

TapDemodulation demodulation_of(const Sensor &sensor) {
  const Waveform &waveform = sensor.waveform;
  TapDemodulation demodulation;
  if (waveform.kind == Waveform::Kind::square) {
    demodulation.kind = TapDemodulation::Kind::square;
    for (std::uint32_t k = 0; k < sensor.taps; ++k) {
      const double angle_rad = radians_per_turn * k / sensor.taps;
      demodulation.tap_cos.push_back(2.0 / sensor.taps * std::cos(angle_rad));
      demodulation.tap_sin.push_back(2.0 / sensor.taps * std::sin(angle_rad));
    }
  }
  if (waveform.kind == Waveform::Kind::harmonics) {
    demodulation.kind = TapDemodulation::Kind::harmonics;
    demodulation.forward.assign(waveform.harmonics.size() + 1, 0.0);
    demodulation.backward = demodulation.forward;
    for (std::size_t h = 1; h <= waveform.harmonics.size(); ++h) {
      if (h % sensor.taps == 1)
        demodulation.forward[h] = waveform.harmonics[h - 1];
      if (h % sensor.taps == sensor.taps - 1)
        demodulation.backward[h] = waveform.harmonics[h - 1];
    }
  }
  return demodulation;
}

} // namespace pmdsim
