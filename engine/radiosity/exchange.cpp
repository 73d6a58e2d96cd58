#include "engine/radiosity/exchange.h"

#include "engine/radiosity/line_tilt.h"

#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

// What scatters light: the element of a face, and how much of it.
struct Scattering {
  std::uint32_t element = no_element; // where nothing is seen
  float reflectivity = 0.0f;
  bool is_tilted = false; // a member of a group, which has its tilt in place of what a line sees
  glm::vec2 tilt{0.0f};
};

std::vector<Scattering> scattering_of(const Elements &elements, const ElementLight &layout) {
  std::vector<Scattering> faces(2 * elements.facets.size() + 1);
  for (std::size_t i = 0; i < elements.facets.size(); ++i)
    for (std::size_t side = 0; side < 2; ++side) {
      const Facet &facet = elements.facets[i];
      if (facet.elements[side] == no_element)
        continue;
      faces[2 * i + side] = {facet.elements[side], facet.reflectivity, facet.whole,
                             facet.whole ? layout.tilt_of(facet, side) : glm::vec2(0.0f)};
    }
  return faces;
}

// The entries of a value, while they are summed up.
class OpenRow {
public:
  void reserve(std::size_t elements) {
    weights_.resize(elements);
    is_open_.resize(elements);
  }
  std::size_t size() const { return open_.size(); }

  void add(const SeenLine &line, const LineWays &ways, const LineTilt &part,
           const std::vector<Scattering> &faces) {
    const std::size_t bins = line.bins->count;
    const float *cotangents = line.bins->cotangent;
    for (std::size_t i = 0; i < bins;) {
      const std::uint32_t element = faces[static_cast<std::size_t>(line.face[i])].element;
      TriangleLight sum; // of bins side by side
      for (; i < bins; ++i) {
        const Scattering &face = faces[static_cast<std::size_t>(line.face[i])];
        if (face.element != element)
          break;
        const float share = face.reflectivity * (part.of_line + part.of_bins * cotangents[i]);
        const Phasor way{share * ways.re[i], share * ways.im[i]};
        sum.at += way;
        sum.by_u += (face.is_tilted ? face.tilt.x : line.u[i]) * way;
        sum.by_v += (face.is_tilted ? face.tilt.y : line.v[i]) * way;
      }
      if (element != no_element)
        add(element, sum);
    }
  }

  // And starts again.
  template <class Visit>
  void close(const Visit &visit) {
    for (const std::uint32_t element : open_) {
      visit(element, weights_[element]);
      weights_[element] = {};
      is_open_[element] = 0;
    }
    open_.clear();
  }

private:
  void add(std::uint32_t element, const TriangleLight &weights) {
    if (is_open_[element] == 0) {
      is_open_[element] = 1;
      open_.push_back(element);
    }
    weights_[element] += weights;
  }

  std::vector<TriangleLight> weights_;
  std::vector<std::uint8_t> is_open_;
  std::vector<std::uint32_t> open_;
};

// How each of a place's values, as ElementLight has them, follows from the parts of a line.
using ValueParts = std::array<LineTilt, ElementLight::values_of_group_place>;

ValueParts parts_of(const Element &element, const SurfaceFrame &frame, const SeenLine &line) {
  if (!element.is_group)
    return {LineTilt{1.0f, 0.0f}};
  LineTilt along_mean = tilt_towards(element.axes[0], frame, line);
  along_mean.of_line += 1.0f;
  return {along_mean, tilt_towards(element.axes[1], frame, line), tilt_towards(element.axes[2], frame, line)};
}

} // namespace

Exchange::Exchange(const Elements &elements, const ElementLight &layout, const HemisphereScan &scan,
                   std::uint32_t lines, const std::vector<BounceTone> &tones, const Exitance &direct)
    : layout_(layout), tones_(tones.size()) {
  const std::vector<Scattering> faces = scattering_of(elements, layout);
  for (OfTone &of_tone : tones_) {
    of_tone.first.resize(layout.values());
    of_tone.values.resize(layout.values());
  }
  const LineLightLoops &loops = line_light_loops();
  tbb::parallel_for(std::size_t{0}, elements.elements.size() * places_of_piece, [&](std::size_t number) {
    thread_local std::vector<OpenRow> rows; // of each tone's values
    const std::size_t of_element = number / places_of_piece, of_place = number % places_of_piece;
    const Element &element = elements.elements[of_element];
    const std::size_t first = layout.first_value(of_element, of_place),
                      count = layout.values_of_place(of_element);
    rows.resize(tones.size() * count);
    for (OpenRow &row : rows)
      row.reserve(elements.elements.size());
    const SurfaceFrame frame = scan.frame(element.places[of_place], turn_of(number), lines);
    scan.at(frame, lines, [&](const SeenLine &line) {
      const ValueParts parts = parts_of(element, frame, line);
      LineWays ways;
      for (std::size_t t = 0; t < tones.size(); ++t) {
        loops.find_ways(line, tones[t].turns_per_m(), ways);
        const LineLight light = loops.add_light(line, ways, direct.of_tone(t).data());
        for (std::size_t k = 0; k < count; ++k) {
          tones_[t].first[first + k] += parts[k].of(light);
          rows[t * count + k].add(line, ways, parts[k], faces);
        }
      }
    });
    for (std::size_t t = 0; t < tones.size(); ++t)
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<Entry> &entries = tones_[t].values[first + k];
        entries.reserve(rows[t * count + k].size());
        rows[t * count + k].close([&](std::uint32_t seen, const TriangleLight &weights) {
          entries.push_back({seen, weights});
        });
      }
  });
}

std::vector<Phasor> Exchange::bounced(std::size_t tone, std::span<const TriangleLight> elements,
                                      bool with_last_places) const {
  const OfTone &of = tones_[tone];
  const std::size_t places = with_last_places ? places_of_piece : places_of_piece - 1;
  std::vector<Phasor> values(of.values.size());
  tbb::parallel_for(std::size_t{0}, elements.size(), [&](std::size_t element) {
    const std::size_t first = layout_.first_value(element, 0),
                      end = first + places * layout_.values_of_place(element);
    for (std::size_t i = first; i < end; ++i) {
      Phasor sum;
      for (const auto &[seen, weights] : of.values[i]) {
        const TriangleLight &light = elements[seen];
        sum += weights.at * light.at + weights.by_u * light.by_u + weights.by_v * light.by_v;
      }
      values[i] = sum;
    }
  });
  return values;
}

} // namespace pmdsim
