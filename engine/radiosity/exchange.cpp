#include "engine/radiosity/exchange.h"

#include "engine/radiosity/line_tilt.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace pmdsim {

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

// What lines saw of one element.
struct SeenElement {
  TriangleLight weights;
  std::uint32_t bins = 0;
};

// The elements that a value's lines see, while they are summed up.
class OpenRow {
public:
  void reserve(std::size_t elements) { of_elements_.resize(elements); }
  const std::vector<std::uint32_t> &seen() const { return seen_; }
  const SeenElement &of(std::uint32_t element) const { return of_elements_[element]; }

  void add(const SeenLine &line, const LineWays &ways, const LineTilt &part,
           const std::vector<Scattering> &faces) {
    const std::uint32_t bins = line.bins->count;
    const float *cotangents = line.bins->cotangent;
    for (std::uint32_t i = 0; i < bins;) {
      const std::uint32_t element = faces[static_cast<std::size_t>(line.face[i])].element, first = i;
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
        add(element, sum, i - first);
    }
  }

  void clear() {
    for (const std::uint32_t element : seen_)
      of_elements_[element] = {};
    seen_.clear();
  }

private:
  void add(std::uint32_t element, const TriangleLight &weights, std::uint32_t bins) {
    SeenElement &of = of_elements_[element];
    if (of.bins == 0)
      seen_.push_back(element);
    of.weights += weights;
    of.bins += bins;
  }

  std::vector<SeenElement> of_elements_;
  std::vector<std::uint32_t> seen_;
};

namespace {

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

// Few bins meet an element at places of it that are left to chance: its middle stands for it as well.
void Exchange::close(OpenRow &open, const Elements &elements, Row &row) {
  constexpr std::uint32_t few = 3;
  const auto is_near = [&](std::uint32_t element) {
    return open.of(element).bins > few || elements.elements[element].is_group;
  };
  row.near.reserve(static_cast<std::size_t>(std::ranges::count_if(open.seen(), is_near)));
  row.far.reserve(open.seen().size() - row.near.capacity());
  for (const std::uint32_t element : open.seen())
    if (is_near(element))
      row.near.push_back({element, open.of(element).weights});
    else
      row.far.push_back({element, open.of(element).weights.at});
  open.clear();
}

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
      for (std::size_t k = 0; k < count; ++k)
        close(rows[t * count + k], elements, tones_[t].values[first + k]);
  });
}

std::vector<Phasor> Exchange::bounced(std::size_t tone, std::span<const TriangleLight> elements,
                                      bool with_last_places) const {
  const OfTone &of = tones_[tone];
  const std::size_t places = with_last_places ? places_of_piece : places_of_piece - 1;
  const std::vector<Phasor> middles = layout_.middles(elements);
  std::vector<Phasor> values(of.values.size());
  tbb::parallel_for(std::size_t{0}, elements.size(), [&](std::size_t element) {
    const std::size_t first = layout_.first_value(element, 0),
                      end = first + places * layout_.values_of_place(element);
    for (std::size_t i = first; i < end; ++i) {
      Phasor sum;
      for (const auto &[seen, weights] : of.values[i].near) {
        const TriangleLight &light = elements[seen];
        sum += weights.at * light.at + weights.by_u * light.by_u + weights.by_v * light.by_v;
      }
      for (const auto &[seen, weight] : of.values[i].far)
        sum += weight * middles[seen];
      values[i] = sum;
    }
  });
  return values;
}

} // namespace pmdsim
