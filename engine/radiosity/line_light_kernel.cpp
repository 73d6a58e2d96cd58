// The loops of light along a line. Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET its name;
// see engine/CMakeLists.txt.
#include "engine/model/elementary_lanes.h"
#include "engine/radiosity/line_light.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

// Sums go by so many all_bins side by side whatever the vectors, so that they round alike.
constexpr int columns = 16, vectors = columns / lanes;

class ColumnSum {
public:
  void add(int column, const Floats &values) { sums_[column / lanes] += values; }
  float total() const {
    float total = 0.0f;
    for (const Floats &sum : sums_)
      for (int lane = 0; lane < lanes; ++lane)
        total += sum[lane];
    return total;
  }

private:
  Floats sums_[vectors] = {};
};

void find_ways(const SeenLine &line, double turns_per_m, LineWays &ways) {
  for (std::uint32_t i = 0; i < line.bins->count; i += lanes) {
    const Complex phasor = unit_phasor(turn_fraction(wide(load<Floats>(line.length_m + i)) * turns_per_m));
    const Complex way = load<Floats>(line.share + i) * phasor;
    store(ways.re + i, way.re);
    store(ways.im + i, way.im);
  }
}

LineLight add_light(const SeenLine &line, const LineWays &ways, const FaceLight *faces) {
  const auto *values = reinterpret_cast<const float *>(faces);
  constexpr int of_face = sizeof(FaceLight) / sizeof(float);
  ColumnSum re, im, along_re, along_im;
  for (std::uint32_t first = 0; first < line.bins->count; first += columns)
    for (int column = 0; column < columns; column += lanes) {
      const std::uint32_t i = first + static_cast<std::uint32_t>(column);
      const Ints face = of_face * load<Ints>(line.face + i);
      const Floats u = load<Floats>(line.u + i), v = load<Floats>(line.v + i);
      const Floats4 at = gathered4(values, face), by = gathered4(values + 4, face);
      const Complex leaving{at.of[0] + u * at.of[2] + v * by.of[0], at.of[1] + u * at.of[3] + v * by.of[1]};
      const Complex arriving = Complex{load<Floats>(ways.re + i), load<Floats>(ways.im + i)} * leaving;
      const Floats along = load<Floats>(line.bins->cotangent + i);
      re.add(column, arriving.re);
      im.add(column, arriving.im);
      along_re.add(column, along * arriving.re);
      along_im.add(column, along * arriving.im);
    }
  return {{re.total(), im.total()}, {along_re.total(), along_im.total()}};
}

} // namespace

extern const LineLightLoops loops_of_line_light;
const LineLightLoops loops_of_line_light{find_ways, add_light};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
